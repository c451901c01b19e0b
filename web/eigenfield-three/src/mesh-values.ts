// What vertices carry: inverse depth over a plane, texture coordinates. As mesh_value_kernels.py: sums of float64 in the
// same order, so that the same numbers come out.

import { CORNERS, MAPPED, MIRRORED, type Vertices } from "./mesh-corners.js";
import type { Built } from "./mesh-faces.js";
import { bounded } from "./mesh-places.js";
import { type RangeDecoder, binaryDigits } from "./range-decoder.js";

const MOST = 16;
const FAR = 6;
const DIFFERENCES = 2 * FAR + 1;
const SPREADS = 14;
const LAST = 20;
const DEPTH = CORNERS;
const TEXTURE = DEPTH + DIFFERENCES * DIFFERENCES + SPREADS * LAST + DIFFERENCES * SPREADS;
export const CONTEXTS = TEXTURE + 2 * 24 * 3 + 24 * 24 + 24 * 2;
const [M_DEPTH, M_U] = [12, 13] as const;
export const MIXTURES = 16;
const STEPS = [0.5, 1.5, 3.0, 6.0, 12.0, 30.0];

function rounded(value: number, other: number): number {
  return bounded(Number.isNaN(value) ? other : value);
}

function differenceClass(value: number): number {
  const rank = STEPS.filter((edge) => Math.abs(value) >= edge).length;
  return value < 0 ? FAR - rank : FAR + rank;
}

/** z of every place over its x and y. */
export function readDepths(decoder: RangeDecoder, built: Built, first: Int32Array, corners: Int32Array): void {
  const { points, faces, parents } = built;
  const sums = new Float64Array(9);
  const px = (vertex: number) => points[3 * vertex]!;
  const py = (vertex: number) => points[3 * vertex + 1]!;
  const pz = (vertex: number) => points[3 * vertex + 2]!;
  const add = (vertex: number, other: number) => {
    const [dx, dy, z] = [px(other) - px(vertex), py(other) - py(vertex), pz(other)];
    const w = 1 / (1 + dx * dx + dy * dy);
    sums[0]! += w;
    sums[1]! += w * dx;
    sums[2]! += w * dy;
    sums[3]! += w * dx * dx;
    sums[4]! += w * dx * dy;
    sums[5]! += w * dy * dy;
    sums[6]! += w * z;
    sums[7]! += w * dx * z;
    sums[8]! += w * dy * z;
    return w;
  };
  let [last, lowest, highest] = [0, 0, 0];
  for (let vertex = 0; vertex < points.length / 3; vertex++) {
    sums.fill(0);
    let [total, weight, low, high] = [0, 0, Infinity, -Infinity];
    for (let i = first[vertex]!; i < Math.min(first[vertex + 1]!, first[vertex]! + MOST); i++) {
      for (let step = 1; step < 3; step++) {
        const near = beside(faces, corners[i]!, step);
        if (near >= vertex) continue;
        const w = add(vertex, near);
        total += w * pz(near);
        weight += w;
        low = Math.min(low, pz(near));
        high = Math.max(high, pz(near));
        for (let j = first[near]!; j < Math.min(first[near + 1]!, first[near]! + MOST); j++) {
          for (let other = 1; other < 3; other++) {
            const far = beside(faces, corners[j]!, other);
            if (far < vertex) add(vertex, far);
          }
        }
      }
    }
    let spread = SPREADS - 1;
    let mean = vertex > 0 ? pz(vertex - 1) : 0;
    let plane = mean;
    if (weight > 0) {
      spread = Math.min(binaryDigits(high - low), SPREADS - 2);
      mean = total / weight;
      plane = Math.min(Math.max(planeAtOrigin(sums), lowest), highest);
    }
    let parent = mean;
    const [a, b, o] = [parents[3 * vertex]!, parents[3 * vertex + 1]!, parents[3 * vertex + 2]!];
    if (a >= 0) {
      const [ux, uy, vx, vy] = [px(b) - px(a), py(b) - py(a), px(o) - px(a), py(o) - py(a)];
      const [qx, qy] = [px(vertex) - px(a), py(vertex) - py(a)];
      const area = ux * vy - uy * vx;
      if (area !== 0) {
        const [s, t] = [(qx * vy - qy * vx) / area, (ux * qy - uy * qx) / area];
        parent = Math.min(Math.max(pz(a) + s * (pz(b) - pz(a)) + t * (pz(o) - pz(a)), lowest), highest);
      }
    }
    const value = rounded(plane, mean);
    const [one, other] = [differenceClass(parent - value), differenceClass(mean - value)];
    const off = decoder.integer(
      DEPTH + one * DIFFERENCES + other,
      DEPTH + DIFFERENCES * DIFFERENCES + spread * LAST + last,
      DEPTH + DIFFERENCES * DIFFERENCES + SPREADS * LAST + one * SPREADS + spread,
      M_DEPTH,
    );
    const z = value + off;
    points[3 * vertex + 2] = z;
    last = Math.min(binaryDigits(Math.abs(off)), LAST - 1);
    lowest = vertex === 0 ? z : Math.min(lowest, z);
    highest = vertex === 0 ? z : Math.max(highest, z);
  }
}

