// Triangles of the view plane, as `docs/coding.md` codes them.

import { damaged } from "./errors.js";
import * as limits from "./limits.js";
import { checkNumbers, codedHeader } from "./range-decoder.js";
import { readLines, tableDecoder } from "./table-decoder.js";

const HEADER = 5;

export interface CodedTriangles {
  corners: Uint32Array; // three encoded cameras each
}

export function decodeTriangles(bytes: Uint8Array, where: string): CodedTriangles {
  const count = codedHeader(bytes, HEADER, where).getUint32(1, true);
  checkNumbers(bytes, 3 * count, 6 * limits.MAX_CAMERAS, where);
  const decoder = tableDecoder(bytes.subarray(HEADER));
  const lines = readLines(decoder, count, 3, true);
  decoder.checkEnd(where);
  const corners = lines.map((number, i) => (i % 3 ? lines[i - (i % 3)]! + number : number));
  if (!corners.every((corner) => corner >= 0 && corner < limits.MAX_CAMERAS)) {
    throw damaged(where, "triangles of cameras that there cannot be");
  }
  return { corners: Uint32Array.from(corners) };
}
