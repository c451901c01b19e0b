// Tables of whole numbers, and which camera of a grid stands where.

import { damaged } from "./errors.js";
import { RangeDecoder, binaryDigits } from "./range-decoder.js";

const SIZES = 12;
const ZONES = 12;
const SLOPES = 1;
export const FREQUENCIES = 2;
const WAYS = 3;
const OWN = SIZES * SIZES + 2 * SIZES + SIZES * ZONES;
const WAY = WAYS * OWN;
const LINE = WAY + 2;
const SPREAD = 24;
const COLUMNS = 16;
const CELL = LINE + 2 * COLUMNS * SPREAD + COLUMNS;
const CONTEXTS = CELL + 4;
const M_CELL = WAYS + 1;
const M_LINE = WAYS + 2;

/** A decoder of tables at the first byte behind a part's header. */
export function tableDecoder(bytes: Uint8Array): RangeDecoder {
  return new RangeDecoder(bytes, CONTEXTS, M_LINE + COLUMNS);
}

/** 2: as a cosine transform, 1: less what the neighbours suggest, 0: as they are. */
export function readWay(decoder: RangeDecoder): number {
  if (decoder.flag(WAY, WAY, WAY, WAYS)) return FREQUENCIES;
  return decoder.flag(WAY + 1, WAY + 1, WAY + 1, WAYS) ? SLOPES : 0;
}

function sizeClass(value: number): number {
  return Math.min(binaryDigits(value), SIZES - 1);
}

/** A table row by row, after the table `before` of the same shape. */
export function readTable(decoder: RangeDecoder, columns: number, before: Float64Array, way: number): Float64Array {
  const table = new Float64Array(before.length);
  const rows = before.length / columns;
  const at = (from: Float64Array, row: number, column: number) =>
    row < 0 || column < 0 || column >= columns ? 0 : from[row * columns + column]!;
  let last = 0;
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++) {
      const [left, above] = [at(table, row, column - 1), at(table, row - 1, column)];
      const [corner, ahead] = [at(table, row - 1, column - 1), at(table, row - 1, column + 1)];
      let [expected, near, far] = [0, 0, last];
      if (way === SLOPES) {
        if (row === 0) expected = left;
        else if (column === 0) expected = above;
        else expected = Math.max(Math.min(left, above), Math.min(Math.max(left, above), left + above - corner));
        near = Math.abs(left - corner) + Math.abs(above - corner) + Math.abs(ahead - above);
      } else {
        near = 2 * Math.abs(left) + 2 * Math.abs(above) + Math.abs(corner) + Math.abs(ahead);
        far = Math.abs(at(table, row, column - 2)) + Math.abs(at(table, row - 2, column));
      }
      const old =
        2 * Math.abs(at(before, row, column)) +
        Math.abs(at(before, row, column - 1)) +
        Math.abs(at(before, row, column + 1));
      const zone = way === FREQUENCIES ? Math.min(row, 2) * 4 + Math.min(column, 3) : Math.min(row, 1);
      const own = way * OWN;
      const off = decoder.integer(
        own + sizeClass(near) * SIZES + sizeClass(old),
        own + SIZES * SIZES + sizeClass(near + far),
        own + SIZES * SIZES + 2 * SIZES + zone * SIZES + sizeClass(old + Math.abs(left)),
        way,
      );
      table[row * columns + column] = expected + off;
      last = Math.abs(off);
    }
  }
  return table;
}

/** Rows of a table, each less the one before if `chained`. */
export function readLines(decoder: RangeDecoder, rows: number, columns: number, chained: boolean): Float64Array {
  const table = new Float64Array(rows * columns);
  const recent = new Float64Array(columns);
  for (let row = 0; row < rows; row++) {
    let beside = 0;
    for (let column = 0; column < columns; column++) {
      const expected = chained && row > 0 ? table[(row - 1) * columns + column]! : 0;
      const kind = Math.min(column, COLUMNS - 1);
      const up = Math.min(binaryDigits(recent[column]!), SPREAD - 1);
      const left = Math.min(binaryDigits(beside), SPREAD - 1);
      const off = decoder.integer(
        LINE + kind * SPREAD + up,
        LINE + (COLUMNS + kind) * SPREAD + left,
        LINE + 2 * COLUMNS * SPREAD + kind,
        M_LINE + kind,
      );
      table[row * columns + column] = expected + off;
      beside = Math.abs(off);
      recent[column] = Math.floor((recent[column]! + beside + 1) / 2);
    }
  }
  return table;
}

/** The cameras of a grid's cells, row by row, -1 where there is none; each of `cameras` is there once. */
export function readGrid(decoder: RangeDecoder, cells: number, cameras: number, where: string): Float64Array {
  const grid = new Float64Array(cells).fill(-1);
  const found = new Uint8Array(cameras);
  let [expected, there, count] = [0, 1, 0];
  for (let k = 0; k < cells; k++) {
    there = decoder.flag(CELL + there, CELL + there, CELL + 2, M_CELL) ? 1 : 0;
    if (!there) continue;
    const camera = expected + decoder.integer(CELL + 3, CELL + 3, CELL + 3, M_CELL);
    if (!(camera >= 0 && camera < cameras) || found[camera]) throw damaged(where, "a grid with a camera out of place");
    found[camera] = 1;
    grid[k] = camera;
    expected = camera + 1;
    count += 1;
  }
  if (count !== cameras) throw damaged(where, "a grid without all cameras");
  return grid;
}
