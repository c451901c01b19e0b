// A bare AV1 picture in the boxes of an AVIF, which browsers decode.

import { damaged } from "./errors.js";

const SEQUENCE_HEADER = 1; // type of a unit
const LAST_LEVEL_WITHOUT_TIER = 7;

export interface SequenceHeader {
  level: number;
  tier: number;
  width: number;
  height: number;
}

/** The AVIF of a picture of the codec `av1-10bit-2`: Main profile, 10 bits, 4:2:0. Raises SceneError `damaged`. */
export function asAvif(bytes: ArrayBuffer, where: string): ArrayBuffer {
  const { level, tier, width, height } = readSequenceHeader(new Uint8Array(bytes), where);
  const flags = (tier << 7) | 0b1001100; // 10 bits; chroma half as wide and high
  const properties = box("ipco", [
    ...box("ispe", [...uint32(0), ...uint32(width), ...uint32(height)]),
    ...box("pixi", [...uint32(0), 3, 10, 10, 10]),
    ...box("av1C", [0x81, level, flags, 0]),
    ...box("colr", [...text("nclx"), 0, 2, 0, 2, 0, 2, 0x80]), // colours unspecified, full range
  ]);
  const type = box("ftyp", [...text("avif"), ...uint32(0), ...text("avifmif1miafMA1B")]);
  const meta = (start: number): number[] =>
    box("meta", [
      ...uint32(0),
      ...box("hdlr", [...uint32(0), ...uint32(0), ...text("pict"), ...Array<number>(13).fill(0)]),
      ...box("pitm", [...uint32(0), 0, 1]),
      ...box("iloc", [...uint32(0), 0x44, 0, 0, 1, 0, 1, 0, 0, 0, 1, ...uint32(start), ...uint32(bytes.byteLength)]),
      ...box("iinf", [...uint32(0), 0, 1, ...box("infe", [2, 0, 0, 0, 0, 1, 0, 0, ...text("av01"), 0])]),
      ...box("iprp", [...properties, ...box("ipma", [...uint32(0), ...uint32(1), 0, 1, 4, 1, 2, 0x83, 4])]),
    ]);
  const start = type.length + meta(0).length + 8;
  const head = [...type, ...meta(start), ...uint32(8 + bytes.byteLength), ...text("mdat")];
  const made = new Uint8Array(start + bytes.byteLength);
  made.set(head);
  made.set(new Uint8Array(bytes), start);
  return made.buffer;
}

/** The sequence header at the beginning: AV1, section 5.5.1. */
export function readSequenceHeader(bytes: Uint8Array, where: string): SequenceHeader {
  const header = bytes[0] ?? 0;
  const start = 8 * (1 + ((header >> 2) & 1) + ((header >> 1) & 1)); // its length has one byte, if any
  let at = start;
  const take = (count: number): number => {
    let value = 0;
    for (const end = at + count; at < end; at++) value = 2 * value + (((bytes[at >> 3] ?? 0) >> (7 - (at & 7))) & 1);
    return value;
  };
  take(4); // profile, still picture
  const reduced = take(1) === 1;
  const several = !reduced && take(7) !== 0; // timing, display delay, operating points
  if (!reduced) take(12); // operating point
  const level = take(5);
  const tier = !reduced && level > LAST_LEVEL_WITHOUT_TIER ? take(1) : 0;
  const [wide, high] = [take(4) + 1, take(4) + 1];
  const [width, height] = [take(wide) + 1, take(high) + 1];
  if (header >> 3 !== SEQUENCE_HEADER || several || at > 8 * bytes.length) throw damaged(where, "no AV1 sequence header");
  return { level, tier, width, height };
}

function box(type: string, content: number[]): number[] {
  return [...uint32(8 + content.length), ...text(type), ...content];
}

function uint32(value: number): number[] {
  return [24, 16, 8, 0].map((shift) => (value >>> shift) & 255);
}

function text(letters: string): number[] {
  return Array.from(letters, (letter) => letter.charCodeAt(0));
}
