// The groups of a clip: each is fetched, checked and opened when one of its frames is wanted.

import { CODECS } from "./codecs.js";
import { parseJson } from "./container.js";
import type { SceneDocument } from "./document.js";
import { damaged } from "./errors.js";
import { basesOf, checkWeights, sideBySide } from "./info.js";
import { inflated } from "./inflate.js";
import { Value, type Json } from "./json.js";
import * as limits from "./limits.js";
import type { DecodedMesh } from "./mesh-decoder.js";
import type { Motion } from "./mesh-motion.js";
import { numbersOf, type Picture } from "./planes.js";
import type { AffineJson, GroupHeadJson } from "./schema.js";
import type { GroupPlace, PlaceReader, Timeline } from "./timeline.js";

const KEPT = 3; // groups that are open at a time
const HEAD = 4; // bytes of the length of a group's head

/** What the codes of a picture stand for. */
export type Affine = Pick<Picture, "scale" | "zero">;

/** What all frames of a group share, and the units of its films. */
export interface Group {
  index: number;
  first: number; // frame
  frames: number;
  omega: Float32Array; // (encoded cameras) x (eigen textures of all bases)
  means: Affine[]; // of each plane
  bases: Affine[]; // of all planes
  units: Uint8Array[][]; // of each frame, one for each film
  mesh: DecodedMesh; // as its stream decodes
  motion: Motion | null; // null: the mesh stands still
}

export class Groups {
  private readonly kept = new Map<number, Promise<Group>>(); // that was wanted last is the last

  /** `mesh`: of groups that have none of their own. */
  constructor(
    private readonly scene: SceneDocument,
    private readonly timeline: Timeline,
    private readonly mesh: DecodedMesh,
    private readonly read: PlaceReader,
  ) {}

  /** Raises SceneError: `damaged`, `truncated`, `codec-unknown`. */
  open(index: number): Promise<Group> {
    const group = this.kept.get(index) ?? this.opened(index);
    group.catch(() => this.kept.get(index) === group && this.kept.delete(index)); // the next one asks again
    this.kept.delete(index);
    this.kept.set(index, group);
    for (const [oldest] of this.kept) if (this.kept.size > KEPT) this.kept.delete(oldest);
    return group;
  }

  /** The first group as far as its first frame, which can be shown before the others are there. Nothing compares its
   * digest. Raises SceneError, as `open`. */
  async begin(): Promise<Group> {
    const place = this.placeOf(0);
    const read = async (length: number): Promise<Uint8Array<ArrayBuffer>> =>
      new Uint8Array(await this.read(place, Math.min(length, place.length)));
    const start = await read(HEAD);
    const { head, at } = await readHead(await read(HEAD + sizeOfHead(start, place)), place);
    const before = [head.key("weights"), head.key("mesh"), head.key("motion"), head.key("frames").at(0)];
    const end = before.reduce((sum, { raw }) => sum + totalOf(raw), at);
    return this.build(0, await read(end), head, at, 1);
  }

  private placeOf(index: number): GroupPlace {
    const place = this.timeline.groups[index];
    if (!place) throw new RangeError(`no group ${index}`);
    return place;
  }

  private async opened(index: number): Promise<Group> {
    const place = this.placeOf(index);
    const bytes = new Uint8Array(await this.read(place, place.length));
    await checkDigest(bytes, place);
    const { head, at } = await readHead(bytes, place);
    return this.build(index, bytes, head, at, place.frames);
  }

  /** `at`: the first byte behind the head. `count`: frames whose units are there. */
  private build(index: number, bytes: Uint8Array, head: Value<GroupHeadJson>, at: number, count: number): Group {
    const place = this.placeOf(index);
    const streams = takeStreams(bytes, at, place);
    const omega = this.weightsOf(head, streams);
    const mesh = this.meshOf(head, streams);
    const motion = motionOf(head, streams, mesh, place);
    const { first, frames } = place;
    const units = unitsOf(head, place, this.timeline.films.length, streams, count);
    return { index, first, frames, omega, ...this.scalesOf(head), units, mesh, motion };
  }

  private meshOf(head: Value<GroupHeadJson>, streams: Streams): DecodedMesh {
    const length = head.key("mesh");
    if (!length.exists) return this.mesh;
    if (this.scene.sheets) throw length.wrong("a mesh of its own, in a clip with sheets");
    const mesh = CODECS["mesh-2"].decode(streams(length as Value<number>), length.where);
    if (!mesh.indices.length) throw damaged(length.where, "a mesh without faces");
    return mesh;
  }

