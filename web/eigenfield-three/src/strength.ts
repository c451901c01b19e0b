// How strong an eigen texture is, to show one by itself.

import { closePieces } from "./pieces.js";
import { codeStep, type Basis } from "./planes.js";

const SIDE = 128; // of the thumbnail that is looked at
const SHARE = 0.98; // of the values that shall fit around mid grey

/** The factor that spreads nearly all values of eigen texture `rank` of a basis over -0.5..0.5. `colours`: of the value
 * 1 of its channels; `read`: the bytes of a view. */
export async function eigenGain(
  basis: Basis,
  rank: number,
  colours: [number, number, number][],
  read: (view: number) => Promise<ArrayBuffer>,
): Promise<number> {
  const channels = colours.length;
  let first = 0;
  const picture = basis.pictures.find(({ textures }) => (first += textures) > rank);
  if (!picture) return 1;
  const within = rank - (first - picture.textures);
  const step = codeStep(picture);
  const together = picture.pieces < channels; // R, G and B
  const pieces = await picture.codec.bitmaps(await read(picture.view), picture, basis.size);
  const canvas = new OffscreenCanvas(SIDE, SIDE);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  if (!context) return 1;
  context.imageSmoothingEnabled = false; // single texels: averages would be weaker
  const values: number[] = [];
  pieces.slice(picture.pieces * within, picture.pieces * (within + 1)).forEach(({ picture: bitmap, row, rows }, i) => {
    context.drawImage(bitmap, 0, row, bitmap.width, rows, 0, 0, SIDE, SIDE);
    const { data } = context.getImageData(0, 0, SIDE, SIDE);
    (together ? [0, 1, 2] : [i]).forEach((channel) => {
      const [scale, zero] = [picture.scale, picture.zero].map((own) => own[channels * within + channel] ?? 0);
      const colour = Math.max(...(colours[channel] ?? [0]).map(Math.abs)) * (scale ?? 0);
      for (let at = together ? channel : 0; at < data.length; at += 4) {
        values.push(Math.abs((step * (data[at] ?? 0) - (zero ?? 0)) * colour));
      }
    });
  });
  closePieces(pieces);
  return strengthOf(values);
}

/** The factor for the values of an eigen texture, without their signs. */
export function strengthOf(values: number[]): number {
  values.sort((a, b) => a - b);
  const strong = values[Math.floor(SHARE * values.length)] ?? 0;
  return strong > 0 ? 0.45 / strong : 1;
}
