// What browsers inflate, with a limit.

import { damaged } from "./errors.js";

/** What a stream of `format` holds, at most `most` bytes. Raises SceneError `damaged`. */
export async function inflated(
  bytes: Uint8Array<ArrayBuffer>,
  format: CompressionFormat,
  most: number,
  where: string,
): Promise<Uint8Array> {
  const pieces: Uint8Array[] = [];
  let size = 0;
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format)).getReader();
  try {
    for (let next = await reader.read(); !next.done && size <= most; next = await reader.read()) {
      pieces.push(next.value);
      size += next.value.length;
    }
  } catch {
    throw damaged(where, "it does not inflate");
  }
  if (size > most) {
    await reader.cancel();
    throw damaged(where, `more than ${most} bytes`);
  }
  const whole = new Uint8Array(size);
  let at = 0;
  for (const piece of pieces) {
    whole.set(piece, at);
    at += piece.length;
  }
  return whole;
}
