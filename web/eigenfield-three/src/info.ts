// What a scene says of itself: cameras, view plane, settings and bytes, read from the file and checked.

import { checkFinite, readNumbers, type Accessor, type Numbers, type Stream, type ViewBytes } from "./accessors.js";
import { type SceneDocument, wrongIn } from "./document.js";
import { damaged } from "./errors.js";
import type { Grid } from "./grid.js";
import type { JsonObject } from "./json.js";
import * as limits from "./limits.js";
import type { Basis } from "./planes.js";
import type { Rights } from "./rights.js";
import type { CodedWeights } from "./weight-decoder.js";

const SHORTEST = 1e-6; // of focal lengths, in pixels

export type Vector = [number, number, number];
export type Matrix3rows = [Vector, Vector, Vector];

/** World-to-camera, x right, y down, z forward; pixel centres at halves. */
export interface CaptureCamera {
  name: string;
  K: Matrix3rows;
  R: Matrix3rows;
  t: Vector;
  centre: Vector;
  width: number;
  height: number;
  gain: number[] | null; // of a harmonised scene: what it holds is gain * photograph + offset
  offset: number[] | null;
}

/** X, Y of a world point p: (p - origin) . right / extent[0], (p - origin) . up / extent[1]. */
export interface ViewPlane {
  origin: Vector;
  right: Vector;
  up: Vector;
  normal: Vector;
  extent: [number, number];
}

export interface SceneInfo {
  version: string;
  generator: string;
  rights: Rights;
  names: string[];
  heldOut: boolean[];
  reference: number;
  cameras: CaptureCamera[];
  viewPlane: ViewPlane;
  grid: { rows: number; columns: number } | null;
  settings: JsonObject;
  scores: JsonObject;
  metresPerUnit: number | null;
  bytes: {
    total: number;
    mesh: number;
    opacity: number;
    mean: number;
    weights: number;
    groups: number; // of a clip: films and weights
    other: number;
    textures: number[]; // by rank
  };
  size: [number, number]; // of the atlas that is drawn
  planes: PlaneInfo[];
  vertices: number;
  triangles: number;
  mixedColours: boolean; // a view has the exposures of the cameras around it, by its weights, and not the common one
  sheets: number; // that are drawn one over the other; 0: the mesh is one opaque surface
  inFiles: boolean; // of a clip: its groups are files beside it
  facesPlane: boolean; // the cameras look across the view plane; else weights by the ray make no sense
}

/** Channels that share a mean and bases: what `info.planes` says of each. */
export interface PlaneInfo {
  channels: number;
  mean: [number, number];
  bases: { textures: number; size: [number, number]; grid: [number, number] }[];
}

export async function readCameras(scene: SceneDocument, bytes: ViewBytes): Promise<CaptureCamera[]> {
  const [names, { lenses, poses }, sizes, colour] = await Promise.all([
    readNames(scene, bytes),
    readCalibration(scene, bytes),
    readSizes(scene, bytes),
    readExposures(scene, bytes),
  ]);
  return names.map((name, i) => {
    const [fx = 0, fy = 0, skew = 0, cx = 0, cy = 0] = lenses.numbers.subarray(5 * i, 5 * i + 5);
    if (!(fx > SHORTEST && fy > SHORTEST)) throw damaged(lenses.where, `focal lengths of "${name}"`);
    const { R, t } = poseOf([...poses.numbers.subarray(12 * i, 12 * i + 12)], poses.where, name);
    const [width = 0, height = 0] = sizes.numbers.subarray(2 * i, 2 * i + 2);
    const largest = Math.max(width, height);
    if (!width || !height || largest > limits.MAX_CAMERA_SIDE || width * height > limits.MAX_CAMERA_PIXELS) {
      throw damaged(sizes.where, `"${name}" is ${width} x ${height} pixels`);
    }
    const K: Matrix3rows = [[fx, skew, cx], [0, fy, cy], [0, 0, 1]];
    const [gain, offset] = colour ? coloursOf([...colour.subarray(6 * i, 6 * i + 6)], scene, name) : [null, null];
    return { name, K, R, t, centre: centreOf(R, t), width, height, gain, offset };
  });
}

