// The codes of a decoded frame of a film: all ten bits where the browser gives them, else the upper eight.

import { SceneError } from "./errors.js";
import type { Codes } from "./pieces.js";

const TEN_BITS = new Set(["I420P10", "I422P10", "I444P10"]);
const LUMA_FIRST = new Set(["I420", "I420A", "I422", "I444", "NV12"]);
const COLOURED = new Set(["RGBA", "RGBX", "BGRA", "BGRX"]); // grey: all three are the luma
const GREEN = 1; // of a texel's bytes

/** Where the textures of a picture lie in a film: column and row of each channel of each, which have one size. */
export interface FilmPart {
  film: number;
  size: [number, number];
  at: [number, number][];
  where: string;
}

/** Codes of ten bits that stand for those of eight: 85 is 341 exactly. */
const GROWN = Uint16Array.from({ length: 256 }, (_, code) => Math.round((code * 1023) / 255));
/** The same, of a grey that was made as if luma were 16 to 235; films hold no other. */
const STRETCHED = Uint16Array.from({ length: 256 }, (_, grey) => GROWN[16 + Math.round((grey * 219) / 255)]!);
/** The same of an opacity: what was cut off at either end is taken for that end. */
const CUT = STRETCHED.map((code, grey) => (grey === 0 ? 0 : grey === 255 ? 1023 : code));

/** The codes of a frame. `room`: of a frame that is needed no more; `opacity`: it is of the film of an opacity. Frames that
 * a browser does not hand out, as those of some hardware, are read where they are drawn. Raises SceneError `unsupported`. */
export async function codesOf(
  frame: VideoFrame,
  room?: Uint8Array<ArrayBuffer> | null,
  opacity = false,
): Promise<Codes> {
  const format = frame.format ?? "";
  const { width, height } = frame.visibleRect ?? { width: 0, height: 0 };
  if (!TEN_BITS.has(format) && !LUMA_FIRST.has(format) && !COLOURED.has(format)) {
    const drawn = drawnOf(frame, [width, height]);
    if (drawn) return grownCodes(drawn, 4 * width, 4, [width, height], tableOf(frame, opacity));
    throw new SceneError("unsupported", `This browser does not hand out its frames (${format || "no format"}).`, "");
  }
  const size = frame.allocationSize();
  const data = room && room.length >= size ? room : new Uint8Array(size);
  const [first] = await frame.copyTo(data);
  const { offset, stride } = first ?? { offset: 0, stride: 0 };
  if (TEN_BITS.has(format)) return { data: data.subarray(offset), width, height, stride, room: data };
  const coloured = COLOURED.has(format);
  const [step, from] = coloured ? [4, offset + GREEN] : [1, offset];
  const table = coloured ? tableOf(frame, opacity) : GROWN;
  return grownCodes(data.subarray(from), stride, step, [width, height], table);
}

/** What the greys of a frame stand for. Films are full, whatever it says. */
function tableOf(frame: VideoFrame, opacity: boolean): typeof GROWN {
  if (frame.colorSpace?.fullRange !== false) return GROWN;
  return opacity ? CUT : STRETCHED;
}

/** The colours of a picture, four bytes a texel; null where there is no canvas. */
export function drawnOf(picture: CanvasImageSource, size: [number, number]): Uint8ClampedArray | null {
  if (typeof OffscreenCanvas === "undefined" || !size[0]) return null;
  const context = new OffscreenCanvas(...size).getContext("2d", { willReadFrequently: true });
  context?.drawImage(picture, 0, 0);
  return context?.getImageData(0, 0, ...size).data ?? null;
}

/** Every `step`-th byte of rows of `stride` bytes as a code of ten bits, which are `grown`. */
export function grownCodes(
  data: Uint8Array | Uint8ClampedArray,
  stride: number,
  step: number,
  [width, height]: [number, number],
  table = GROWN,
): Codes {
  const codes = new Uint16Array(width * height);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      codes[row * width + column] = table[data[row * stride + step * column]!]!;
    }
  }
  return { data: new Uint8Array(codes.buffer), width, height, stride: 2 * width, grown: true };
}

/** The codes of each texture of a part, which stay where they are. */
export function partsOf({ data, stride }: Codes, { size: [width, height], at }: FilmPart): Codes[] {
  return at.map(([left, top]) => ({ data: data.subarray(top * stride + 2 * left), width, height, stride }));
}
