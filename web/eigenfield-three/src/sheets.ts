// Sheets of the proxy, which are drawn one over the other: their faces, and the picture of their opacity.

import type { BufferGeometry } from "three";
import type { ViewReader } from "./accessors.js";
import { damaged } from "./errors.js";
import type { Value } from "./json.js";
import * as limits from "./limits.js";
import { readOpacity, type Still } from "./planes.js";
import type { SheetsJson } from "./schema.js";

export interface Sheets {
  faces: number[]; // of each sheet, back to front; the mesh has them in this order
  opacity: Still;
  where: string;
}

export function readSheets(value: Value<SheetsJson>, viewOf: ViewReader): Sheets | null {
  if (!value.exists) return null;
  const faces = value.key("faces").items(limits.MAX_SHEETS).map((item) => item.integer(1, limits.MAX_TRIANGLES));
  if (!faces.length) throw value.key("faces").wrong("no sheet");
  return { faces, opacity: readOpacity(value.key("opacity"), viewOf), where: value.where };
}

/** Raises SceneError `damaged` unless the sheets divide the mesh, without a vertex in two of them. */
export function checkSheets({ faces, where }: Omit<Sheets, "opacity">, { index, attributes }: BufferGeometry): void {
  const total = faces.reduce((a, b) => a + b, 0);
  const triangles = (index?.count ?? 0) / 3;
  if (total !== triangles) {
    throw damaged(`${where}/faces`, `the sheets have ${total} triangles, the mesh has ${triangles}`);
  }
  const owners = new Uint8Array(attributes["position"]?.count ?? 0); // sheets of vertices, counted from 1
  let corner = 0;
  faces.forEach((count, sheet) => {
    for (const end = corner + 3 * count; corner < end; corner++) {
      const vertex = index?.getX(corner) ?? 0;
      const owner = owners[vertex] || sheet + 1;
      const shared = `sheets ${owner - 1} and ${sheet} share vertex ${vertex}`;
      if (owner !== sheet + 1) throw damaged(`${where}/faces`, shared);
      owners[vertex] = owner;
    }
  });
}
