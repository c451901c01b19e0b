// Pictures of codes, decoded by the browser with colour management off.

import type { Picture } from "./document.js";
import { SceneError, damaged } from "./errors.js";
import { readHeader } from "./headers.js";
import * as limits from "./limits.js";

const OPTIONS: ImageBitmapOptions = { colorSpaceConversion: "none", premultiplyAlpha: "none" };

// Eight grey texels square and one: what tells a browser without the codec from a damaged picture.
const PROBES: Record<string, string> = {
  "image/avif":
    "AAAAHGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZgAAAOltZXRhAAAAAAAAACFoZGxyAAAAAAAAAABwaWN0AAAAAAAAAAAAAAAAAAAAAA5waXRtAAAA" +
    "AAABAAAAHmlsb2MAAAAARAAAAQABAAAAAQAAAQ0AAAAZAAAAKGlpbmYAAAAAAAEAAAAaaW5mZQIAAAAAAQAAYXYwMUNvbG9yAAAAAGhpcHJwAAAA" +
    "SWlwY28AAAAUaXNwZQAAAAAAAAAIAAAACAAAAA5waXhpAAAAAAEIAAAADGF2MUOBABwAAAAAE2NvbHJuY2x4AAEADQAGgAAAABdpcG1hAAAAAAAA" +
    "AAEAAQQBAoMEAAAAIW1kYXQSAAoIGAi/aYCGg1AyCxlGIYeeaACQQNmg",
  "image/webp": "UklGRh4AAABXRUJQVlA4TBEAAAAvAAAAAAdQwAIWsP+BiOh/AAA=",
};

/** The size that a picture's header states, checked against limits and, where there is one, the announced size. */
export function checkPicture(bytes: ArrayBuffer, picture: Picture, size: [number, number] | null): [number, number] {
  const header = readHeader(bytes);
  if (!header) throw damaged(picture.where, "no picture");
  const { width, height } = header;
  if (size && (width !== size[0] || height !== size[1])) {
    throw damaged(picture.where, `a picture of ${width} x ${height}, not of ${size[0]} x ${size[1]}`);
  }
  const texels = width * height;
  if (!texels || Math.max(width, height) > limits.MAX_SIDE || texels > limits.MAX_TEXELS) {
    throw damaged(picture.where, `a picture of ${width} x ${height}`);
  }
  return [width, height];
}

/** Decodes a picture, `down` times smaller along each side. Raises SceneError: `damaged`, `codec`. */
export async function decodePicture(
  bytes: ArrayBuffer,
  picture: Picture,
  size: [number, number] | null,
  down = 1,
): Promise<ImageBitmap> {
  const [width, height] = checkPicture(bytes, picture, size);
  const [w, h] = [Math.ceil(width / down), Math.ceil(height / down)];
  const resize: ImageBitmapOptions = down === 1 ? {} : { resizeWidth: w, resizeHeight: h, resizeQuality: "high" };
  const type = readHeader(bytes)?.type ?? picture.mimeType;
  let bitmap: ImageBitmap;
  try {
    bitmap = await createImageBitmap(new Blob([bytes], { type }), { ...OPTIONS, ...resize });
  } catch (reason) {
    throw (await canDecode(type)) ? damaged(picture.where, "it cannot be decoded") : noCodec(type, picture, reason);
  }
  if (bitmap.width === w && bitmap.height === h) return bitmap;
  bitmap.close();
  throw damaged(picture.where, `decoded to ${bitmap.width} x ${bitmap.height}, not to ${w} x ${h}`);
}

async function canDecode(type: string): Promise<boolean> {
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

function noCodec(type: string, picture: Picture, cause: unknown): SceneError {
  const name = type.replace("image/", "").toUpperCase();
  const message = `This browser cannot decode ${name} pictures; use a newer one, or encode the scene with --codec png.`;
  return new SceneError("codec", message, picture.where, { cause });
}
