// Pictures of 10-bit codes, all ten of them: an ImageBitmap keeps eight.

import { checkPicture, decodeBitmaps } from "./pictures-8bit.js";
import type { Codes, Piece, PictureDecoder } from "./pieces.js";

const FORMATS = new Set(["I420P10", "I422P10", "I444P10"]);

/** All ten bits where the browser gives them, else the upper eight. */
export const decodeTenBits: PictureDecoder = async (bytes, picture, size, down = 1) => {
  const count = picture.pieces * picture.textures;
  const [width, rows] = checkPicture(bytes, picture, size && [size[0], count * size[1]]);
  const codes = await decodeCodes(bytes, width, rows);
  if (!codes) return decodeBitmaps(bytes, picture, size, down);
  const height = rows / count;
  return Array.from({ length: count }, (_, i): Piece => {
    if (down === 1) return { picture: codes, row: i * height, rows: height };
    const smaller = smallerCodes(codes, i * height, height, down);
    return { picture: smaller, row: 0, rows: smaller.height };
  });
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

/** Rows of codes `down` times smaller along each side: means of the codes that they take the place of. */
function smallerCodes(codes: Codes, row: number, rows: number, down: number): Codes {
  const [width, height] = [Math.ceil(codes.width / down), Math.ceil(rows / down)];
  const made = new Uint8Array(2 * width * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      let [sum, count] = [0, 0];
      for (let v = y * down; v < Math.min((y + 1) * down, rows); v++) {
        for (let u = x * down; u < Math.min((x + 1) * down, codes.width); u++) {
          const at = (row + v) * codes.stride + 2 * u;
          sum += (codes.data[at] ?? 0) + 256 * (codes.data[at + 1] ?? 0);
          count += 1;
        }
      }
      const mean = Math.round(sum / count);
      made.set([mean & 255, mean >> 8], 2 * (y * width + x));
    }
  }
  return { data: made, width, height, stride: 2 * width };
}
