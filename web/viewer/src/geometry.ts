// Three numbers and three by three, in the capture's world.

import type { Vector } from "eigenfield-three";

type Rows = readonly (readonly number[])[];

export const add = (a: Readonly<Vector>, b: Readonly<Vector>): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const scaled = (a: Readonly<Vector>, by: number): Vector => [a[0] * by, a[1] * by, a[2] * by];
export const dot = (a: Readonly<Vector>, b: Readonly<Vector>): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** One row of a matrix. */
export const row = (matrix: Rows, index: number): Vector => {
  const numbers = matrix[index];
  return [numbers?.[0] ?? 0, numbers?.[1] ?? 0, numbers?.[2] ?? 0];
};

/** A matrix times a vector. */
export const turned = (matrix: Rows, a: Readonly<Vector>): Vector => [
  dot(row(matrix, 0), a),
  dot(row(matrix, 1), a),
  dot(row(matrix, 2), a),
];
