// How strong an eigen texture is, to show one by itself.

import { decodePicture } from "./decode.js";
import type { Picture } from "./document.js";

const SIDE = 128; // of the thumbnail that is looked at
const SHARE = 0.98; // of the values that shall fit around mid grey

/** The factor that spreads nearly all values of an eigen texture over -0.5..0.5. */
export async function eigenGain(bytes: ArrayBuffer, picture: Picture): Promise<number> {
  const bitmap = await decodePicture(bytes, picture, null);
  const canvas = new OffscreenCanvas(SIDE, SIDE);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  if (!context) return 1;
  context.imageSmoothingEnabled = false; // single texels: averages would be weaker
  context.drawImage(bitmap, 0, 0, SIDE, SIDE);
  bitmap.close();
  const { data } = context.getImageData(0, 0, SIDE, SIDE);
  const values: number[] = [];
  for (let i = 0; i < data.length; i++) {
    const channel = i & 3;
    const value = ((data[i] ?? 0) - (picture.zero[channel] ?? 0)) * (picture.scale[channel] ?? 0);
    if (channel < 3) values.push(Math.abs(value));
  }
  values.sort((a, b) => a - b);
  const strong = values[Math.floor(SHARE * values.length)] ?? 0;
  return strong > 0 ? 0.45 / strong : 1;
}
