// A few frames of a clip, decoded ahead of the one that is shown. Places in time are positions: the number of a frame,
// and after each turn of a clip that is played in a loop as many more as it has frames. So no two frames share one.

import { SceneError } from "./errors.js";
import type { FilmSource, FilmUser } from "./film-decoder.js";
import { FilmPictures } from "./film-pictures.js";
import type { Group, Groups } from "./groups.js";
import type { Codes } from "./pieces.js";
import { groupOf, type Timeline } from "./timeline.js";

const AHEAD = 8; // frames that are kept
const KEYS_AHEAD = 2; // key pictures that are kept where nothing else is decoded
const SOON = 2 / 3; // of a group, from where on the next one is fetched
const OF_A_GROUP = new Set(["damaged", "truncated", "network"]); // errors that leave the other groups as they are

/** A frame of which all films are there. */
export interface ClipFrame {
  position: number;
  number: number;
  group: Group;
  films: (Codes | null)[]; // null: of eigen textures, which are left out
}

/** A frame of which the films arrive. */
interface Slot {
  group: Group;
  films: (Codes | null)[];
}

export interface RingUser {
  /** A frame is there. */
  ready(): void;
  /** A group cannot be decoded, and is left out; null: none can. */
  failed(reason: unknown, group: number | null): void;
  /** From now on there are the first frames of groups alone. */
  thinned(): void;
}

export class FrameRing {
  loop = true;
  late = 0; // frames that were passed over, as those behind them were due
  previewsFrom = Infinity; // milliseconds: from then on frames on the way to what is sought are kept, to be shown
  private decoders: FilmSource[];
  private keysAlone: SceneError | null = null; // why of each group the first frame alone is decoded, as a picture
  private meansAlone = false; // films of eigen textures are left out
  private readonly slots = new Map<number, Slot>();
  private readonly skipped = new Set<number>(); // positions whose frames are thrown away when they come
  private readonly rooms: Uint8Array<ArrayBuffer>[][];
  private shown: ClipFrame | null = null;
  private wanted = 0; // position
  private from = 1; // position: what comes before it is decoded, and not kept; the first frame is there
  private next = 0; // position of the unit that is given to the decoders next
  private given: Group | null = null; // of the unit given last
  private fed = 0; // index of the group that is given or opened
  private readonly tried = new Set<number>(); // groups of which the decoder failed once
  private readonly broken = new Set<number>(); // groups that cannot be decoded
  private newest = -1; // position of the last frame that came
  private turn = 0;
  private feeding = false;
  private hopeless = false; // no group can be decoded

  constructor(
    private readonly timeline: Timeline,
    private readonly groups: Groups,
    private readonly user: RingUser,
  ) {
    this.rooms = timeline.films.map(() => []);
    this.decoders = this.makeDecoders();
  }

  /** Frames of browsers that are not closed. */
  get open(): number {
    return this.decoders.reduce((sum, decoder) => sum + decoder.open, 0);
  }

  /** The position beyond which a clock that plays would leave the decoders behind. */
  get reach(): number {
    return Math.max(this.newestEnd, this.from) + AHEAD / 2;
  }

  /** Frames are late because decoders are. */
  get busy(): boolean {
    return this.decoders.some(({ busy }) => busy);
  }

  /** The first frames of groups alone are there. */
  get sparse(): boolean {
    return this.keysAlone !== null;
  }

  /** Eigen textures are left out. */
  get plain(): boolean {
    return this.meansAlone;
  }

  /** Whether the frame at a position, which is shown, has all that it is to have, and what comes behind it comes next. */
  follows(position: number): boolean {
    return !this.meansAlone && this.from <= position + 1;
  }

  /** Leaves eigen textures out until something is sought. */
  leaveOut(): void {
    if (this.meansAlone || this.keysAlone || this.timeline.films.every(({ detail }) => !detail)) return;
    this.meansAlone = true;
    this.decoders.forEach((decoder, film) => this.needs(film) || decoder.reset());
    this.user.ready();
    this.feed();
  }

  /** Whether no frame up to a position is to come. */
  isOver(position: number): boolean {
    return this.newestEnd >= position && ![...this.slots.keys()].some((at) => at <= position);
  }

  /** The position of the frame that is shown for one. */
  standIn(position: number): number {
    return this.keysAlone ? this.startOf(position) : position;
  }

  /** The position so many frames that are shown on from one, or back. */
  stepped(position: number, steps: number): number {
    if (!this.keysAlone) return position + steps;
    const { groups, frames } = this.timeline;
    const index = groupOf(this.timeline, this.numberOf(position)) + steps;
    const laps = Math.floor(index / groups.length);
    return position - this.numberOf(position) + laps * frames + groups[index - laps * groups.length]!.first;
  }

