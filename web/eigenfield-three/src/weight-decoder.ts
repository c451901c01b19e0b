// The weights of eigen textures, as `docs/coding.md` codes them.

import { damaged } from "./errors.js";
import * as limits from "./limits.js";
import { checkNumbers, codedHeader } from "./range-decoder.js";
import { FREQUENCIES, readGrid, readTable, readWay, tableDecoder } from "./table-decoder.js";

const HEADER = 14;
const LARGEST = 2 ** 20;

export interface CodedWeights {
  cameras: number;
  components: number;
  values: Float32Array; // row by row, a row a camera
}

export function decodeWeights(bytes: Uint8Array, where: string): CodedWeights {
  const header = codedHeader(bytes, HEADER, where);
  const gridded = header.getUint8(1) === 1;
  const [cameras, components] = [header.getUint32(6, true), header.getUint32(10, true)];
  const rows = gridded ? header.getUint16(2, true) : 1;
  const columns = gridded ? header.getUint16(4, true) : cameras;
  if (header.getUint8(1) > 1 || cameras === 0) throw damaged(where, "weights of no camera, or of an unknown kind");
  checkNumbers(bytes, rows * columns * Math.max(components, 1), limits.MAX_WEIGHTS, where);
  codedHeader(bytes, HEADER + 4 * components, where);
  const cells = rows * columns;
  if (cells < cameras) throw damaged(where, "a grid with too few cells");
  const decoder = tableDecoder(bytes.subarray(HEADER + 4 * components));
  const grid = gridded ? readGrid(decoder, cells, cameras, where) : null;
  const full = grid !== null && cameras === cells;
  const before: Float64Array[] = [0, 1, 2].map(() => new Float64Array(cells));
  const values = new Float32Array(cameras * components);
  const most = 4 * LARGEST * Math.max(rows, columns);
  for (let k = 0; k < components; k++) {
    const step = header.getFloat32(HEADER + 4 * k, true);
    if (!(step > 0 && step < Infinity)) throw damaged(where, "a step that is not positive");
    const way = readWay(decoder);
    const table = readTable(decoder, columns, before[way]!, way);
    if ((way === FREQUENCIES && !full) || table.some((value) => Math.abs(value) > most))
      throw damaged(where, `numbers of component ${k} that cannot be`);
    before[way] = table;
    const numbers = way === FREQUENCIES ? inverseCosine(table, rows, columns) : table;
    for (let cell = 0; cell < cells; cell++) {
      const camera = grid ? grid[cell]! : cell;
      if (camera >= 0) values[camera * components + k] = numbers[cell]! * step;
    }
    decoder.checkEnd(where);
  }
  if (!values.every(Number.isFinite)) throw damaged(where, "weights that are not finite");
  return { cameras, components, values };
}

/** The inverse of the orthonormal discrete cosine transform (DCT-II) of rows and columns. */
function inverseCosine(table: Float64Array, rows: number, columns: number): Float64Array {
  const half = new Float64Array(rows * columns);
  const result = new Float64Array(rows * columns);
  const across = cosines(columns);
  for (let row = 0; row < rows; row++)
    for (let x = 0; x < columns; x++) {
      let sum = 0;
      for (let k = 0; k < columns; k++) sum += across(k, x) * table[row * columns + k]!;
      half[row * columns + x] = sum;
    }
  const down = cosines(rows);
  for (let y = 0; y < rows; y++)
    for (let x = 0; x < columns; x++) {
      let sum = 0;
      for (let k = 0; k < rows; k++) sum += down(k, y) * half[k * columns + x]!;
      result[y * columns + x] = sum;
    }
  return result;
}

/** The k-th of n cosines at place x, from a table of one round: n * n numbers could be more than there is memory. */
function cosines(n: number): (k: number, x: number) => number {
  const [level, height] = [Math.sqrt(1 / n), Math.sqrt(2 / n)];
  const round = Float64Array.from({ length: 4 * n }, (_, i) => height * Math.cos((Math.PI * i) / (2 * n)));
  return (k, x) => (k === 0 ? level : round[((2 * x + 1) * k) % (4 * n)]!);
}
