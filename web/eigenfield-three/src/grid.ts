// The grid on which cameras stand, if they do: the rule of eigenfield/viewplane.py.

/** Row 0 is the lowest Y, column 0 the lowest X; `index` is row by row. */
export interface Grid {
  rows: number;
  columns: number;
  index: Int32Array;
}

/** The grid of n places (X, Y, X, Y, ...): every node occupied once, jitter below a quarter of the spacing. */
export function findGrid(places: Float64Array): Grid | null {
  const total = places.length / 2;
  for (let rows = 1; rows * rows <= total; rows++) {
    if (total % rows) continue;
    const columns = total / rows;
    const found = gridOf(places, rows, columns) ?? (rows === columns ? null : gridOf(places, columns, rows));
    if (found) return found;
  }
  return null;
}

function gridOf(places: Float64Array, rows: number, columns: number): Grid | null {
  const [x, y] = [axis(places, 0), axis(places, 1)];
  if ((rows === 1 && spread(y) > 0) || (columns === 1 && spread(x) > 0)) return null;
  const order = Array.from(x, (_, i) => i).sort((a, b) => at(y, a) - at(y, b));
  for (let row = 0; row < rows; row++) {
    const sorted = order.slice(row * columns, (row + 1) * columns).sort((a, b) => at(x, a) - at(x, b));
    order.splice(row * columns, columns, ...sorted);
  }
  const byColumn = (row: number, column: number): number => order[row * columns + column] ?? 0;
  const regular =
    isRegular(columns, rows, (column, row) => at(x, byColumn(row, column))) &&
    isRegular(rows, columns, (row, column) => at(y, byColumn(row, column)));
  return regular ? { rows, columns, index: Int32Array.from(order) } : null;
}

/** Whether lines of the grid rise in steps more than four times as long as they jitter. */
function isRegular(lines: number, across: number, value: (line: number, place: number) => number): boolean {
  let step = Infinity;
  let jitter = 0;
  let before = NaN;
  for (let line = 0; line < lines; line++) {
    let mean = 0;
    for (let place = 0; place < across; place++) mean += value(line, place) / across;
    for (let place = 0; place < across; place++) jitter = Math.max(jitter, Math.abs(value(line, place) - mean));
    if (line) step = Math.min(step, mean - before);
    before = mean;
  }
  return step > 0 && (step === Infinity || jitter <= step / 4);
}

function axis(places: Float64Array, which: 0 | 1): Float64Array {
  return Float64Array.from({ length: places.length / 2 }, (_, i) => places[2 * i + which] ?? 0);
}

function spread(values: Float64Array): number {
  return values.reduce((a, b) => Math.max(a, b), -Infinity) - values.reduce((a, b) => Math.min(a, b), Infinity);
}

const at = (values: Float64Array, index: number): number => values[index] ?? 0;
