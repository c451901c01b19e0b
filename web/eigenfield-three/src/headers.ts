// Type and size of a picture from its first bytes: checked before a decoder allocates what a header asks for.

export interface PictureHeader {
  type: string;
  width: number;
  height: number;
  bits: number | null; // of a sample of an AVIF
}

/** The header of a PNG, JPEG, WebP or AVIF picture, or null. */
export function readHeader(bytes: ArrayBuffer): PictureHeader | null {
  const data = new DataView(bytes);
  try {
    return png(data) ?? jpeg(data) ?? webp(data) ?? avif(data);
  } catch (reason) {
    if (reason instanceof RangeError) return null; // cut off within the header
    throw reason;
  }
}

function fourCC(data: DataView, at: number): string {
  return String.fromCharCode(...[0, 1, 2, 3].map((i) => data.getUint8(at + i)));
}

function png(data: DataView): PictureHeader | null {
  if (data.getUint32(0) !== 0x89504e47 || data.getUint32(4) !== 0x0d0a1a0a || fourCC(data, 12) !== "IHDR") return null;
  return { type: "image/png", width: data.getUint32(16), height: data.getUint32(20), bits: null };
}

function jpeg(data: DataView): PictureHeader | null {
  if (data.getUint16(0) !== 0xffd8) return null;
  for (let at = 2; ; ) {
    const marker = data.getUint16(at);
    if (marker === 0xffff) {
      at += 1; // fill byte
      continue;
    }
    const frame = marker >= 0xffc0 && marker <= 0xffcf && ![0xffc4, 0xffc8, 0xffcc].includes(marker);
    const side = (from: number): number => data.getUint16(at + from);
    if (frame) return { type: "image/jpeg", width: side(7), height: side(5), bits: null };
    if (marker < 0xff01 || marker === 0xffda || marker === 0xffd9) return null;
    at += 2 + data.getUint16(at + 2);
  }
}

function webp(data: DataView): PictureHeader | null {
  if (fourCC(data, 0) !== "RIFF" || fourCC(data, 8) !== "WEBP") return null;
  const shared = { type: "image/webp", bits: null };
  const kind = fourCC(data, 12);
  const uint24 = (at: number): number => data.getUint16(at, true) + 65536 * data.getUint8(at + 2);
  if (kind === "VP8X") return { ...shared, width: 1 + uint24(24), height: 1 + uint24(27) };
  if (kind === "VP8L") {
    const bits = data.getUint32(21, true);
    return { ...shared, width: 1 + (bits & 0x3fff), height: 1 + ((bits >>> 14) & 0x3fff) };
  }
  if (kind !== "VP8 ") return null;
  return { ...shared, width: data.getUint16(26, true) & 0x3fff, height: data.getUint16(28, true) & 0x3fff };
}

/** The largest `ispe` of the file: the picture's own, or that of the grid it is put together from; the first `av1C`. */
function avif(data: DataView): PictureHeader | null {
  if (fourCC(data, 4) !== "ftyp") return null;
  let found: { width: number; height: number } | null = null;
  let bits: number | null = null;
  const walk = (from: number, to: number): void => {
    for (let at = from; at + 8 <= to; ) {
      const size = data.getUint32(at);
      const kind = fourCC(data, at + 4);
      const end = size === 0 ? to : at + size;
      if (size === 1 || end < at + 8 || end > to) return;
      if (kind === "meta") walk(at + 12, end);
      if (kind === "iprp" || kind === "ipco") walk(at + 8, end);
      if (kind === "ispe") {
        const [width, height] = [data.getUint32(at + 12), data.getUint32(at + 16)];
        if (!found || width * height > found.width * found.height) found = { width, height };
      }
      if (kind === "av1C") {
        const flags = data.getUint8(at + 10);
        bits ??= flags & 0x40 ? (flags & 0x20 ? 12 : 10) : 8;
      }
      at = end;
    }
  };
  walk(0, data.byteLength);
  return found && { type: "image/avif", ...(found as { width: number; height: number }), bits };
}