/** Gain and offset of R, G, B of all cameras; of held-out ones 1 and 0. */
async function readExposures({ colour, heldOut, views }: SceneDocument, bytes: ViewBytes): Promise<Numbers | null> {
  if (!colour || "type" in colour) return colour && readNumbers(colour, views, bytes);
  const { cameras, components, values } = await colour.codec.decode(
    new Uint8Array(await bytes(colour.view)),
    colour.where,
  );
  if (components !== 6 || cameras !== heldOut.filter((out) => !out).length) {
    throw damaged(colour.where, `${cameras} x ${components} colours`);
  }
  let row = 0;
  return Float32Array.from(
    heldOut.flatMap((out) => (out ? [1, 1, 1, 0, 0, 0] : [...values.subarray(6 * row, 6 * ++row)])),
  );
}

async function readNames({ names, heldOut }: SceneDocument, bytes: ViewBytes): Promise<string[]> {
  if (Array.isArray(names)) return names;
  const found = await names.codec.decode(new Uint8Array(await bytes(names.view)), heldOut.length, names.where);
  const wrong = found.some((name) => name.length > limits.MAX_NAME) ? "names that are too long" : wrongIn(found);
  if (wrong) throw damaged(names.where, wrong);
  return found;
}

/** Numbers and where the file has them. */
interface Table {
  numbers: Numbers;
  where: string;
}

async function readTable(accessor: Accessor, scene: SceneDocument, bytes: ViewBytes): Promise<Table> {
  return { numbers: await readNumbers(accessor, scene.views, bytes), where: accessor.where };
}

/** Five numbers of each camera's lens, twelve of its pose. */
async function readCalibration(scene: SceneDocument, bytes: ViewBytes): Promise<{ lenses: Table; poses: Table }> {
  const { calibration, heldOut } = scene;
  if ("intrinsics" in calibration) {
    const { intrinsics, poses } = calibration;
    return { lenses: await readTable(intrinsics, scene, bytes), poses: await readTable(poses, scene, bytes) };
  }
  const { view, codec, where } = calibration;
  const coded = await codec.decode(new Uint8Array(await bytes(view)), where);
  const count = coded.poses.length / 12;
  if (count !== heldOut.length) throw damaged(where, `${count} cameras in it, and ${heldOut.length} names`);
  const table = (numbers: Float32Array): Table => ({ numbers: checkFinite(numbers, where), where });
  return { lenses: table(coded.intrinsics), poses: table(coded.poses) };
}

/** Width and height of each photograph. */
async function readSizes(scene: SceneDocument, bytes: ViewBytes): Promise<Table> {
  if (!Array.isArray(scene.sizes)) return readTable(scene.sizes, scene, bytes);
  const [width, height] = scene.sizes;
  const numbers = Uint32Array.from({ length: 2 * scene.heldOut.length }, (_, i) => (i % 2 ? height : width));
  return { numbers, where: "its cameras' size" };
}

function poseOf(p: number[], where: string, name: string): { R: Matrix3rows; t: Vector } {
  const row = (r: number): Vector => [p[4 * r] ?? NaN, p[4 * r + 1] ?? NaN, p[4 * r + 2] ?? NaN];
  const R: Matrix3rows = [row(0), row(1), row(2)];
  const t: Vector = [p[3] ?? NaN, p[7] ?? NaN, p[11] ?? NaN];
  for (let a = 0; a < 3; a++) {
    for (let b = a; b < 3; b++) {
      const off = dot(R[a as 0], R[b as 0]) - (a === b ? 1 : 0);
      if (!(Math.abs(off) <= limits.ORTHONORMAL)) throw damaged(where, `the pose of "${name}" is no rotation`);
    }
  }
  if (!(dot(cross(R[0], R[1]), R[2]) > 0)) throw damaged(where, `the pose of "${name}" is mirrored`);
  return { R, t };
}

