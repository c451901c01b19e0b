// The codes of a decoded frame of a film: all ten bits where the browser gives them, else the upper eight.

import { SceneError } from "./errors.js";
import type { Codes } from "./pieces.js";
import type { FilmPart } from "./planes.js";

const TEN_BITS = new Set(["I420P10", "I422P10", "I444P10"]);
const LUMA_FIRST = new Set(["I420", "I420A", "I422", "I444", "NV12"]);
const COLOURED = new Set(["RGBA", "RGBX", "BGRA", "BGRX"]); // grey: all three are the luma
const GREEN = 1; // of a texel's bytes

/** Codes of ten bits that stand for those of eight: 85 is 341 exactly. */
const GROWN = Uint16Array.from({ length: 256 }, (_, code) => Math.round((code * 1023) / 255));
/** The same, of a grey that was made as if luma were 16 to 235; films hold no other. */
const STRETCHED = Uint16Array.from({ length: 256 }, (_, grey) => GROWN[16 + Math.round((grey * 219) / 255)]!);
/** The same of an opacity: what was cut off at either end is taken for that end. */
const CUT = STRETCHED.map((code, grey) => (grey === 0 ? 0 : grey === 255 ? 1023 : code));

/** The codes of a frame. `room`: of a frame that is needed no more; `opacity`: it is of the film of an opacity. Raises
 * SceneError `unsupported`. */
export async function codesOf(
  frame: VideoFrame,
  room: Uint8Array<ArrayBuffer> | null,
  opacity = false,
): Promise<Codes> {
  const format = frame.format ?? "";
  const { width, height } = frame.visibleRect ?? { width: 0, height: 0 };
  if (!TEN_BITS.has(format) && !LUMA_FIRST.has(format) && !COLOURED.has(format)) {
    throw new SceneError("unsupported", `This browser does not hand out its frames (${format || "no format"}).`, "");
  }
  const size = frame.allocationSize();
  const data = room && room.length >= size ? room : new Uint8Array(size);
  const [first] = await frame.copyTo(data);
  const { offset, stride } = first ?? { offset: 0, stride: 0 };
  if (TEN_BITS.has(format)) return { data: data.subarray(offset), width, height, stride, room: data };
  const coloured = COLOURED.has(format);
  const [step, from] = coloured ? [4, offset + GREEN] : [1, offset];
  const limited = coloured && frame.colorSpace?.fullRange === false; // films are full, whatever it says
  const table = limited ? (opacity ? CUT : STRETCHED) : GROWN;
  return grownCodes(data.subarray(from), stride, step, [width, height], table);
}

/** Every `step`-th byte of rows of `stride` bytes as a code of ten bits. */
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
  return { data: new Uint8Array(codes.buffer), width, height, stride: 2 * width };
}

/** The codes of each texture of a part, which stay where they are. */
export function partsOf({ data, stride }: Codes, { size: [width, height], at }: FilmPart): Codes[] {
  return at.map(([left, top]) => ({ data: data.subarray(top * stride + 2 * left), width, height, stride }));
}
