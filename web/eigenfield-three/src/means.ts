// The mean of a plane, and the picture of its precision; the opacity of sheets in the same way.

import type { ViewBytes } from "./accessors.js";
import { damaged } from "./errors.js";
import { readHeader } from "./headers.js";
import { closePieces, type Piece } from "./pieces.js";
import type { Precision, Still } from "./planes.js";

/** A mean, and where it has one the picture of its precision. */
export interface Mean {
  pieces: Piece[];
  precision: ImageBitmap | null;
}

/** Decodes a mean or an opacity. Whoever takes it closes it. */
export async function decodeMean(still: Still, bytes: ViewBytes): Promise<Mean> {
  const { mean, meanSize } = still;
  const precision = still.precision && (await decodePrecision(await bytes(still.precision.view), still.precision));
  return { pieces: await mean.codec.decode(await bytes(mean.view), mean, meanSize), precision };
}

async function decodePrecision(bytes: ArrayBuffer, precision: Precision): Promise<ImageBitmap> {
  const { type } = readHeader(bytes) ?? {};
  const { mimeType } = precision.codec;
  if (type && type !== mimeType) throw damaged(precision.where, `${type}, not ${mimeType}`);
  const [piece] = await precision.codec.bitmaps(bytes, precision, precision.size);
  if (!piece) throw damaged(precision.where, "no picture");
  return piece.picture;
}

export function closeMean({ pieces, precision }: Mean): void {
  closePieces(pieces);
  precision?.close();
}
