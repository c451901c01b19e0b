// Pictures of 8-bit codes, decoded by the browser with colour management off.

import { SceneError, damaged } from "./errors.js";
import { readHeader } from "./headers.js";
import * as limits from "./limits.js";
import type { PictureDecoder, PictureFile } from "./pieces.js";

const OPTIONS: ImageBitmapOptions = { colorSpaceConversion: "none", premultiplyAlpha: "none" };

// Eight grey texels square and one: they distinguish a browser without the codec from a damaged picture.
const PROBES: Record<string, string> = {
  "image/avif":
    "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOltZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAA" +
    "AAABAAAAHmlsb2MAAAAARAAAAQABAAAAAQAAAQ0AAAAZAAAAKGlpbmYAAAAAAAEAAAAaaW5mZQIAAAAAAQAAYXYwMUNvbG9yAAAAAGhpcHJwAAAA" +
    "SWlwY28AAAAUaXNwZQAAAAAAAAAIAAAACAAAAA5waXhpAAAAAAEIAAAADGF2MUOBABwAAAAAE2NvbHJuY2x4AAEADQAGgAAAABdpcG1hAAAAAAAA" +
    "AAEAAQQBAoMEAAAAIW1kYXQSAAoIGAi/aYCGg1AyCxlGIYeeaACQQNmg",
  "image/webp": "UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAAAdQwAIWsP+BiOh/AAA=",
};

/** The size that a picture's header states, checked against limits and, where there is one, the announced size. */
export function checkPicture(
  bytes: ArrayBuffer,
  picture: PictureFile,
  size: [number, number] | null,
): [number, number] {
  const header = readHeader(bytes);
  if (!header) throw damaged(picture.where, "no picture");
  const { width, height, bits } = header;
  if (size && (width !== size[0] || height !== size[1])) {
    throw damaged(picture.where, `a picture of ${width} x ${height}, not of ${size[0]} x ${size[1]}`);
  }
  if (picture.codec.bits !== 8 && picture.codec.bits !== bits) {
    throw damaged(picture.where, `no picture of ${picture.codec.bits} bits`);
  }
  const texels = width * height;
  if (!texels || width > limits.MAX_SIDE || height > limits.MAX_STACKED || texels > limits.MAX_TEXELS) {
    throw damaged(picture.where, `a picture of ${width} x ${height}`);
  }
  return [width, height];
}

/** Any picture, with the upper eight bits of codes that have more. Raises SceneError: `damaged`, `codec`. */
export const decodeBitmaps: PictureDecoder<ImageBitmap> = async (bytes, picture, size) => {
  const count = picture.pieces * picture.textures;
  const [width, rows] = checkPicture(bytes, picture, size && [size[0], count * size[1]]);
  const type = readHeader(bytes)?.type ?? picture.codec.mimeType;
  let bitmap: ImageBitmap;
  try {
    bitmap = await createImageBitmap(new Blob([bytes], { type }), OPTIONS);
  } catch (reason) {
    throw (await canDecode(type)) ? damaged(picture.where, "it cannot be decoded") : noCodec(type, picture, reason);
  }
  if (bitmap.width !== width || bitmap.height !== rows) {
    bitmap.close();
    throw damaged(picture.where, `decoded to ${bitmap.width} x ${bitmap.height}, not to ${width} x ${rows}`);
  }
  const height = rows / count;
  return Array.from({ length: count }, (_, i) => ({ picture: bitmap, row: i * height, rows: height }));
};

/** Whether this browser decodes pictures of a type: a picture that it does not decode may also be damaged. */
export async function canDecode(type: string): Promise<boolean> {
  const probe = PROBES[type];
  if (!probe) return true;
  const bytes = Uint8Array.from(atob(probe), (letter) => letter.charCodeAt(0));
  try {
    (await createImageBitmap(new Blob([bytes], { type }))).close();
    return true;
  } catch {
    return false;
  }
}

function noCodec(type: string, picture: PictureFile, cause: unknown): SceneError {
  const name = type.replace("image/", "").toUpperCase();
  const message = `This browser cannot decode ${name} pictures; use a newer one, or encode the scene with --codec png.`;
  return new SceneError("codec", message, picture.where, { cause });
}
