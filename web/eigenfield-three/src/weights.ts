// Equation 7: view weights, how much of each encoded camera a viewpoint takes. The rules of
// eigenfield/rendering/weights.py, with the triangles in bins so that whole maps of weights are quick.

import { findGrid, type Grid } from "./grid.js";

export type Mixing = "delaunay" | "bilinear" | "nearest3";

/** At most four cameras and their weights, which sum to 1; unused entries have weight 0. */
export interface Blend {
  camera: Quad;
  weight: Quad;
}

type Segments = Int32Array; // pairs of cameras
type Triple = [number, number, number];
type Quad = [number, number, number, number];
type Rule = (x: number, y: number) => Blend;

const FLAT = 1e-6; // triangles whose area is below this part of their longest side squared count as a line
const BINS = 32;
const SLACK = 1e-9; // by which a place on an edge may lie outside both its triangles, or cells, and count as within

/** Weights over n cameras at view-plane places (X, Y, X, Y, ...), by the triangles of the scene. */
export class ViewWeights {
  readonly grid: Grid | null;
  private readonly rules = new Map<Mixing, Rule>();

  constructor(
    readonly places: Float64Array,
    private readonly triangles: Uint32Array,
    private readonly isLine: boolean,
  ) {
    this.grid = findGrid(places);
  }

  /** The weights at X, Y, clamped to the array's -1..1. */
  at(x: number, y: number, mixing: Mixing): Blend {
    const used = mixing === "bilinear" && !this.grid ? "delaunay" : mixing;
    let rule = this.rules.get(used);
    if (!rule) this.rules.set(used, (rule = this.makeRule(used)));
    return rule(clamp(x), this.isLine ? 0 : clamp(y));
  }

  private makeRule(mixing: Mixing): Rule {
    if (mixing === "nearest3") return (x, y) => nearest3(x, y, this.places);
    if (mixing === "bilinear" && this.grid) return bilinearRule(this.places, this.grid);
    return delaunayRule(this.places, this.triangles);
  }
}

function clamp(value: number): number {
  return Math.min(1, Math.max(-1, value));
}

function blend(pairs: [number, number][]): Blend {
  const made: Blend = { camera: [0, 0, 0, 0], weight: [0, 0, 0, 0] };
  pairs.forEach(([camera, weight], i) => {
    made.camera[i as 0] = camera;
    made.weight[i as 0] = weight;
  });
  return made;
}

const px = (places: Float64Array, camera: number): number => places[2 * camera] ?? 0;
const py = (places: Float64Array, camera: number): number => places[2 * camera + 1] ?? 0;

/** Barycentric coordinates of (x, y) in a triangle of cameras, which must have area. */
function barycentric(x: number, y: number, places: Float64Array, a: number, b: number, c: number): Triple {
  const [ax, ay] = [px(places, a), py(places, a)];
  const [bx, by] = [px(places, b) - ax, py(places, b) - ay];
  const [cx, cy] = [px(places, c) - ax, py(places, c) - ay];
  const area = bx * cy - by * cx;
  const second = ((x - ax) * cy - (y - ay) * cx) / area;
  const third = (bx * (y - ay) - by * (x - ax)) / area;
  return [1 - second - third, second, third];
}

/** Inside the hull the triangle that holds the place; outside, the hull's nearest point. */
function delaunayRule(places: Float64Array, triangles: Uint32Array): Rule {
  if (!triangles.length) {
    const segments = lineSegments(places, allOf(places));
    return (x, y) => onSegments(x, y, places, segments);
  }
  const bins = binPolygons(places, triangles, 3);
  const hull = hullSegments(triangles);
  return (x, y) => {
    let best = -1;
    let least = -Infinity;
    let found: Triple = [0, 0, 0];
    for (const t of bins[binOf(y) * BINS + binOf(x)] ?? []) {
      const [a, b, c] = [corner(triangles, t, 0), corner(triangles, t, 1), corner(triangles, t, 2)];
      const inside = barycentric(x, y, places, a, b, c);
      const smallest = Math.min(...inside);
      if (smallest > least) [best, least, found] = [t, smallest, inside];
    }
    if (least < -SLACK) return onSegments(x, y, places, hull);
    return blend(found.map((weight, i) => [corner(triangles, best, i), weight]));
  };
}

const corner = (triangles: Uint32Array, t: number, i: number): number => triangles[3 * t + i] ?? 0;

function binOf(value: number): number {
  return Math.min(BINS - 1, Math.max(0, Math.floor(((value + 1) / 2) * BINS)));
}

