// What the JSON says of bytes: buffer views, accessors and streams, checked before a byte of them is read.

import { USUAL, codecOf, type Codec, type Kind } from "./codecs.js";
import { cutOff, damaged } from "./errors.js";
import { Value } from "./json.js";
import * as limits from "./limits.js";

export const UINT8 = 5121; // component types of accessors
export const UINT16 = 5123;
export const UINT32 = 5125;
export const FLOAT = 5126;

type ComponentType = typeof UINT8 | typeof UINT16 | typeof UINT32 | typeof FLOAT;
const BYTES: Record<ComponentType, number> = { [UINT8]: 1, [UINT16]: 2, [UINT32]: 4, [FLOAT]: 4 };
const BARE: ReadonlySet<Kind> = new Set<Kind>(["cameras", "triangles", "weights"]);
const ITEMS: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3 };

export interface View {
  offset: number;
  length: number;
  stride: number; // 0: packed
}

/** A run of `count` x `items` numbers within buffer view `view`. */
export interface Accessor {
  view: number;
  offset: number;
  count: number;
  items: number;
  type: ComponentType;
  where: string;
}

/** Bytes that a decoder of ours reads: docs/coding.md. */
export interface Stream<K extends Kind> {
  view: number;
  codec: Codec<K>;
  where: string;
}

/** The buffer view that a value names. */
export type ViewReader = (value: Value) => number;
export type AccessorReader = (index: Value, kind: string, types: number[], count: number | null) => Accessor;

/** Bytes of a buffer view. */
export type ViewBytes = (view: number) => Promise<ArrayBuffer>;

export type Numbers = Float32Array | Uint32Array | Uint16Array;

export function readViews(root: Value): View[] {
  const buffer = root.key("buffers").at(0);
  if (buffer.key("uri").exists) throw buffer.wrong("not the binary chunk");
  const total = buffer.key("byteLength").integer(0, 2 ** 32 - 1);
  return root.key("bufferViews").items(limits.MAX_VIEWS).map((view) => {
    const offset = view.key("byteOffset");
    const stride = view.key("byteStride");
    view.key("buffer").integer(0, 0);
    const made = {
      offset: offset.exists ? offset.integer(0, total) : 0,
      length: view.key("byteLength").integer(1, total),
      stride: stride.exists ? stride.integer(4, 252) : 0,
    };
    if (made.offset + made.length > total) throw view.wrong("outside the buffer");
    return made;
  });
}

export function viewReader(views: View[]): ViewReader {
  return (value) => value.integer(0, views.length - 1);
}

/** Reads accessors by their index; those with a `count` must have it, and lie packed. */
export function accessorReader(root: Value, views: View[]): AccessorReader {
  const given = root.key("accessors");
  const accessors = given.exists ? given.items(limits.MAX_VIEWS) : [];
  return (index, kind, types, count) => {
    const at = accessors[index.integer(0, accessors.length - 1)];
    if (!at) throw index.wrong("no such accessor");
    const type = at.key("componentType").integer(5120, 5126) as ComponentType;
    if (!types.includes(type)) throw at.wrong(`component type ${type}`);
    if (at.key("type").text(limits.MAX_NAME) !== kind) throw at.wrong(`not ${kind}`);
    if (at.key("sparse").exists) throw at.wrong("sparse");
    const normalised = at.key("normalized");
    if (normalised.exists && normalised.raw !== false) throw at.wrong("normalised");
    const items = ITEMS[kind] ?? 1;
    const has = at.key("count").integer(1, limits.MAX_WEIGHTS);
    if (count !== null && has !== count) throw at.wrong(`${count} numbers are needed, not ${has}`);
    const view = at.key("bufferView").integer(0, views.length - 1);
    const within = views[view];
    if (!within) throw at.wrong("no such buffer view");
    const start = at.key("byteOffset");
    const offset = start.exists ? start.integer(0, within.length) : 0;
    const size = BYTES[type] * items;
    if (within.stride && (within.stride < size || kind === "SCALAR")) throw at.wrong("a stride that cannot be");
    if (offset + (has - 1) * (within.stride || size) + size > within.length) throw at.wrong("outside its buffer view");
    if ((offset + within.offset) % BYTES[type]) throw at.wrong("not aligned");
    return { view, offset, count: has, items, type, where: at.where };
  };
}

/** A stream is an object with a buffer view and, if need be, its codec; of some kinds the buffer view's index may stand
 * alone. */
export function streamOf<K extends keyof typeof USUAL>(
  kind: K,
  entry: Value<number | { bufferView: number; codec?: string }>,
  viewOf: ViewReader,
): Stream<K> {
  const alone = typeof entry.raw === "number" && BARE.has(kind);
  const codec = codecOf(kind, alone ? new Value(undefined, entry.where) : entry.key("codec"), USUAL[kind]);
  return { view: viewOf(alone ? entry : entry.key("bufferView")), codec, where: entry.where };
}

/** The numbers of an accessor, read whole. */
export async function readNumbers(accessor: Accessor, views: View[], bytes: ViewBytes): Promise<Numbers> {
  const view = await bytes(accessor.view);
  const needed = views[accessor.view]?.length ?? Infinity;
  if (view.byteLength < needed) throw cutOff(accessor.where);
  const { offset, count, items, type } = accessor;
  const copy = view.slice(offset, offset + BYTES[type] * count * items);
  if (type === UINT32) return new Uint32Array(copy);
  if (type === UINT16) return new Uint16Array(copy);
  return checkFinite(new Float32Array(copy), accessor.where);
}

export function checkFinite<T extends Numbers>(numbers: T, where: string): T {
  for (const number of numbers) {
    if (!(Math.abs(number) <= limits.MAX_NUMBER)) throw damaged(where, `${number} among its numbers`);
  }
  return numbers;
}
