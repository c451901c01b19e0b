// Where the vertices of a clip's mesh are in the frames of a group (`motion-1`), as `docs/coding.md` codes it.

import { damaged } from "./errors.js";
import * as limits from "./limits.js";
import type { DecodedMesh } from "./mesh-decoder.js";
import { RangeDecoder, binaryDigits, checkNumbers, codedHeader } from "./range-decoder.js";

const HEADER = 11;
const REACH = 2 ** 20; // of lattice coordinates that are expected, either way
const MOST_NEIGHBOURS = 8;
const [AXES, AGAIN] = [7, 8] as const; // of a frame's flags
const SIZES = 12;
const [TWIN, MANY, ONE, NONE] = [0, 1, 2, 3] as const;
const NEAR = 4 * SIZES * SIZES;
const SPREAD = NEAR + 3 * 4 * SIZES;
const MOVES = SPREAD + 3 * SIZES * SIZES;
const CONTEXTS = MOVES + 7;
const M_MOVES = 3;
const MIXTURES = 4;

/** The vertices before that predict each: those of vertex v from starts[v] to starts[v + 1]. */
interface Neighbours {
  near: number[];
  starts: Int32Array;
  twins: Uint8Array; // whether it is one at the same place
}

/** The motion of a group. Frames are decoded one after the other, as far as one is asked for. */
export class Motion {
  readonly frames: number;
  private readonly flags: Uint8Array;
  private readonly decoder: RangeDecoder | null = null; // null: nothing moves
  private readonly moving: Int32Array; // the vertices that move
  private readonly around: Neighbours;
  private readonly steps: Int32Array; // lattice coordinates, of the mesh twice and then of each frame
  private off: Int32Array; // from what was expected, in the frame that was decoded last
  private decoded = 0; // frames

  /** Raises SceneError: `damaged`, `truncated`. */
  constructor(
    bytes: Uint8Array,
    private readonly mesh: DecodedMesh,
    private readonly where: string,
  ) {
    const header = codedHeader(bytes, HEADER, where);
    const vertices = mesh.places.length / 3;
    const count = header.getUint32(5, true);
    this.frames = header.getUint16(9, true);
    const first = HEADER + this.frames;
    if (header.getUint32(1, true) !== vertices || count > vertices)
      throw damaged(where, `${count} vertices that move, of another mesh`);
    if (this.frames < 1 || this.frames > limits.MAX_GROUP_FRAMES || this.frames * count > limits.MAX_MOTION)
      throw damaged(where, `${count} vertices that move in ${this.frames} frames`);
    codedHeader(bytes, first, where);
    this.flags = bytes.slice(HEADER, first);
    if (this.flags.some((flag) => flag > AXES + AGAIN)) throw damaged(where, "frames that cannot be");
    const axes = this.flags.reduce((sum, flag) => sum + (flag & 1) + ((flag >> 1) & 1) + ((flag >> 2) & 1), 0);
    checkNumbers(bytes, axes * count, 3 * limits.MAX_MOTION, where);
    this.moving = new Int32Array(count);
    this.steps = new Int32Array(count && 3 * count * (2 + this.frames));
    this.off = new Int32Array(3 * count);
    this.around = neighboursOf(mesh.places, mesh.indices);
    if (!count) return;
    this.decoder = new RangeDecoder(bytes.subarray(first), CONTEXTS, MIXTURES);
    const moves = readMoves(this.decoder, vertices, this.around);
    if (moves.reduce((sum, one) => sum + one, 0) !== count) throw damaged(where, "other vertices that move");
    this.around = this.start(moves);
  }

  /** Decodes the frames up to one. Raises SceneError: `damaged`, `truncated`. */
  read(frame: number): void {
    for (; this.decoded <= Math.min(frame, this.frames - 1); this.decoded += 1) {
      if (this.decoder) this.readFrame(this.decoder, this.decoded);
    }
  }

  /** The positions of all vertices in a frame that is decoded, three numbers each. */
  place(frame: number, positions: Float32Array): void {
    const { matrix } = this.mesh;
    positions.set(this.mesh.positions);
    const count = this.moving.length;
    if (!count) return;
    const own = this.steps.subarray(3 * count * (2 + frame), 3 * count * (3 + frame));
    this.moving.forEach((vertex, k) => positions.set(latticePoint(own, 3 * k, matrix), 3 * vertex));
  }

  private start(moves: Uint8Array): Neighbours {
    const { places, indices } = this.mesh;
    const number = new Int32Array(moves.length).fill(-1);
    let count = 0;
    moves.forEach((moves, vertex) => {
      if (!moves) return;
      this.moving[count] = vertex;
      number[vertex] = count++;
    });
    const own = new Int32Array(3 * count);
    this.moving.forEach((vertex, k) => own.set(places.subarray(3 * vertex, 3 * vertex + 3), 3 * k));
    this.steps.set(own);
    this.steps.set(own, own.length);
    return neighboursOf(own, Int32Array.from(indices, (vertex) => number[vertex]!));
  }