function beside(faces: Int32Array, corner: number, step: number): number {
  const k = corner % 3;
  return faces[corner - k + ((k + step) % 3)]!;
}

/** The value at the vertex of the plane with the least squared error; a ridge of 1 holds the slopes. */
function planeAtOrigin(sums: Float64Array): number {
  const [w, x, y] = [sums[0]!, sums[1]!, sums[2]!];
  const [xx, xy, yy] = [sums[3]! + 1, sums[4]!, sums[5]! + 1];
  const [z, xz, yz] = [sums[6]!, sums[7]!, sums[8]!];
  const [a, b, c] = [xx * yy - xy * xy, x * yy - xy * y, x * xy - xx * y];
  return (z * a - xz * b + yz * c) / (w * a - x * b + y * c);
}

/** Codes of texture coordinates, two a vertex; 0 in charts that are a map. world: positions of the places. */
export function readTextures(
  decoder: RangeDecoder,
  vertices: Vertices,
  world: Float64Array,
  first: Int32Array,
  corners: Int32Array,
): Int32Array {
  const { faces, chart, kinds, place } = vertices;
  const uv = new Int32Array(2 * place.length);
  const last = [0, 0];
  let before = -1;
  for (let vertex = 0; vertex < place.length; vertex++) {
    const kind = kinds[chart[vertex]!];
    if (kind === MAPPED) continue;
    let [u, v, count, anchor, reach] = [0, 0, 0, -1, 0];
    for (let i = first[vertex]!; i < Math.min(first[vertex + 1]!, first[vertex]! + MOST); i++) {
      const [a, b] = [beside(faces, corners[i]!, 1), beside(faces, corners[i]!, 2)];
      if (a < vertex && chart[a] === chart[vertex]) anchor = Math.max(anchor, a);
      if (b < vertex && chart[b] === chart[vertex]) anchor = Math.max(anchor, b);
      if (a >= vertex || b >= vertex) continue;
      const [gu, gv] = similar(world, place, uv, vertex, a, b, kind === MIRRORED);
      if (!Number.isFinite(gu) || !Number.isFinite(gv)) continue;
      u += gu;
      v += gv;
      count += 1;
      const across = Math.abs(uv[2 * a]! - uv[2 * b]!) + Math.abs(uv[2 * a + 1]! - uv[2 * b + 1]!);
      reach = Math.max(reach, binaryDigits(across));
    }
    if (anchor < 0) anchor = before;
    before = vertex;
    const near = [anchor >= 0 ? uv[2 * anchor]! : 0, anchor >= 0 ? uv[2 * anchor + 1]! : 0] as const;
    const guess = count > 0 ? ([u / count, v / count] as const) : near;
    const [neighbours, size] = [Math.min(count, 2), Math.min(reach, 23)];
    const slot = TEXTURE + 2 * 24 * 3;
    for (let axis = 0; axis < 2; axis++) {
      const off = decoder.integer(
        TEXTURE + (axis * 24 + size) * 3 + neighbours,
        slot + last[0]! * 24 + size,
        slot + 24 * 24 + axis * 24 + last[axis]!,
        M_U + axis,
      );
      uv[2 * vertex + axis] = rounded(guess[axis]!, 0) + off;
      last[axis] = Math.min(binaryDigits(Math.abs(off)), 23);
    }
  }
  return uv;
}

/** Where a vertex is in the texture if the triangle a, b, vertex has the same shape there. */
function similar(
  world: Float64Array,
  place: Int32Array,
  uv: Int32Array,
  vertex: number,
  a: number,
  b: number,
  mirrored: boolean,
): [number, number] {
  let [ee, ef, ff] = [0, 0, 0];
  for (let axis = 0; axis < 3; axis++) {
    const from = world[3 * place[a]! + axis]!;
    const e = world[3 * place[b]! + axis]! - from;
    const f = world[3 * place[vertex]! + axis]! - from;
    ee += e * e;
    ef += e * f;
    ff += f * f;
  }
  const [du, dv] = [uv[2 * b]! - uv[2 * a]!, uv[2 * b + 1]! - uv[2 * a + 1]!];
  const s = ef / ee;
  const height = Math.sqrt(Math.max(ff / ee - s * s, 0));
  const h = mirrored ? -height : height;
  return [uv[2 * a]! + s * du - h * dv, uv[2 * a + 1]! + s * dv + h * du];
}
