// Names of cameras, as `docs/coding.md` codes them.

import { damaged } from "./errors.js";
import * as limits from "./limits.js";

const MOST_BYTES = 4 * limits.MAX_NAME; // of one name in UTF-8

/** `count` names. Raises SceneError `damaged`. */
export async function decodeNames(bytes: Uint8Array, count: number, where: string): Promise<string[]> {
  const columns = await inflated(bytes, Math.min(limits.MAX_NAMES, MOST_BYTES * count), where);
  const length = columns.length / count;
  if (length === 0 || !Number.isInteger(length)) throw damaged(where, `${columns.length} bytes of ${count} names`);
  const decoder = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true });
  const text = new Uint8Array(length);
  const names: string[] = [];
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < length; k++) text[k] = columns[k * count + i]!;
    let end = length;
    while (end > 0 && text[end - 1] === 0) end -= 1;
    try {
      names.push(decoder.decode(text.subarray(0, end)));
    } catch {
      throw damaged(where, "names that are not UTF-8");
    }
  }
  return names;
}

/** What a zlib stream of at most `most` bytes holds. */
async function inflated(bytes: Uint8Array, most: number, where: string): Promise<Uint8Array> {
  const pieces: Uint8Array[] = [];
  let size = 0;
  const stream = new Blob([Uint8Array.from(bytes)]).stream().pipeThrough(new DecompressionStream("deflate"));
  const reader = stream.getReader();
  try {
    for (let next = await reader.read(); !next.done && size <= most; next = await reader.read()) {
      pieces.push(next.value);
      size += next.value.length;
    }
  } catch {
    throw damaged(where, "names that do not inflate");
  }
  if (size > most) {
    await reader.cancel();
    throw damaged(where, `more than ${most} bytes of names`);
  }
  const whole = new Uint8Array(size);
  let at = 0;
  for (const piece of pieces) {
    whole.set(piece, at);
    at += piece.length;
  }
  return whole;
}
