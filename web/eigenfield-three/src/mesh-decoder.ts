// A triangle mesh with texture coordinates, as `docs/coding.md` codes it.

import { damaged } from "./errors.js";
import * as limits from "./limits.js";
import { MAPPED, type Vertices, cornerLists, readCorners } from "./mesh-corners.js";
import { type Built, readFaces } from "./mesh-faces.js";
import { CONTEXTS, MIXTURES, readDepths, readTextures } from "./mesh-values.js";
import { RangeDecoder, checkNumbers, codedHeader } from "./range-decoder.js";

const HEADER = 144;
const VERSION = 2;
const OFFSET_RANGE = 3; // binary digits of an offset beyond those of u and v
const MOST_DIGITS = 18;
const MOST_FINE = 8;

export interface DecodedMesh {
  positions: Float32Array; // three a vertex
  uv: Float32Array; // two a vertex
  indices: Uint32Array; // three a face
  places: Int32Array; // lattice coordinates, three a vertex
  matrix: Float64Array; // from these to the world, four by four
}

/** A mesh of the codec `mesh-1`. Raises SceneError: `damaged`, `truncated`. */
export function decodeOldMesh(bytes: Uint8Array, where: string): DecodedMesh {
  return decode(bytes, where, 1);
}

/** A mesh of the codec `mesh-2`. Raises SceneError: `damaged`, `truncated`. */
export function decodeMesh(bytes: Uint8Array, where: string): DecodedMesh {
  return decode(bytes, where, VERSION);
}

function decode(bytes: Uint8Array, where: string, version: number): DecodedMesh {
  const header = codedHeader(bytes, HEADER, where, version);
  const [flat, digits, fine] = [header.getUint8(1), header.getUint8(2), header.getUint8(3)];
  const [places, faces, count] = [4, 8, 12].map((at) => header.getUint32(at, true)) as [number, number, number];
  const matrix = Float64Array.from({ length: 16 }, (_, k) => header.getFloat64(16 + 8 * k, true));
  if (places > limits.MAX_VERTICES || count > limits.MAX_VERTICES || faces > limits.MAX_TRIANGLES)
    throw damaged(where, `${count} vertices and ${faces} faces`);
  checkNumbers(bytes, Math.max(places, faces, count), limits.MAX_TRIANGLES, where);
  if (flat > 1 || fine > MOST_FINE * flat || digits < 1 || digits > MOST_DIGITS || !matrix.every(Number.isFinite))
    throw damaged(where, "a lattice that cannot be");
  const decoder = new RangeDecoder(bytes.subarray(HEADER), CONTEXTS, MIXTURES);
  const built = readFaces(decoder, places, faces, { flat: flat === 1, fine }, where);
  decoder.checkEnd(where);
  const around = cornerLists(built.faces, places);
  if (flat) readDepths(decoder, built, around.first, around.corners);
  const offsetDigits = version === VERSION ? digits + OFFSET_RANGE : 32;
  const vertices = readCorners(decoder, built, count, around.first, around.corners, offsetDigits, where);
  const world = worldPositions(built.points, matrix);
  const lists = cornerLists(vertices.faces, count);
  const codes = readTextures(decoder, vertices, world, lists.first, lists.corners);
  decoder.checkEnd(where);
  const floats = new Float32Array(vertices.maps.buffer);
  const offset = (at: number): number =>
    version === VERSION ? vertices.maps[at]! / 2 ** (digits + 1) - 2 : floats[at]!;
  return checked({ ...assembled(built, vertices, world, codes, 2 ** digits, offset), matrix }, where);
}

/** Lattice points through a homogeneous matrix, three a point. */
function worldPositions(points: Int32Array, m: Float64Array): Float64Array {
  const world = new Float64Array(points.length);
  for (let at = 0; at < points.length; at += 3) {
    const row = (r: number) =>
      m[4 * r]! * points[at]! + m[4 * r + 1]! * points[at + 1]! + m[4 * r + 2]! * points[at + 2]! + m[4 * r + 3]!;
    const w = row(3);
    for (let axis = 0; axis < 3; axis++) world[at + axis] = row(axis) / w;
  }
  return world;
}

function assembled(
  built: Built,
  { faces, place, chart, kinds, maps }: Vertices,
  world: Float64Array,
  codes: Int32Array,
  scale: number,
  offset: (at: number) => number,
): Omit<DecodedMesh, "matrix"> {
  const positions = new Float32Array(3 * place.length);
  const places = new Int32Array(3 * place.length);
  const uv = new Float32Array(2 * place.length);
  const map = new Float32Array(maps.buffer);
  place.forEach((at, vertex) => {
    positions.set(world.subarray(3 * at, 3 * at + 3), 3 * vertex);
    places.set(built.points.subarray(3 * at, 3 * at + 3), 3 * vertex);
    const from = 6 * chart[vertex]!;
    const mapped = kinds[chart[vertex]!] === MAPPED;
    for (let axis = 0; axis < 2; axis++) {
      const row = from + 2 * axis;
      uv[2 * vertex + axis] = mapped
        ? map[row]! * built.points[3 * at]! + map[row + 1]! * built.points[3 * at + 1]! + offset(from + 4 + axis)
        : codes[2 * vertex + axis]! / scale;
    }
  });
  return { positions, uv, indices: new Uint32Array(faces), places };
}

function checked(mesh: DecodedMesh, where: string): DecodedMesh {
  const fits = (value: number) => Math.abs(value) <= limits.MAX_NUMBER; // false for NaN
  if (!mesh.positions.every(fits) || !mesh.uv.every(fits))
    throw damaged(where, "positions or texture coordinates that are not finite");
  return mesh;
}