  private weightsOf(head: Value<GroupHeadJson>, streams: Streams): Float32Array {
    const rows = this.scene.heldOut.filter((out) => !out).length;
    const listed = exactly(head.key("weights"), this.scene.planes.length);
    const tables = this.scene.planes.flatMap(({ bases }, i) => {
      const own = listed[i] && exactly(listed[i], bases.length);
      return bases.map(({ count }, k) => {
        const length = own![k]!;
        const coded = CODECS["weights-1"].decode(streams(length as Value<number>), length.where);
        return checkWeights(coded, rows, count, length.where);
      });
    });
    return sideBySide(rows, tables);
  }

  private scalesOf(head: Value<GroupHeadJson>): Pick<Group, "means" | "bases"> {
    const { planes } = this.scene;
    const means = exactly(head.key("means"), planes.length).map((own, i) => affineOf(own, planes[i]!.mean));
    const bases = exactly(head.key("bases"), planes.length).flatMap((own, i) => {
      const { bases } = planes[i]!;
      return exactly(own as Value<AffineJson[]>, bases.length).map((each, k) => affineOf(each, bases[k]!.pictures[0]!));
    });
    return { means, bases };
  }
}

/** Gives the pictures of a scene the scales of a group. */
export function setScales(scene: SceneDocument, { means, bases }: Pick<Group, "means" | "bases">): void {
  scene.planes.forEach(({ mean }, i) => Object.assign(mean, means[i]));
  basesOf(scene).forEach(({ pictures: [picture] }, i) => picture && Object.assign(picture, bases[i]));
}

/** Without a secure context there is no SHA-256: what is wrong is then found where it is decoded. */
async function checkDigest(bytes: Uint8Array<ArrayBuffer>, { sha256, file, where }: GroupPlace): Promise<void> {
  const subtle = globalThis.crypto?.subtle as SubtleCrypto | undefined;
  if (!subtle) return;
  const digest = new Uint8Array(await subtle.digest("SHA-256", bytes));
  const found = Array.from(digest, (byte) => byte.toString(16).padStart(2, "0")).join("");
  if (found !== sha256) throw damaged(file ?? where, "other bytes than its SHA-256 says");
}

/** Of the deflated JSON, in bytes. */
function sizeOfHead(bytes: Uint8Array<ArrayBuffer>, { where }: Pick<GroupPlace, "where">): number {
  if (bytes.length < HEAD) throw damaged(where, "no head");
  return new DataView(bytes.buffer).getUint32(0, true);
}

/** The sum of all numbers in it. */
function totalOf(raw: Json | undefined): number {
  if (typeof raw === "number") return raw;
  return Array.isArray(raw) ? raw.reduce<number>((sum, one) => sum + totalOf(one), 0) : 0;
}

async function readHead(
  bytes: Uint8Array<ArrayBuffer>,
  { where }: GroupPlace,
): Promise<{ head: Value<GroupHeadJson>; at: number }> {
  const at = HEAD + sizeOfHead(bytes, { where });
  if (at > bytes.length) throw damaged(where, "a head longer than the group");
  const json = await inflated(bytes.subarray(HEAD, at), "deflate-raw", limits.MAX_GROUP_JSON, where);
  const text = new TextDecoder("utf-8").decode(json);
  return { head: new Value(parseJson(text, where), where), at };
}

/** The bytes of the next stream, whose length stands at a place of the head. */
type Streams = (length: Value<number>) => Uint8Array;

function takeStreams(bytes: Uint8Array, start: number, place: GroupPlace): Streams {
  let at = start;
  return (length) => {
    const from = at;
    at += length.integer(1, place.length);
    if (at > bytes.length) throw length.wrong("beyond the end of the group");
    return bytes.subarray(from, at);
  };
}

function motionOf(
  head: Value<GroupHeadJson>,
  streams: Streams,
  mesh: DecodedMesh,
  { frames }: GroupPlace,
): Motion | null {
  const length = head.key("motion");
  if (!length.exists) return null;
  const motion = CODECS["motion-1"].decode(streams(length as Value<number>), mesh, length.where);
  if (motion.frames !== frames) throw length.wrong(`${motion.frames} frames of ${frames}`);
  return motion;
}

/** Of each of so many frames a unit for each film. */
function unitsOf(
  head: Value<GroupHeadJson>,
  place: GroupPlace,
  films: number,
  streams: Streams,
  count: number,
): Uint8Array[][] {
  return exactly(head.key("frames"), place.frames).slice(0, count).map((frame) => {
    return exactly(frame as Value<number[]>, films).map((length) => streams(length as Value<number>));
  });
}

function affineOf(value: Value, { pieces, textures }: Picture): Affine {
  const own = value as Value<AffineJson>;
  return { scale: numbersOf(own.key("scale"), pieces, textures), zero: numbersOf(own.key("zero"), pieces, textures) };
}

function exactly<T>(value: Value<T>, count: number): ReturnType<Value<T>["items"]> {
  const items = value.items(count);
  if (items.length !== count) throw value.wrong(`${count} entries are needed`);
  return items;
}
