// The captured cameras in an order that one can find them in: the rows of a grid from the top, each from the left;
// elsewhere by name, numbers by their value.

import type { SceneInfo } from "eigenfield-three";
import { add, dot, scaled } from "./geometry";
import { words } from "./language";

export interface CameraGroup {
  label: string | null; // null: the only group
  indices: readonly number[]; // into info.cameras
}
export type CameraOrder = readonly CameraGroup[];

const MANY = 24; // cameras: fewer are one list

export function inOrder(info: SceneInfo): CameraOrder {
  const { cameras, names, grid, viewPlane } = info;
  const all = cameras.map((_, index) => index);
  if (!grid || grid.rows < 2 || cameras.length < MANY) {
    const byName = new Intl.Collator("en", { numeric: true });
    return [{ label: null, indices: all.sort((a, b) => byName.compare(names[a] ?? "", names[b] ?? "")) }];
  }
  const offsets = cameras.map(({ centre }) => add(centre, scaled(viewPlane.origin, -1)));
  const across = offsets.map((offset) => dot(offset, viewPlane.right));
  const upwards = offsets.map((offset) => dot(offset, viewPlane.up));
  const at = (numbers: readonly number[], index: number): number => numbers[index] ?? 0;
  const fromTop = all.sort((a, b) => at(upwards, b) - at(upwards, a));
  // Rows part where the steps down are largest.
  const steps = fromTop.map((index, i) => (i === 0 ? 0 : at(upwards, at(fromTop, i - 1)) - at(upwards, index)));
  const cuts = [...steps.keys()].sort((a, b) => at(steps, b) - at(steps, a)).slice(0, grid.rows - 1);
  const ends = [...cuts.sort((a, b) => a - b), fromTop.length];
  return ends.map((end, row) => ({
    label: words("row", { row: row + 1, rows: grid.rows }),
    indices: fromTop.slice(row === 0 ? 0 : ends[row - 1], end).sort((a, b) => at(across, a) - at(across, b)),
  }));
}