function coloursOf(numbers: number[], scene: SceneDocument, name: string): [number[], number[]] {
  const [gain, offset] = [numbers.slice(0, 3), numbers.slice(3)];
  const fine =
    gain.every((g) => g >= 1 / limits.MAX_GAIN && g <= limits.MAX_GAIN) &&
    offset.every((o) => Math.abs(o) <= limits.MAX_OFFSET);
  if (!fine) throw damaged(scene.colour?.where ?? "", `gain or offset of "${name}"`);
  return [gain, offset];
}

/** The (encoded cameras) x (eigen textures) weights, row by row, the bases of all planes side by side. */
export async function readWeights(scene: SceneDocument, bytes: ViewBytes): Promise<Float32Array> {
  const rows = scene.heldOut.filter((out) => !out).length;
  return sideBySide(rows, await Promise.all(basesOf(scene).map((basis) => readOwnWeights(basis, rows, scene, bytes))));
}

/** Tables of so many rows as one. */
export function sideBySide(rows: number, parts: Numbers[]): Float32Array {
  const total = parts.reduce((sum, { length }) => sum + length, 0) / rows;
  const merged = new Float32Array(rows * total);
  let column = 0;
  for (const part of parts) {
    const width = part.length / rows;
    for (let row = 0; row < rows; row++) {
      merged.set(part.subarray(row * width, (row + 1) * width), row * total + column);
    }
    column += width;
  }
  return merged;
}

async function readOwnWeights(
  { weights, count }: Basis,
  rows: number,
  scene: SceneDocument,
  bytes: ViewBytes,
): Promise<Numbers> {
  if (!weights) return new Float32Array(0);
  if ("type" in weights) return readNumbers(weights, scene.views, bytes);
  const { view, codec, where } = weights;
  return checkWeights(codec.decode(new Uint8Array(await bytes(view)), where), rows, count, where);
}

export function checkWeights(
  { cameras, components, values }: CodedWeights,
  rows: number,
  count: number,
  where: string,
): Float32Array {
  if (cameras === rows && components === count) return checkFinite(values, where);
  throw damaged(where, `${cameras} x ${components} weights, and ${rows} encoded cameras x ${count} textures`);
}

/** The bases of all planes, in the order of the weights' columns. */
export function basesOf(scene: SceneDocument): Basis[] {
  return scene.planes.flatMap(({ bases }) => bases);
}

/** Eigen textures of the largest basis. */
export function ranksOf(scene: SceneDocument): number {
  return Math.max(0, ...basesOf(scene).map(({ count }) => count));
}

/** Columns and rows of the texture that is drawn: the most of any mean and any grid; opacity is made as fine. */
export function atlasOf(scene: SceneDocument, means: [number, number][]): [number, number] {
  const sizes = [...means.slice(0, scene.planes.length), ...basesOf(scene).map(({ grid }) => grid)];
  return [Math.max(...sizes.map(([width]) => width)), Math.max(...sizes.map(([, height]) => height))];
}

/** Triangles of the view plane, as indices of encoded cameras. */
export async function readTriangles(scene: SceneDocument, bytes: ViewBytes): Promise<Uint32Array> {
  if (!scene.triangles) return new Uint32Array(0);
  const { where } = scene.triangles;
  const triangles = await readCorners(scene.triangles, scene, bytes);
  const encoded = scene.heldOut.filter((out) => !out).length;
  for (let i = 0; i < triangles.length; i += 3) {
    const [a = encoded, b = encoded, c = encoded] = triangles.subarray(i, i + 3);
    if (Math.max(a, b, c) >= encoded) throw damaged(where, `no encoded camera ${Math.max(a, b, c)}`);
    if (a === b || b === c || c === a) throw damaged(where, "a triangle with one camera twice");
  }
  return triangles;
}

async function readCorners(
  triangles: Accessor | Stream<"triangles">,
  scene: SceneDocument,
  bytes: ViewBytes,
): Promise<Uint32Array> {
  if ("type" in triangles) return Uint32Array.from(await readNumbers(triangles, scene.views, bytes));
  return triangles.codec.decode(new Uint8Array(await bytes(triangles.view)), triangles.where).corners;
}

