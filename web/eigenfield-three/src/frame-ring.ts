// A few frames of a clip, decoded ahead of the one that is shown. Places in time are positions: the number of a frame,
// and after each turn of a clip that is played in a loop as many more as it has frames. So no two frames share one.

import { SceneError } from "./errors.js";
import { codesOf } from "./film-codes.js";
import type { FilmDecoder } from "./film-decoder.js";
import type { Group, Groups } from "./groups.js";
import type { Codes } from "./pieces.js";
import { groupOf, type Timeline } from "./timeline.js";

const AHEAD = 8; // frames that are kept
const OF_A_GROUP = new Set(["damaged", "truncated", "network"]); // errors that leave the other groups as they are

/** A frame of which all films are there. */
export interface ClipFrame {
  position: number;
  number: number;
  group: Group;
  films: Codes[];
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
}

export class FrameRing {
  loop = true;
  late = 0; // frames that were passed over, as those behind them were due
  private readonly decoders: FilmDecoder[];
  private readonly slots = new Map<number, Slot>();
  private readonly skipped = new Set<number>(); // positions whose frames are thrown away when they come
  private readonly rooms: Uint8Array<ArrayBuffer>[][];
  private shown: ClipFrame | null = null;
  private wanted = 0; // position
  private from = 1; // position: what comes before it is decoded, and not kept; the first frame is there
  private next = 0; // position of the unit that is given to the decoders next
  private given: Group | null = null; // of the unit given last
  private fed = 0; // index of the group that is given or opened
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
    this.decoders = timeline.films.map(({ codec, size, where }, film) =>
      codec.decode(size, where, {
        take: (position, frame) => this.receive(film, position, frame),
        closed: () => this.feed(),
        failed: (reason) => this.fail(reason),
        lost: () => this.rest(),
      }),
    );
  }

  /** Frames of browsers that are not closed. */
  get open(): number {
    return this.decoders.reduce((sum, decoder) => sum + decoder.open, 0);
  }

  /** The position beyond which a clock that plays would leave the decoders behind. */
  get reach(): number {
    return Math.max(this.newest, this.from) + AHEAD / 2;
  }

  /** Whether no frame up to a position is to come. */
  isOver(position: number): boolean {
    return this.newest >= position && ![...this.slots.keys()].some((at) => at <= position);
  }

  /** From now on frames from a position on are wanted. False: its group cannot be decoded. */
  seek(position: number): boolean {
    const group = groupOf(this.timeline, this.numberOf(position));
    if (this.broken.has(group)) return false;
    const start = position - this.numberOf(position) + (this.timeline.groups[group]?.first ?? 0);
    const whole = this.slots.has(position) && ![...this.skipped].some((at) => at > position);
    if (this.given === null || this.next <= start || (position < this.next && !whole)) {
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
    this.hopeless = false;
    if (this.next === Infinity) this.seek(this.from);
  }

  /** The newest frame up to a position, unless that is shown already. What comes before it is let go, and after the next
   * call it too. */
  take(position: number): ClipFrame | null {
    if (this.next === Infinity && !this.hopeless) this.seek(this.from);
    this.wanted = position;
    const there = [...this.slots.keys()].filter((at) => at <= position && !this.slots.get(at)?.films.includes(null));
    const at = Math.max(...there);
    const slot = this.slots.get(at);
    if (!slot) {
      this.feed();
      return null;
    }
    for (const [before, slot] of this.slots) {
      if (before >= at) continue;
      this.late += 1;
      this.forget(before, slot);
    }
    this.slots.delete(at);
    for (const skipped of this.skipped) if (skipped < at) this.skipped.delete(skipped);
    this.reuse(this.shown?.films ?? []);
    this.from = at + 1;
    this.shown = { position: at, number: this.numberOf(at), group: slot.group, films: slot.films as Codes[] };
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

  private get hasRoom(): boolean {
    const { frames } = this.timeline;
    const end = this.loop ? Infinity : frames * (Math.floor(this.wanted / frames) + 1);
    const last = Math.max(this.from, this.wanted) + AHEAD;
    return this.next < Math.min(last, end) && this.decoders.every(({ ready }) => ready);
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
      group.motion?.read(within);
      if (within === 0) await Promise.all(this.decoders.map((decoder, film) => decoder.start(units[film]!)));
      if (turn !== this.turn) return;
      this.given = group;
      this.next = position + 1;
      this.decoders.forEach((decoder, film) => decoder.decode(units[film]!, position, within === 0));
      if (within === group.frames - 1) await Promise.all(this.decoders.map((decoder) => decoder.flush()));
      if (turn !== this.turn) return;
    }
  }

  private async receive(film: number, position: number, frame: VideoFrame): Promise<void> {
    const [{ turn }, slot] = [this, this.slotOf(position)];
    if (!slot) return;
    const codes = await codesOf(frame, this.rooms[film]?.pop() ?? null, this.timeline.films[film]?.opacity);
    if (turn !== this.turn || this.slots.get(position) !== slot) return this.reuseOne(film, codes);
    slot.films[film] = codes;
    if (!slot.films.includes(null)) this.user.ready();
  }

  /** Where the films of a frame are gathered; null: it is not wanted any more, or later ones are due already. */
  private slotOf(position: number): Slot | null {
    const slot = this.slots.get(position);
    if (slot || this.skipped.has(position)) return slot ?? null; // the other films of the same frame
    this.newest = Math.max(this.newest, position);
    if (position < this.from || !this.given) return null;
    if (position < this.wanted && this.slots.size > 0) {
      this.late += 1;
      this.skipped.add(position);
      return null;
    }
    const made = { group: this.given, films: this.decoders.map(() => null) };
    this.slots.set(position, made);
    return made;
  }

  private fail(reason: unknown): void {
    if (!(reason instanceof SceneError) || !OF_A_GROUP.has(reason.code)) {
      this.rest();
      this.hopeless = true;
      return this.user.failed(reason, null);
    }
    this.halt();
    for (const [at, slot] of this.slots) if (slot.films.includes(null)) this.forget(at, slot);
    this.broken.add(this.fed);
    this.user.failed(reason, this.fed);
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
