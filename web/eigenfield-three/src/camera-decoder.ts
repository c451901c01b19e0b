// Intrinsics and poses of cameras, as `docs/coding.md` codes them.

import { damaged } from "./errors.js";
import { inflated } from "./inflate.js";
import * as limits from "./limits.js";
import { checkNumbers, codedHeader } from "./range-decoder.js";
import { readGrid, readLines, tableDecoder } from "./table-decoder.js";

const HEADER = 130;
const NUMBERS = 11;
const ON_GRID = 1;
const FROM_BEFORE = 2;

export interface CodedCameras {
  intrinsics: Float32Array; // fx, fy, skew, cx, cy of each
  poses: Float32Array; // [R t], 12 of each, world to camera
}

const DEFLATED = 2; // version of the codec
const MAX_INFLATED = 4 * NUMBERS * limits.MAX_CAMERAS + 1024; // bytes

/** Cameras of the codec `cameras-2`. Raises SceneError `damaged`. */
export async function inflateCameras(bytes: Uint8Array, where: string): Promise<CodedCameras> {
  if (bytes[0] !== DEFLATED) throw damaged(where, `version ${bytes[0]}`);
  const inner = await inflated(Uint8Array.from(bytes.subarray(1)), "deflate-raw", MAX_INFLATED, where);
  return decodeCameras(Uint8Array.from([1, ...inner]), where);
}

export function decodeCameras(bytes: Uint8Array, where: string): CodedCameras {
  const header = codedHeader(bytes, HEADER, where);
  const [kind, count] = [header.getUint8(1), header.getUint32(6, true)];
  const gridded = (kind & ON_GRID) !== 0;
  const [rows, columns] = gridded ? [header.getUint16(2, true), header.getUint16(4, true)] : [0, 0];
  const doubles = Float64Array.from({ length: 15 }, (_, k) => header.getFloat64(10 + 8 * k, true));
  if (kind > 3 || count === 0 || !doubles.every(Number.isFinite)) throw damaged(where, "cameras that cannot be");
  if (count > limits.MAX_CAMERAS || (gridded && rows * columns < count)) throw damaged(where, `${count} cameras`);
  checkNumbers(bytes, Math.max(NUMBERS * count, rows * columns), NUMBERS * limits.MAX_CAMERAS, where);
  const body = HEADER + (gridded ? 12 * NUMBERS : 0);
  codedHeader(bytes, body, where);
  const plane = (k: number, number: number) =>
    gridded ? header.getFloat32(HEADER + 4 * (k * NUMBERS + number), true) : 0;
  const decoder = tableDecoder(bytes.subarray(body));
  const grid = gridded ? readGrid(decoder, rows * columns, count, where) : null;
  const table = readLines(decoder, count, NUMBERS, (kind & FROM_BEFORE) !== 0);
  decoder.checkEnd(where);
  const made = { intrinsics: new Float32Array(5 * count), poses: new Float32Array(12 * count) };
  const base = [...doubles.subarray(7, 12), 0, 0, 0, ...doubles.subarray(12)];
  const first = rotation(doubles[3]!, doubles[4]!, doubles[5]!, doubles[6]!);
  const numbers = new Float64Array(NUMBERS);
  let line = 0;
  for (let cell = 0; cell < (grid ? grid.length : count); cell++) {
    const camera = grid ? grid[cell]! : cell;
    if (camera < 0) continue;
    const [row, column] = grid ? [Math.floor(cell / columns), cell % columns] : [0, 0];
    for (let k = 0; k < NUMBERS; k++) {
      const unit = doubles[k < 5 ? 0 : k < 8 ? 1 : 2]!;
      const expected = plane(0, k) + plane(1, k) * row + plane(2, k) * column;
      numbers[k] = table[line * NUMBERS + k]! * unit + base[k]! + expected;
    }
    assemble(numbers, first, made, camera);
    line += 1;
  }
  if (!made.intrinsics.every(Number.isFinite) || !made.poses.every(Number.isFinite))
    throw damaged(where, "cameras that are not finite");
  return made;
}

/** Eleven numbers to the place of a camera. */
function assemble(numbers: Float64Array, first: number[], made: CodedCameras, camera: number): void {
  made.intrinsics.set(numbers.subarray(0, 5), 5 * camera);
  const [px, py, pz] = [numbers[5]!, numbers[6]!, numbers[7]!];
  const square = px * px + py * py + pz * pz;
  const scale = 1 + square;
  const turn = rotation((2 * px) / scale, (2 * py) / scale, (2 * pz) / scale, (1 - square) / scale);
  for (let row = 0; row < 3; row++) {
    let shift = 0;
    for (let column = 0; column < 3; column++) {
      let sum = 0;
      for (let k = 0; k < 3; k++) sum += turn[3 * row + k]! * first[3 * k + column]!;
      made.poses[12 * camera + 4 * row + column] = sum;
      shift -= sum * numbers[8 + column]!;
    }
    made.poses[12 * camera + 4 * row + 3] = shift;
  }
}

/** The matrix of a unit quaternion, row by row. */
function rotation(x: number, y: number, z: number, w: number): number[] {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
  ].flat();
}