/** For each of BINS x BINS squares over X, Y in -1..1 the polygons whose bounding boxes touch it, in their order. */
function binPolygons(places: Float64Array, polygons: ArrayLike<number>, corners: 3 | 4): number[][] {
  const bins: number[][] = Array.from({ length: BINS * BINS }, () => []);
  for (let p = 0; p < polygons.length / corners; p++) {
    const cameras = Array.from({ length: corners }, (_, i) => polygons[corners * p + i] ?? 0);
    const xs = cameras.map((camera) => px(places, camera));
    const ys = cameras.map((camera) => py(places, camera));
    for (let row = binOf(Math.min(...ys)); row <= binOf(Math.max(...ys)); row++) {
      for (let column = binOf(Math.min(...xs)); column <= binOf(Math.max(...xs)); column++) {
        bins[row * BINS + column]?.push(p);
      }
    }
  }
  return bins;
}

/** Edges that belong to one triangle only, by rising camera numbers. */
function hullSegments(triangles: Uint32Array): Segments {
  const uses = new Map<string, { edge: [number, number]; times: number }>();
  for (let t = 0; t < triangles.length / 3; t++) {
    for (let i = 0; i < 3; i++) {
      const [a, b] = [corner(triangles, t, i), corner(triangles, t, (i + 1) % 3)];
      const edge: [number, number] = a < b ? [a, b] : [b, a];
      const known = uses.get(edge.join());
      if (known) known.times += 1;
      else uses.set(edge.join(), { edge, times: 1 });
    }
  }
  const once = [...uses.values()].filter((use) => use.times === 1).map((use) => use.edge);
  once.sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  return Int32Array.from(once.flat());
}

/** Linear weights on the nearest point of segments; ties go to the first. */
function onSegments(x: number, y: number, places: Float64Array, segments: Segments): Blend {
  let nearest = Infinity;
  let found: [number, number, number] = [segments[0] ?? 0, segments[0] ?? 0, 0];
  for (let s = 0; s + 1 < segments.length; s += 2) {
    const [a, b] = [segments[s] ?? 0, segments[s + 1] ?? 0];
    const [ax, ay] = [px(places, a), py(places, a)];
    const [dx, dy] = [px(places, b) - ax, py(places, b) - ay];
    const length = dx * dx + dy * dy;
    const part = length > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / length)) : 0;
    const distance = (ax + part * dx - x) ** 2 + (ay + part * dy - y) ** 2;
    if (distance < nearest) [nearest, found] = [distance, [a, b, part]];
  }
  const [a, b, part] = found;
  return blend([[a, 1 - part], [b, part]]);
}

function allOf(places: Float64Array): number[] {
  return Array.from({ length: places.length / 2 }, (_, i) => i);
}

/** Cameras on a line, in the order of their positions along it: segments between neighbours. */
function lineSegments(places: Float64Array, cameras: number[]): Segments {
  const [first = 0] = cameras;
  if (cameras.length === 1) return Int32Array.of(first, first);
  const mean = [0, 0];
  for (const camera of cameras) {
    mean[0] = (mean[0] ?? 0) + px(places, camera) / cameras.length;
    mean[1] = (mean[1] ?? 0) + py(places, camera) / cameras.length;
  }
  let [xx, xy, yy] = [0, 0, 0];
  for (const camera of cameras) {
    const [dx, dy] = [px(places, camera) - (mean[0] ?? 0), py(places, camera) - (mean[1] ?? 0)];
    [xx, xy, yy] = [xx + dx * dx, xy + dx * dy, yy + dy * dy];
  }
  const angle = 0.5 * Math.atan2(2 * xy, xx - yy); // of the main axis of their spread
  const along = (camera: number): number =>
    px(places, camera) * Math.cos(angle) + py(places, camera) * Math.sin(angle);
  const order = [...cameras].sort((a, b) => along(a) - along(b));
  return Int32Array.from(order.slice(1).flatMap((camera, i) => [order[i] ?? 0, camera]));
}

/** Equation 7 as printed: barycentric in the triangle of the three nearest cameras, negative outside it. */
function nearest3(x: number, y: number, places: Float64Array): Blend {
  let [a, b, c] = [-1, -1, -1];
  let [first, second, third] = [Infinity, Infinity, Infinity];
  for (let camera = 0; 2 * camera < places.length; camera++) {
    const [dx, dy] = [px(places, camera) - x, py(places, camera) - y];
    const distance = dx * dx + dy * dy;
    if (distance >= third) continue;
    c = camera;
    third = distance;
    if (distance < second) {
      [c, third] = [b, second];
      [b, second] = [camera, distance];
    }
    if (distance < first) {
      [b, second] = [a, first];
      [a, first] = [camera, distance];
    }
  }
  if (c < 0 || flatness(places, a, b, c) <= FLAT) {
    return onSegments(x, y, places, lineSegments(places, [a, b, c].filter((camera) => camera >= 0)));
  }
  const [p, q, r] = barycentric(x, y, places, a, b, c);
  return { camera: [a, b, c, 0], weight: [p, q, r, 0] };
}