  /** From now on frames from a position on are wanted. False: its group cannot be decoded. */
  seek(position: number): boolean {
    if (this.broken.has(groupOf(this.timeline, this.numberOf(position)))) return false;
    const start = this.startOf(position);
    const whole = position >= this.from && this.slots.has(position) && ![...this.skipped].some((at) => at > position);
    if (this.meansAlone || this.given === null || this.next <= start || (position < this.next && !whole)) {
      this.meansAlone = false;
      this.stop();
      this.next = start;
    }
    this.wanted = this.from = position;
    for (const [at, slot] of this.slots) if (at < position) this.forget(at, slot);
    this.feed();
    return true;
  }

  /** Tries again where nothing could be decoded. */
  retry(): void {
    if (this.hopeless && this.keysAlone) {
      this.keysAlone = null;
      this.decoders = this.makeDecoders();
    }
    this.hopeless = false;
    if (this.next === Infinity) this.seek(this.from);
  }

  /** The newest frame up to a position, unless that is shown already. What comes before it is let go, and after the next
   * call it too. */
  take(position: number): ClipFrame | null {
    if (this.next === Infinity && !this.hopeless && !this.seek(this.from)) {
      this.pass(groupOf(this.timeline, this.numberOf(this.from)), this.from);
    }
    this.wanted = position;
    const there = [...this.slots].filter(([at, { films }]) => at <= position && this.isWhole(films));
    const at = Math.max(...there.map(([at]) => at));
    const slot = this.slots.get(at);
    if (!slot) {
      this.feed();
      return null;
    }
    for (const [before, slot] of this.slots) {
      if (before >= at) continue;
      if (before >= this.from) this.late += 1;
      this.forget(before, slot);
    }
    this.slots.delete(at);
    for (const skipped of this.skipped) if (skipped < at) this.skipped.delete(skipped);
    this.reuse(this.shown?.films ?? []);
    this.from = Math.max(this.from, at + 1);
    this.shown = { position: at, number: this.numberOf(at), ...slot };
    this.feed();
    return this.shown;
  }

  /** Decodes on, as far as there is room. */
  feed(): void {
    if (this.feeding) return;
    this.feeding = true;
    const { turn } = this;
    void this.feedAll()
      .catch((reason: unknown) => {
        if (turn === this.turn) this.fail(reason);
      })
      .finally(() => {
        this.feeding = false;
        if (turn !== this.turn) this.feed();
      });
  }

  dispose(): void {
    this.rest();
    this.hopeless = true;
    for (const decoder of this.decoders) decoder.dispose();
  }

  private numberOf(position: number): number {
    return position % this.timeline.frames;
  }

  /** The first position of the group that has one. */
  private startOf(position: number): number {
    const number = this.numberOf(position);
    return position - number + this.timeline.groups[groupOf(this.timeline, number)]!.first;
  }

  /** The last position for which the newest frame may be shown. */
  private get newestEnd(): number {
    if (!this.keysAlone || this.newest < 0) return this.newest;
    const group = this.timeline.groups[groupOf(this.timeline, this.numberOf(this.newest))]!;
    return this.startOf(this.newest) + group.frames - 1;
  }

  private makeDecoders(): FilmSource[] {
    return this.timeline.films.map(({ codec, size, where }, film) => codec.decode(size, where, this.userOf(film)));
  }

  private userOf(film: number): FilmUser {
    const { opacity } = this.timeline.films[film]!;
    return {
      take: (position, read) => this.receive(film, position, (room) => read(room, opacity)),
      closed: () => this.feed(),
      failed: (reason) => this.fail(reason),
      lost: () => this.rest(),
    };
  }

  private needs(film: number): boolean {
    return !this.meansAlone || !this.timeline.films[film]!.detail;
  }

  private isWhole(films: (Codes | null)[]): boolean {
    return films.every((codes, film) => codes !== null || !this.needs(film));
  }

  private get hasRoom(): boolean {
    const { frames } = this.timeline;
    const end = this.loop ? Infinity : frames * (Math.floor(this.wanted / frames) + 1);
    const last = this.keysAlone ? (this.slots.size < KEYS_AHEAD ? Infinity : 0) : Math.max(this.from, this.wanted) + AHEAD;
    return this.next < Math.min(last, end) && this.decoders.every(({ ready }, film) => ready || !this.needs(film));
  }