  private readFrame(decoder: RangeDecoder, frame: number): void {
    const { steps, around, off: before } = this;
    const { near, starts, twins } = around;
    const size = 3 * this.moving.length;
    const [flag, now, last, older] = [this.flags[frame]!, size * (2 + frame), size * (1 + frame), size * frame];
    const again = (flag & AGAIN) !== 0;
    const off = new Int32Array(size);
    for (let vertex = 0; vertex < this.moving.length; vertex++) {
      const [from, to] = [starts[vertex]!, starts[vertex + 1]!];
      const count = to - from;
      const kind = twins[vertex] ? TWIN : count === 0 ? NONE : count === 1 ? ONE : MANY;
      for (let axis = 0; axis < 3; axis++) {
        const at = 3 * vertex + axis;
        if (!((flag >> axis) & 1)) {
          steps[now + at] = steps[last + at]!;
          continue;
        }
        let [low, high, total, beside] = [Infinity, -Infinity, 0, 0];
        for (let k = from; k < to; k++) {
          const other = 3 * near[k]! + axis;
          let moved = steps[now + other]! - steps[last + other]!;
          if (again) moved -= steps[last + other]! - steps[older + other]!;
          low = Math.min(low, moved);
          high = Math.max(high, moved);
          total += moved;
          beside += Math.abs(off[other]!);
        }
        let expected = steps[last + at]!;
        if (again) expected += expected - steps[older + at]!;
        if (count) expected += Math.floor((2 * total + count) / (2 * count));
        expected = Math.min(Math.max(expected, -REACH), REACH);
        const a = sizeOf(count && Math.floor((4 * beside) / count));
        const b = sizeOf(4 * Math.abs(before[at]!));
        const c = sizeOf(count && high - low);
        off[at] = decoder.integer(
          (kind * SIZES + a) * SIZES + b,
          NEAR + (axis * 4 + kind) * SIZES + c,
          SPREAD + (axis * SIZES + c) * SIZES + a,
          axis,
        );
        steps[now + at] = expected + off[at]!;
      }
    }
    this.off = off;
    decoder.checkEnd(this.where);
    this.check(now, size);
  }

  private check(now: number, size: number): void {
    for (let at = now; at < now + size; at += 3) {
      const fits = latticePoint(this.steps, at, this.mesh.matrix).every((x) => Math.abs(x) <= limits.MAX_NUMBER);
      if (!fits) throw damaged(this.where, "positions that are not finite");
    }
  }
}

/** The world position of three lattice coordinates from `at` on. */
function latticePoint(steps: Int32Array, at: number, m: Float64Array): [number, number, number] {
  const [i, j, k] = [steps[at]!, steps[at + 1]!, steps[at + 2]!];
  const row = (r: number): number => m[4 * r]! * i + m[4 * r + 1]! * j + m[4 * r + 2]! * k + m[4 * r + 3]!;
  const w = row(3);
  return [row(0) / w, row(1) / w, row(2) / w];
}

function sizeOf(value: number): number {
  return Math.min(binaryDigits(value), SIZES - 1);
}

function readMoves(decoder: RangeDecoder, vertices: number, { near, starts }: Neighbours): Uint8Array {
  const moves = new Uint8Array(vertices);
  let before = 0;
  for (let vertex = 0; vertex < vertices; vertex++) {
    const [from, to] = [starts[vertex]!, starts[vertex + 1]!];
    let count = 0;
    for (let k = from; k < to; k++) count += moves[near[k]!]!;
    const kind = to === from ? 3 : count === 0 ? 0 : count === to - from ? 2 : 1;
    before = Number(decoder.flag(MOVES + kind, MOVES + 4 + before, MOVES + 6, M_MOVES));
    moves[vertex] = before;
  }
  return moves;
}

/** `places`: three numbers a vertex. `faces`: three vertices each, -1 for one that does not count. */
function neighboursOf(places: Int32Array, faces: Int32Array | Uint32Array): Neighbours {
  const count = places.length / 3;
  const own: number[][] = Array.from({ length: count }, () => []);
  const twins = new Uint8Array(count);
  const known = new Map<string, number>();
  for (let vertex = 0; vertex < count; vertex++) {
    const key = `${places[3 * vertex]} ${places[3 * vertex + 1]} ${places[3 * vertex + 2]}`;
    const leader = known.get(key);
    if (leader === undefined) known.set(key, vertex);
    else {
      twins[vertex] = 1;
      own[vertex]!.push(leader);
    }
  }
  for (let corner = 0; corner < faces.length; corner++) {
    const vertex = faces[corner]!;
    if (vertex < 0 || twins[vertex]) continue;
    const start = corner - (corner % 3);
    for (const step of [1, 2]) {
      const other = faces[start + ((corner + step) % 3)]!;
      if (other >= 0 && other < vertex && own[vertex]!.length < MOST_NEIGHBOURS) own[vertex]!.push(other);
    }
  }
  const starts = new Int32Array(count + 1);
  own.forEach((list, vertex) => (starts[vertex + 1] = starts[vertex]! + list.length));
  return { near: own.flat(), starts, twins };
}
