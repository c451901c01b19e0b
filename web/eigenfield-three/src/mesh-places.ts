// Where a vertex is, in lattice steps, from the gate over which it comes. As mesh_place_kernels.py.

import { type RangeDecoder, binaryDigits } from "./range-decoder.js";

const REACH = 2 ** 20;
const OUT = 0.8;
const SIZES = 24;
const DEEP = 44;
const PAIRS = 169;
const Y = SIZES * 8 + SIZES + PAIRS;
const REST = Y + SIZES * 8 + 16 * 8 + SIZES * 8;
const START = Math.max(REST + 16 + 4 + PAIRS, DEEP + 3 * 24 + 3 * DEEP);
export const PLACES = START + 9; // contexts
const [M_X, M_Y, M_SPACE, M_START, M_REST] = [0, 1, 2, 3, 15] as const;

export interface Gate {
  a: number;
  b: number;
  o: number; // the third corner of the face behind
  pair: number; // classes of its neighbours
}

/** The nearest whole number within 2^20. */
export function bounded(value: number): number {
  return Math.floor(Math.min(Math.max(value, -REACH), REACH) + 0.5);
}

/** How positions are coded: x and y alone, most of them multiples of 2^fine, or x, y and z. */
export interface Layout {
  flat: boolean;
  fine: number;
}

/** 1 if x is no multiple of 2^fine, plus 2 if y is not; of 2 if fine is 0. */
export function offGrid(points: Int32Array, vertex: number, fine: number): number {
  const mask = Math.max((1 << fine) - 1, 1);
  return (points[3 * vertex]! & mask ? 1 : 0) + (points[3 * vertex + 1]! & mask ? 2 : 0);
}

export function readPlace(decoder: RangeDecoder, points: Int32Array, vertex: number, gate: Gate, layout: Layout): void {
  if (layout.flat) readFlat(decoder, points, vertex, gate, layout.fine);
  else readDeep(decoder, points, vertex, gate);
}

function readFlat(decoder: RangeDecoder, points: Int32Array, vertex: number, gate: Gate, fine: number): void {
  const { a, b, o, pair } = gate;
  const [ax, ay, bx, by] = [points[3 * a]!, points[3 * a + 1]!, points[3 * b]!, points[3 * b + 1]!];
  const [gx, gy] = [bx - ax, by - ay];
  const area = gx * (points[3 * o + 1]! - ay) - gy * (points[3 * o]! - ax);
  const out = area > 0 ? OUT : -OUT;
  const half = (1 << fine) >> 1;
  const x = (bounded((ax + bx) * 0.5 + out * gy) + half) >> fine;
  const y = (bounded((ay + by) * 0.5 - out * gx) + half) >> fine;
  const unit = 4 ** fine;
  const size = Math.min(binaryDigits(Math.floor((gx * gx + gy * gy) / unit)), SIZES - 1);
  const spread = Math.min(binaryDigits(Math.floor(Math.abs(area) / unit)), SIZES - 1);
  const way = (gx < 0 ? 1 : 0) + (gy < 0 ? 2 : 0) + (Math.abs(gy) > Math.abs(gx) ? 4 : 0);
  const dx = decoder.integer(size * 8 + way, SIZES * 8 + spread, SIZES * 9 + pair, M_X);
  const amount = Math.min(binaryDigits(Math.abs(dx)), 7);
  const [second, third] = [Y + SIZES * 8, Y + SIZES * 8 + 16 * 8];
  const turn = amount * 2 + (dx > 0 ? 1 : 0);
  const dy = decoder.integer(Y + size * 8 + way, second + turn * 8 + way, third + spread * 8 + amount, M_Y);
  points[3 * vertex] = (x + dx) << fine;
  points[3 * vertex + 1] = (y + dy) << fine;
  if (fine === 0) return;
  const near = offGrid(points, a, fine) + 4 * offGrid(points, b, fine);
  if (decoder.flag(REST + near, REST + 16 + offGrid(points, o, fine), REST + 20 + pair, M_REST))
    for (let axis = 0; axis < 2; axis++) points[3 * vertex + axis]! += decoder.raw(fine) - half;
}

function readDeep(decoder: RangeDecoder, points: Int32Array, vertex: number, { a, b, o }: Gate): void {
  let length = 0;
  for (let axis = 0; axis < 3; axis++) length += (points[3 * b + axis]! - points[3 * a + axis]!) ** 2;
  const size = Math.min(binaryDigits(length), DEEP - 1);
  let last = 0;
  for (let axis = 0; axis < 3; axis++) {
    const expected = bounded(points[3 * a + axis]! + points[3 * b + axis]! - points[3 * o + axis]!);
    const off = decoder.integer(size, DEEP + axis * 24 + last, DEEP + 72 + axis * DEEP + size, M_SPACE);
    points[3 * vertex + axis] = expected + off;
    last = Math.min(binaryDigits(Math.abs(off)), 23);
  }
}

/** A corner of a patch's first face: its difference from vertex `near`, from 0 for the first of all. */
export function readSeedPlace(
  decoder: RangeDecoder,
  points: Int32Array,
  vertex: number,
  near: number,
  flat: boolean,
): void {
  for (let axis = 0; axis < (flat ? 2 : 3); axis++) {
    const base = near >= 0 ? Math.min(Math.max(points[3 * near + axis]!, -REACH), REACH) : 0;
    const slot = START + axis;
    points[3 * vertex + axis] = base + decoder.integer(slot, slot + 3, slot + 6, M_START);
  }
}
