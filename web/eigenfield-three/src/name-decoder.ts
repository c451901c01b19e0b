// Names of cameras, as `docs/coding.md` codes them.

import { damaged } from "./errors.js";
import { inflated } from "./inflate.js";
import * as limits from "./limits.js";

const MOST_BYTES = 4 * limits.MAX_NAME; // of one name in UTF-8

/** `count` names. Raises SceneError `damaged`. */
export async function decodeNames(bytes: Uint8Array, count: number, where: string): Promise<string[]> {
  const most = Math.min(limits.MAX_NAMES, MOST_BYTES * count);
  const columns = await inflated(Uint8Array.from(bytes), "deflate", most, where);
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