  private async feedAll(): Promise<void> {
    while (this.hasRoom) {
      const [{ turn }, position, number] = [this, this.next, this.numberOf(this.next)];
      const index = groupOf(this.timeline, number);
      if (this.broken.has(index)) {
        this.pass(index, position);
        continue;
      }
      this.fed = index;
      const group = this.given?.index === index ? this.given : await this.groups.open(index);
      const within = number - group.first;
      const units = group.units[within] ?? [];
      if (within >= group.frames * SOON) this.prepare((index + 1) % this.timeline.groups.length);
      group.motion?.read(within);
      const used = (): [FilmSource, Uint8Array][] => {
        return this.decoders.map((decoder, film): [FilmSource, Uint8Array] => [decoder, units[film]!]).filter((_, film) => this.needs(film));
      };
      if (within === 0) await Promise.all(used().map(([decoder, unit]) => decoder.start(unit)));
      if (turn !== this.turn) return;
      this.given = group;
      this.next = this.keysAlone ? position + group.frames : position + 1;
      for (const [decoder, unit] of used()) decoder.decode(unit, position, within === 0);
      if (within === group.frames - 1) await Promise.all(this.decoders.map((decoder) => decoder.flush()));
      if (turn !== this.turn) return;
    }
  }

  /** Has a group fetched before it is wanted; what goes wrong is heard when it is. */
  private prepare(index: number): void {
    if ((index || this.loop) && !this.broken.has(index)) this.groups.open(index).catch(() => undefined);
  }

  private async receive(
    film: number,
    position: number,
    read: (room: Codes["room"]) => Promise<Codes>,
  ): Promise<void> {
    const [{ turn }, slot] = [this, this.slotOf(position)];
    if (!slot) return;
    const codes = await read(this.rooms[film]?.pop());
    if (turn !== this.turn || this.slots.get(position) !== slot) return this.reuseOne(film, codes);
    slot.films[film] = codes;
    if (this.isWhole(slot.films)) this.user.ready();
  }

  /** Where the films of a frame are gathered; null: it is not wanted any more, or later ones are due already. */
  private slotOf(position: number): Slot | null {
    const slot = this.slots.get(position);
    if (slot || this.skipped.has(position)) return slot ?? null; // the other films of the same frame
    this.newest = Math.max(this.newest, position);
    const onTheWay = position < this.from;
    if (!this.given || (onTheWay && performance.now() < this.previewsFrom)) return null;
    if (!onTheWay && position < this.wanted && this.slots.size > 0) {
      this.late += 1;
      this.skipped.add(position);
      return null;
    }
    const made = { group: this.given, films: this.decoders.map(() => null) };
    this.slots.set(position, made);
    return made;
  }

  private fail(reason: unknown): void {
    const noDecoder = reason instanceof SceneError && reason.code === "codec" ? reason : null;
    if (noDecoder && !this.keysAlone) return this.thin(noDecoder);
    if (!(reason instanceof SceneError) || !OF_A_GROUP.has(reason.code)) {
      this.rest();
      this.hopeless = true;
      return this.user.failed(noDecoder ? this.keysAlone : reason, null);
    }
    const again = reason.code === "damaged" && this.given?.index === this.fed && !this.tried.has(this.fed);
    const start = this.startOf(Math.max(this.next - 1, 0));
    this.halt();
    for (const [at, slot] of this.slots) if (!this.isWhole(slot.films)) this.forget(at, slot);
    if (again) {
      this.tried.add(this.fed); // a decoder may fail where nothing is damaged
      this.next = start;
    } else {
      this.broken.add(this.fed);
      this.user.failed(reason, this.fed);
    }
    this.feed();
  }

  /** Goes on with pictures, as there is no decoder of videos. */
  private thin(reason: SceneError): void {
    for (const decoder of this.decoders) decoder.dispose();
    this.keysAlone = reason;
    this.meansAlone = false;
    this.decoders = this.timeline.films.map(({ size, where }, film) => new FilmPictures(size, where, this.userOf(film)));
    this.stop();
    this.next = this.startOf(this.from);
    this.user.thinned();
    this.feed();
  }

  /** Nothing is decoded until something is sought. */
  private rest(): void {
    this.stop();
    this.next = Infinity;
  }

  /** Goes on behind a group that cannot be decoded, from one of its positions. */
  private pass(index: number, position: number): void {
    const { first, frames } = this.timeline.groups[index]!;
    this.next = position - this.numberOf(position) + first + frames;
    this.newest = this.next - 1;
  }

  private stop(): void {
    this.halt();
    this.newest = -1;
    for (const [at, slot] of this.slots) this.forget(at, slot);
  }

  /** What is on its way is thrown away. */
  private halt(): void {
    this.turn += 1;
    this.given = null;
    this.skipped.clear();
    for (const decoder of this.decoders) decoder.reset();
  }

  private forget(at: number, { films }: Slot): void {
    this.slots.delete(at);
    this.reuse(films);
  }

  private reuse(films: (Codes | null)[]): void {
    films.forEach((codes, film) => codes && this.reuseOne(film, codes));
  }

  private reuseOne(film: number, { room }: Codes): void {
    if (room) this.rooms[film]?.push(room);
  }
}
