// The adaptive binary code of meshes, weights and cameras, and whole numbers on top of it: `docs/coding.md`. All of it is
// in whole numbers below 2^53, so that every decoder finds the same.

import { cutOff, damaged } from "./errors.js";

const ONE = 65536;
const LIMIT = 126; // bits that a slot remembers
const NODES = 64; // slots of an integer in one context
const ZERO = 0;
const SIGN = 1;
const LENGTH = 2;
const UPPER = 24;
const LOWER = 44;
const LONGEST = 21; // binary digits of an integer's magnitude - 1
const START = 26214; // weight of a prediction at first: 0.4
const AHEAD = 4; // bytes that are read in advance

const SQUASH = Float64Array.from({ length: 4095 }, (_, i) => Math.round(ONE / (1 + Math.exp((2047 - i) / 256))));
const STRETCH = Float64Array.from({ length: 4096 }, (_, i) => Math.round(256 * Math.log((i + 0.5) / (4095.5 - i))));
const RATES = Float64Array.from({ length: LIMIT + 1 }, (_, n) => Math.round(ONE / (n + 1.5)));

/** How many binary digits a whole number has; none for 0. */
export function binaryDigits(value: number): number {
  return value < 4294967296 ? 32 - Math.clz32(value) : 32 + binaryDigits(Math.floor(value / 4294967296));
}

export class RangeDecoder {
  private low = 0;
  private high = 4294967295;
  private code = 0;
  private at = 0;
  private readonly probability: Uint16Array; // of a one, per slot
  private readonly seen: Uint8Array;
  private readonly weights: Float64Array;

  constructor(
    private readonly bytes: Uint8Array,
    contexts: number,
    mixtures: number,
  ) {
    this.probability = new Uint16Array(contexts * NODES).fill(ONE / 2);
    this.seen = new Uint8Array(contexts * NODES);
    this.weights = new Float64Array(mixtures * NODES * 3).fill(START);
    for (let k = 0; k < AHEAD; k++) this.code = this.code * 256 + this.next();
  }

  /** Throws if more was read than there is. */
  checkEnd(where: string): void {
    if (this.at > this.bytes.length + AHEAD) throw cutOff(where);
  }

  /** A bit in contexts a, b and c. */
  flag(a: number, b: number, c: number, mixture: number): boolean {
    return this.node(a, b, c, mixture, 0) === 1;
  }

  /** A whole number of `digits` binary digits, each as likely 0 as 1. */
  raw(digits: number): number {
    let result = 0;
    for (let k = 0; k < digits; k++) result = result * 2 + this.split(ONE / 2);
    return result;
  }

  /** A whole number within ±2^21 in contexts a, b and c. */
  integer(a: number, b: number, c: number, mixture: number): number {
    const size = this.magnitude(a, b, c, mixture);
    if (size === 0) return 0;
    return this.node(a, b, c, mixture, SIGN) ? -size : size;
  }

  private magnitude(a: number, b: number, c: number, mixture: number): number {
    if (!this.node(a, b, c, mixture, ZERO)) return 0;
    let length = 0;
    while (length < LONGEST && this.node(a, b, c, mixture, LENGTH + length)) length += 1;
    if (length < 2) return length + 1;
    let result = 1;
    for (let place = length - 2; place >= 0; place--) {
      let bit: number;
      if (place === length - 2) bit = this.node(a, b, c, mixture, UPPER + length);
      else if (place === length - 3) bit = this.node(a, b, c, mixture, LOWER + 2 * Math.min(length, 9) + (result & 1));
      else bit = this.split(ONE / 2);
      result = result * 2 + bit;
    }
    return result + 1;
  }

  private node(a: number, b: number, c: number, mixture: number, node: number): number {
    return this.bit(a * NODES + node, b * NODES + node, c * NODES + node, (mixture * NODES + node) * 3);
  }

  /** A bit predicted by slots a, b and c, mixed by three weights from row on. */
  private bit(a: number, b: number, c: number, row: number): number {
    const { probability, weights } = this;
    const s0 = STRETCH[probability[a]! >> 4]!;
    const s1 = STRETCH[probability[b]! >> 4]!;
    const s2 = STRETCH[probability[c]! >> 4]!;
    const sum = Math.floor((weights[row]! * s0 + weights[row + 1]! * s1 + weights[row + 2]! * s2) / ONE);
    const one = SQUASH[Math.min(Math.max(sum, -2047), 2047) + 2047]!;
    const bit = this.split(one);
    const error = bit ? ONE - one : -one;
    weights[row]! += (s0 * error) >> 14;
    weights[row + 1]! += (s1 * error) >> 14;
    weights[row + 2]! += (s2 * error) >> 14;
    this.learn(a, bit);
    this.learn(b, bit);
    this.learn(c, bit);
    return bit;
  }

  private learn(slot: number, bit: number): void {
    const [was, seen] = [this.probability[slot]!, this.seen[slot]!];
    this.probability[slot] = was + Math.floor((((bit ? ONE - 1 : 0) - was) * RATES[seen]!) / ONE);
    if (seen < LIMIT) this.seen[slot] = seen + 1;
  }

  /** A bit whose probability of being 1 is one / 65536. */
  private split(one: number): number {
    const middle = this.low + Math.floor(((this.high - this.low) * one) / ONE);
    const bit = this.code <= middle ? 1 : 0;
    if (bit) this.high = middle;
    else this.low = middle + 1;
    while ((this.low ^ this.high) >>> 24 === 0) {
      this.low = (this.low << 8) >>> 0;
      this.high = ((this.high << 8) | 255) >>> 0;
      this.code = ((this.code << 8) | this.next()) >>> 0;
    }
    return bit;
  }

  private next(): number {
    return this.bytes[this.at++] ?? 0;
  }
}

/** The header's view of a coded part of at least `size` bytes, its version checked. */
export function codedHeader(bytes: Uint8Array, size: number, where: string, version = 1): DataView {
  if (bytes.length < size) throw cutOff(where);
  if (bytes[0] !== version) throw damaged(where, `coded numbers of version ${bytes[0]}`);
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
}

/** Throws where so many numbers cannot be in the bytes: nothing may be allocated for them. */
export function checkNumbers(bytes: Uint8Array, numbers: number, most: number, where: string): void {
  if (numbers > most || numbers > 16 * bytes.length + 1024) throw damaged(where, `${numbers} numbers announced`);
}