export function sceneInfo(
  scene: SceneDocument,
  cameras: CaptureCamera[],
  means: [number, number][],
  grid: Grid | null,
  total: number,
  mesh: { vertices: number; triangles: number },
): SceneInfo {
  const { right, up } = scene;
  const normal = cross(right, up);
  const forward: Vector = [0, 0, 0];
  for (const { R } of cameras) for (let i = 0; i < 3; i++) forward[i as 0] += R[2][i as 0] / cameras.length;
  const metres = scene.settings["metresPerUnit"];
  return {
    version: scene.version,
    generator: scene.generator,
    rights: scene.rights,
    names: cameras.map(({ name }) => name),
    heldOut: scene.heldOut,
    reference: scene.reference,
    cameras,
    viewPlane: { origin: scene.origin, right, up, normal, extent: scene.extent },
    grid: grid && { rows: grid.rows, columns: grid.columns },
    settings: scene.settings,
    scores: scene.scores,
    metresPerUnit: typeof metres === "number" && metres > 0 && metres <= limits.MAX_NUMBER ? metres : null,
    bytes: countBytes(scene, total),
    size: atlasOf(scene, means),
    planes: scene.planes.map(({ channels, bases }, i) => ({
      channels,
      mean: means[i] ?? [1, 1],
      bases: bases.map(({ count, size, grid }) => ({ textures: count, size, grid })),
    })),
    ...mesh,
    mixedColours: scene.colour !== null && !("type" in scene.colour),
    sheets: scene.sheets?.faces.length ?? 0,
    inFiles: scene.timeline?.groups.some(({ file }) => file !== null) ?? false,
    facesPlane: Math.abs(dot(forward, normal)) > 0.7,
  };
}

function countBytes(scene: SceneDocument, total: number): SceneInfo["bytes"] {
  const counted = new Set<number>();
  const lengthOf = (view: number): number => {
    if (counted.has(view)) return 0;
    counted.add(view);
    return scene.views[view]?.length ?? 0;
  };
  const sum = (views: number[]): number => views.reduce((bytes, view) => bytes + lengthOf(view), 0);
  const means = scene.planes.flatMap(({ mean, precision }) => [mean.view, ...(precision ? [precision.view] : [])]);
  const mean = sum(scene.preview === null ? means : [scene.preview, ...means]);
  const textures = Array<number>(ranksOf(scene)).fill(0);
  for (const { pictures } of basesOf(scene)) {
    let rank = 0;
    for (const { view, textures: count } of pictures) {
      const length = lengthOf(view);
      for (let i = 0; i < count; i++) {
        const share = Math.floor((length * (i + 1)) / count) - Math.floor((length * i) / count);
        textures[rank] = (textures[rank++] ?? 0) + share;
      }
    }
  }
  const weights = sum(basesOf(scene).flatMap((basis) => (basis.weights ? [basis.weights.view] : [])));
  const mesh = sum([...Object.values(scene.shown ?? {}), ...(scene.mesh ? [scene.mesh] : [])].map(({ view }) => view));
  const opacity = scene.sheets ? lengthOf(scene.sheets.opacity.mean.view) : 0;
  const groups = scene.timeline?.groups.reduce((bytes, { length }) => bytes + length, 0) ?? 0;
  const other = total - mean - weights - mesh - opacity - groups - textures.reduce((a, b) => a + b, 0);
  return { total, mesh, opacity, mean, weights, groups, other, textures };
}

/** X, Y of a world point, dropped onto the view plane. */
export function planeCoordinates(plane: Omit<ViewPlane, "normal">, point: Vector): [number, number] {
  const { origin, extent } = plane;
  const from: Vector = [point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]];
  return [extent[0] > 0 ? dot(from, plane.right) / extent[0] : 0, extent[1] > 0 ? dot(from, plane.up) / extent[1] : 0];
}

function centreOf(R: Matrix3rows, t: Vector): Vector {
  const entry = (i: 0 | 1 | 2): number => -(R[0][i] * t[0] + R[1][i] * t[1] + R[2][i] * t[2]);
  return [entry(0), entry(1), entry(2)];
}

export function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