/** Twice the area of a triangle over its longest side squared. */
function flatness(places: Float64Array, a: number, b: number, c: number): number {
  const [ux, uy] = [px(places, b) - px(places, a), py(places, b) - py(places, a)];
  const [vx, vy] = [px(places, c) - px(places, a), py(places, c) - py(places, a)];
  const longest = Math.max(ux * ux + uy * uy, vx * vx + vy * vy, (ux - vx) ** 2 + (uy - vy) ** 2);
  return longest > 0 ? Math.abs(ux * vy - uy * vx) / longest : 0;
}

/** Between the four cameras of a grid cell; on a jittering grid the cell's quadrilateral is inverted exactly. */
function bilinearRule(places: Float64Array, grid: Grid): Rule {
  const { rows, columns, index } = grid;
  if (Math.min(rows, columns) === 1) {
    const segments = lineSegments(places, allOf(places));
    return (x, y) => onSegments(x, y, places, segments);
  }
  const node = (row: number, column: number): number => index[row * columns + column] ?? 0;
  const cells: Quad[] = [];
  for (let r = 0; r + 1 < rows; r++) {
    for (let c = 0; c + 1 < columns; c++) cells.push([node(r, c), node(r, c + 1), node(r + 1, c + 1), node(r + 1, c)]);
  }
  const bins = binPolygons(places, cells.flat(), 4);
  const rim: number[] = [];
  for (let c = 0; c < columns; c++) rim.push(node(0, c));
  for (let r = 1; r < rows; r++) rim.push(node(r, columns - 1));
  for (let c = columns - 2; c >= 0; c--) rim.push(node(rows - 1, c));
  for (let r = rows - 2; r >= 0; r--) rim.push(node(r, 0));
  const segments = Int32Array.from(rim.slice(1).flatMap((camera, i) => [rim[i] ?? 0, camera]));
  return (x, y) => {
    let best: Quad | null = null;
    let deepest = -Infinity;
    for (const index of bins[binOf(y) * BINS + binOf(x)] ?? []) {
      const cell = cells[index];
      const depth = cell ? insideness(x, y, places, cell) : -Infinity;
      if (cell && depth > deepest) [best, deepest] = [cell, depth];
    }
    if (!best || deepest < -SLACK) return onSegments(x, y, places, segments);
    const [s, t] = inCell(x, y, places, best);
    return { camera: best, weight: [(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t] };
  };
}

/** The smallest of the cross products of a cell's sides with the way to the place: at least 0 inside. */
function insideness(x: number, y: number, places: Float64Array, cell: Quad): number {
  let least = Infinity;
  for (let i = 0; i < 4; i++) {
    const [a, b] = [cell[i as 0], cell[((i + 1) % 4) as 0]];
    const [ax, ay] = [px(places, a), py(places, a)];
    least = Math.min(least, (px(places, b) - ax) * (y - ay) - (py(places, b) - ay) * (x - ax));
  }
  return least;
}

/**
 * s, t in 0..1 with (x, y) = (1-s)(1-t) A + s(1-t) B + s t C + (1-s) t D in a convex quadrilateral. With h = (x, y) -
 * A, e = B - A, g = D - A and k = A - B + C - D, (h - t g) x (e + t k) = 0 is a quadratic in t; of its roots the one
 * that stays finite as the cell becomes a parallelogram.
 */
function inCell(x: number, y: number, places: Float64Array, cell: Quad): [number, number] {
  const [ax, ay, bx, by] = [px(places, cell[0]), py(places, cell[0]), px(places, cell[1]), py(places, cell[1])];
  const [cx, cy, dx, dy] = [px(places, cell[2]), py(places, cell[2]), px(places, cell[3]), py(places, cell[3])];
  const [hx, hy, ex, ey, gx, gy] = [x - ax, y - ay, bx - ax, by - ay, dx - ax, dy - ay];
  const [kx, ky] = [ax - bx + cx - dx, ay - by + cy - dy];
  const constant = hx * ey - hy * ex;
  const linear = hx * ky - hy * kx - (gx * ey - gy * ex);
  const square = -(gx * ky - gy * kx);
  const root = Math.sqrt(Math.max(linear * linear - 4 * constant * square, 0));
  const t = unit((-2 * constant) / (linear + (linear < 0 ? -root : root)));
  const [ux, uy] = [ex + t * kx, ey + t * ky];
  return [unit(((hx - t * gx) * ux + (hy - t * gy) * uy) / (ux * ux + uy * uy)), t];
}

function unit(value: number): number {
  return Math.min(1, Math.max(0, value));
}
