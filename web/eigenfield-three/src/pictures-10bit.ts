// Pictures of 10-bit codes, all ten of them: an ImageBitmap keeps eight.

import { checkPicture, decodeBitmaps } from "./pictures-8bit.js";
import type { Codes, Piece, PictureDecoder } from "./pieces.js";

const FORMATS = new Set(["I420P10", "I422P10", "I444P10"]);

/** All ten bits where the browser gives them, else the upper eight. */
export const decodeTenBits: PictureDecoder = async (bytes, picture, size) => {
  const count = picture.pieces * picture.textures;
  const [width, rows] = checkPicture(bytes, picture, size && [size[0], count * size[1]]);
  const codes = await decodeCodes(bytes, width, rows);
  if (!codes) return decodeBitmaps(bytes, picture, size);
  const height = rows / count;
  return Array.from({ length: count }, (_, i): Piece => ({ picture: codes, row: i * height, rows: height }));
};

/** The first channel of an AVIF picture of that size; null where the browser does not give its codes. */
async function decodeCodes(bytes: ArrayBuffer, width: number, height: number): Promise<Codes | null> {
  if (typeof ImageDecoder === "undefined") return null;
  let decoder: ImageDecoder | null = null;
  let frame: VideoFrame | null = null;
  try {
    decoder = new ImageDecoder({ data: bytes, type: "image/avif" });
    frame = (await decoder.decode()).image;
    const visible = frame.visibleRect;
    if (!FORMATS.has(frame.format ?? "") || visible?.width !== width || visible.height !== height) return null;
    const data = new Uint8Array(frame.allocationSize());
    const [luma] = await frame.copyTo(data);
    return luma ? { data: data.subarray(luma.offset), width, height, stride: luma.stride } : null;
  } catch {
    return null; // another decoder reports what is wrong
  } finally {
    frame?.close();
    decoder?.close();
  }
}
