// The growing border of the triangles that are decoded so far: gates, linked into loops. As mesh_front_kernels.py.

const CLOSED = 0;
export const OPEN = 1;
export const BORDER = 2;
const ROW = 2 ** 24; // more than twice any sum of two coordinates

export class MeshFront {
  readonly start: Int32Array;
  readonly end: Int32Array;
  readonly opposite: Int32Array;
  readonly before: Int32Array;
  readonly after: Int32Array;
  readonly status: Uint8Array;
  private readonly into: Int32Array; // the gate that ended last at a vertex, or -1
  private readonly heap: Int32Array;
  private readonly key: Float64Array;
  private gates = 0;
  private waiting = 0;

  constructor(
    private readonly points: Int32Array,
    faces: number,
  ) {
    const room = 3 * faces;
    this.start = new Int32Array(room);
    this.end = new Int32Array(room);
    this.opposite = new Int32Array(room);
    this.before = new Int32Array(room);
    this.after = new Int32Array(room);
    this.status = new Uint8Array(room);
    this.into = new Int32Array(points.length / 3).fill(-1);
    this.heap = new Int32Array(room);
    this.key = new Float64Array(room);
  }

  /** A loop of three gates round a first face. */
  seed(corner: readonly [number, number, number]): void {
    const first = this.gates;
    for (let k = 0; k < 3; k++) this.add(corner[k]!, corner[(k + 1) % 3]!, corner[(k + 2) % 3]!);
    for (let k = 0; k < 3; k++) this.link(first + k, first + ((k + 1) % 3));
  }

  /** The open gate whose middle has the least x, taken out of the heap; -1 if there is none. */
  next(): number {
    const { heap, key } = this;
    while (this.waiting > 0) {
      const gate = heap[0]!;
      const size = --this.waiting;
      const [last, lastKey] = [heap[size]!, key[size]!];
      let at = 0;
      while (2 * at + 1 < size) {
        let child = 2 * at + 1;
        if (child + 1 < size && key[child + 1]! < key[child]!) child += 1;
        if (key[child]! >= lastKey) break;
        heap[at] = heap[child]!;
        key[at] = key[child]!;
        at = child;
      }
      heap[at] = last;
      key[at] = lastKey;
      if (this.status[gate] === OPEN) return gate;
    }
    return -1;
  }

  /** The face in front of a gate ends at the start of the gate before it. */
  closeLeft(gate: number): void {
    const [left, right] = [this.before[gate]!, this.after[gate]!];
    const vertex = this.start[left]!;
    this.status[gate] = this.status[left] = CLOSED;
    if (this.status[right] === OPEN && this.end[right] === vertex && right !== left) {
      this.status[right] = CLOSED;
      this.link(this.before[left]!, this.after[right]!);
      return;
    }
    const before = this.before[left]!;
    const made = this.add(vertex, this.end[gate]!, this.start[gate]!);
    this.link(before, made);
    this.link(made, right);
  }

  /** The face in front of a gate ends at the end of the gate behind it. */
  closeRight(gate: number): void {
    const [left, right] = [this.before[gate]!, this.after[gate]!];
    this.status[gate] = this.status[right] = CLOSED;
    const after = this.after[right]!;
    const made = this.add(this.start[gate]!, this.end[right]!, this.end[gate]!);
    this.link(left, made);
    this.link(made, after);
  }

  /** The face in front of a gate ends at a new vertex, or at one elsewhere. */
  openOut(gate: number, vertex: number): void {
    const [left, right, there] = [this.before[gate]!, this.after[gate]!, this.into[vertex]!];
    this.status[gate] = CLOSED;
    const one = this.add(this.start[gate]!, vertex, this.end[gate]!);
    const other = this.add(vertex, this.end[gate]!, this.start[gate]!);
    if (there >= 0 && this.status[there] !== CLOSED) {
      this.link(one, this.after[there]!);
      this.link(there, other);
    } else this.link(one, other);
    this.link(left, one);
    this.link(other, right);
    this.into[vertex] = one;
  }

  private link(one: number, other: number): void {
    this.after[one] = other;
    this.before[other] = one;
  }

  private add(start: number, end: number, opposite: number): number {
    const { heap, key, points } = this;
    const gate = this.gates++;
    this.start[gate] = start;
    this.end[gate] = end;
    this.opposite[gate] = opposite;
    this.status[gate] = OPEN;
    this.into[end] = gate;
    const place = (points[3 * start]! + points[3 * end]!) * ROW + points[3 * start + 1]! + points[3 * end + 1]!;
    let at = this.waiting++;
    while (at > 0) {
      const parent = (at - 1) >> 1;
      if (key[parent]! <= place) break;
      heap[at] = heap[parent]!;
      key[at] = key[parent]!;
      at = parent;
    }
    heap[at] = gate;
    key[at] = place;
    return gate;
  }
}
