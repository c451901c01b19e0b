// Faces one by one, over the gates of a growing border. As mesh_kernels.py.

import { damaged } from "./errors.js";
import { BORDER, MeshFront, OPEN } from "./mesh-front.js";
import { type Layout, PLACES, offGrid, readPlace, readSeedPlace } from "./mesh-places.js";
import { type RangeDecoder, binaryDigits } from "./range-decoder.js";

const ANGLES = 13;
const NO_GATE = 11;
const AT_BORDER = 12;
const PAIRS = ANGLES * ANGLES;
const FANS = 8;
const LEFT = PLACES;
const RIGHT = LEFT + PAIRS + ANGLES * FANS + 2 * ANGLES;
const EDGE = RIGHT + PAIRS + ANGLES * FANS + ANGLES;
const FRESH = EDGE + 64 + FANS * FANS + PAIRS;
const SEED = FRESH + PAIRS + 4 + 1;
export const FACES = SEED + 6; // contexts so far
const [M_LEFT, M_RIGHT, M_EDGE, M_FRESH, M_SEED] = [4, 5, 6, 7, 8] as const;
const COTANGENTS = [-1.0, -0.4, 0.0, 0.3, 0.6, 0.9, 1.3, 2.0, 4.0];

/** Faces between places. */
export interface Built {
  points: Int32Array; // lattice coordinates, three a place
  faces: Int32Array;
  parents: Int32Array; // start, end and third corner of the gate over which a place came, or -1
}

export function readFaces(
  decoder: RangeDecoder,
  places: number,
  faces: number,
  layout: Layout,
  where: string,
): Built {
  const points = new Int32Array(3 * places);
  const built = { points, faces: new Int32Array(3 * faces), parents: new Int32Array(3 * places).fill(-1) };
  const fan = new Int32Array(places);
  const front = new MeshFront(points, faces);
  let [known, done] = [0, 0];

  const add = (a: number, b: number, c: number) => {
    built.faces.set([a, b, c], 3 * done);
    done += 1;
    for (const vertex of [a, b, c]) fan[vertex]! += 1;
  };
  const fresh = () => {
    if (known >= places) throw damaged(where, "more places than announced");
    return known++;
  };
  const old = () => {
    const vertex = decoder.raw(binaryDigits(known - 1));
    if (vertex >= known) throw damaged(where, "a place that is not there yet");
    return vertex;
  };
  const seed = () => {
    const corner: [number, number, number] = [-1, -1, -1];
    for (let k = 0; k < 3; k++) {
      if (known > 0 && decoder.flag(SEED + k, SEED + 3 + k, SEED + k, M_SEED)) corner[k] = old();
      else {
        const vertex = (corner[k] = fresh());
        readSeedPlace(decoder, points, vertex, k > 0 ? corner[k - 1]! : vertex - 1, layout.flat);
      }
    }
    const [a, b, c] = corner;
    if (a === b || b === c || c === a) throw damaged(where, "a face of two corners");
    add(a, b, c);
    front.seed(corner);
  };
  const neighbour = (gate: number, near: number, vertex: number, far: number) => {
    if (front.status[near] === BORDER) return AT_BORDER;
    if (front.status[near] !== OPEN || vertex === far || near === gate) return NO_GATE;
    return angleClass(points, front.start[gate]!, front.end[gate]!, vertex, front.opposite[gate]!, layout.flat);
  };

  while (done < faces) {
    const gate = front.next();
    if (gate < 0) {
      seed();
      continue;
    }
    const [a, b] = [front.start[gate]!, front.end[gate]!];
    const [left, right] = [front.before[gate]!, front.after[gate]!];
    const [start, end] = [front.start[left]!, front.end[right]!];
    const [lc, rc] = [neighbour(gate, left, start, b), neighbour(gate, right, end, a)];
    const pair = lc * ANGLES + rc;
    const [fa, fb] = [Math.min(fan[a]!, FANS - 1), Math.min(fan[b]!, FANS - 1)];
    const both = LEFT + PAIRS + ANGLES * FANS + 2 * lc + (start === end ? 1 : 0);
    if (lc < NO_GATE && decoder.flag(LEFT + pair, LEFT + PAIRS + lc * FANS + fa, both, M_LEFT)) {
      add(b, a, start);
      front.closeLeft(gate);
      continue;
    }
    if (
      rc < NO_GATE &&
      (end !== start || lc >= NO_GATE) &&
      decoder.flag(RIGHT + pair, RIGHT + PAIRS + rc * FANS + fb, RIGHT + PAIRS + ANGLES * FANS + rc, M_RIGHT)
    ) {
      add(b, a, end);
      front.closeRight(gate);
      continue;
    }
    const borders = (lc === AT_BORDER ? 1 : 0) + (rc === AT_BORDER ? 2 : 0);
    const grid = offGrid(points, a, layout.fine) + 4 * offGrid(points, b, layout.fine);
    const fans = EDGE + 64 + fa * FANS + fb;
    if (decoder.flag(EDGE + borders * 16 + grid, fans, EDGE + 64 + FANS * FANS + pair, M_EDGE)) {
      front.status[gate] = BORDER;
      continue;
    }
    let target: number;
    if (decoder.flag(FRESH + pair, FRESH + PAIRS + borders, FRESH + PAIRS + 4, M_FRESH)) {
      target = fresh();
      const o = front.opposite[gate]!;
      built.parents.set([a, b, o], 3 * target);
      readPlace(decoder, points, target, { a, b, o, pair }, layout);
    } else {
      target = old();
      if (target === a || target === b) throw damaged(where, "a face of two corners");
    }
    add(b, a, target);
    front.openOut(gate, target);
  }
  if (known !== places) throw damaged(where, "fewer places than announced");
  return built;
}

/** How `vertex` looks as the third corner over the gate a -> b of a face with the third corner o. */
function angleClass(points: Int32Array, a: number, b: number, vertex: number, o: number, flat: boolean): number {
  const from = (to: number, axis: number) =>
    flat && axis === 2 ? 0 : points[3 * to + axis]! - points[3 * a + axis]!;
  const [ux, uy, uz] = [from(b, 0), from(b, 1), from(b, 2)];
  const [vx, vy, vz] = [from(vertex, 0), from(vertex, 1), from(vertex, 2)];
  const [ox, oy, oz] = [from(o, 0), from(o, 1), from(o, 2)];
  const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
  const [mx, my, mz] = [uy * oz - uz * oy, uz * ox - ux * oz, ux * oy - uy * ox];
  const area = Math.sqrt(nx * nx + ny * ny + nz * nz);
  if (area === 0 || nx * mx + ny * my + nz * mz > 0) return 0;
  const cotangent = (vx * (vx - ux) + vy * (vy - uy) + vz * (vz - uz)) / area;
  const found = COTANGENTS.findIndex((edge) => cotangent < edge);
  return found < 0 ? 10 : found + 1;
}
