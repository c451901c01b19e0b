// A clip's clock: which frame is due, and when another one is shown.

import { EventDispatcher } from "three";
import type { ClipFrame, FrameRing, RingUser } from "./frame-ring.js";
import type { Sound } from "./sound.js";
import { frameAt, groupOf, timeOf, type Timeline } from "./timeline.js";

const LONGEST = 0.25; // seconds: after a pause of the page the clock goes on by no more
const PREVIEW = 100; // milliseconds after which something on the way to what is sought is shown
const WATCHED = 2; // seconds of playing over which decoders are found too slow
const SLOW = 0.25; // of what was due, which decoders did not bring in that time
const SMOOTH = 0.1; // seconds: a page that has its own frames less often says nothing of its decoders

export interface PlayerEvents {
  /** Another frame is shown; who draws on demand draws. */
  frame: {};
  /** It plays, or stands still, or waits, or plays otherwise, or is heard or not. */
  change: {};
}

/** What a browser shows less of than a clip has: codes of 8 bits, no eigen textures while it plays, as its decoders are too
 * slow for them, or the first frame of each group alone, as it decodes pictures of AV1 and no videos. */
export type Fallback = "bits" | "textures" | "keys";

/** What the clock tells. */
export interface PlayerUser {
  show(frame: ClipFrame): void;
  failed(reason: unknown): void;
}

/** Plays the frames of a clip. It calls itself while there is something to show. */
export class Player extends EventDispatcher<PlayerEvents> {
  /** In seconds: of the first frame, and of all together. */
  readonly first: number;
  readonly duration: number;
  readonly frames: number;
  readonly rate: number; // frames a second
  readonly sound: Sound | null; // null: it is silent

  private readonly ring: FrameRing;
  private shown: { position: number; number: number };
  private clock: number; // position
  private last: number | null = null; // milliseconds at which the clock was read, while it goes
  private plays = false;
  private pace = 1;
  private goal: number | null = null; // position that is sought
  private following: number | null = null; // what is sought after that
  private waiters: (() => void)[] = [];
  private asked: number | null = null; // for a frame of the page
  private disposed = false;
  private lacking: readonly Fallback[] = [];
  private watched = { seconds: 0, due: 0, short: 0 }; // while it plays: frames that were due, and that decoders did not bring

  /** Made with a field. `makeRing`: of the clip's frames. `makeSound`: null, it is silent. */
  constructor(
    private readonly timeline: Timeline,
    makeRing: (user: RingUser) => FrameRing,
    private readonly user: PlayerUser,
    makeSound: ((changed: () => void) => Sound) | null = null,
  ) {
    super();
    this.rate = timeline.rate;
    this.frames = timeline.frames;
    this.first = timeline.first;
    this.duration = timeline.frames / timeline.rate;
    this.shown = { position: 0, number: 0 };
    this.clock = 0;
    this.ring = makeRing({
      ready: () => this.wake(),
      failed: (reason, group) => this.fail(reason, group),
      thinned: () => this.thin(),
    });
    this.sound = makeSound && makeSound(() => void this.dispatchEvent({ type: "change" }));
    globalThis.document?.addEventListener("visibilitychange", this.hide);
  }

  get playing(): boolean {
    return this.plays;
  }

  /** The frame that is shown, from 0. */
  get frame(): number {
    return this.shown.number;
  }

  /** Its time in seconds. */
  get time(): number {
    return timeOf(this.timeline, this.shown.number);
  }

  /** The frame that is shown when what is sought is there. */
  get sought(): number {
    return (this.following ?? this.goal ?? this.shown.position) % this.frames;
  }

  /** Frames are sought or late: the clock stands. */
  get waiting(): boolean {
    return this.goal !== null;
  }

  /** The group of the frame that is shown: which of how many, from 0, and its bytes. */
  get group(): { index: number; count: number; bytes: number } {
    const { groups } = this.timeline;
    const index = groupOf(this.timeline, this.shown.number);
    return { index, count: groups.length, bytes: groups[index]?.length ?? 0 };
  }

  /** Frames that were never shown, as later ones were due. */
  get late(): number {
    return this.ring.late;
  }

  /** Frames of the browser's decoders that are not closed. */
  get open(): number {
    return this.ring.open;
  }

  /** What of the clip is not shown here, as far as is known: more is when it plays. */
  get fallbacks(): readonly Fallback[] {
    return this.lacking;
  }

  /** After the last frame the first follows; else the clip ends there. */
  get loop(): boolean {
    return this.ring.loop;
  }

  set loop(on: boolean) {
    this.ring.loop = on;
    this.ring.feed();
    this.dispatchEvent({ type: "change" });
  }

  /** Seconds of the clip a second, above 0. */
  get speed(): number {
    return this.pace;
  }

  set speed(pace: number) {
    if (!(pace > 0 && pace < Infinity)) throw new RangeError("A speed is above 0.");
    this.pace = pace;
    this.watch();
    this.dispatchEvent({ type: "change" });
  }

  play(): void {
    if (this.plays || this.disposed) return;
    this.plays = true;
    this.last = null;
    this.watch();
    this.ring.retry();
    if (!this.loop && (this.following ?? this.goal ?? this.shown.position) >= this.end) void this.toFrame(0);
    this.dispatchEvent({ type: "change" });
    this.wake();
  }

  pause(): void {
    if (!this.plays) return;
    this.plays = false;
    this.clock = this.shown.position;
    this.sound?.rest();
    if (this.ring.plain) this.begin(this.shown.position); // what stands still has its eigen textures
    this.dispatchEvent({ type: "change" });
  }

  /** To the frame that is nearest to a time in seconds; resolves when it is shown, or another that was sought since. */
  seek(seconds: number): Promise<void> {
    checkFinite(seconds);
    return this.toFrame(frameAt(this.timeline, seconds));
  }

  /** To a frame by its number, as `seek`. Where that takes longer than a moment, frames on the way to it are shown. */
  toFrame(number: number): Promise<void> {
    checkFinite(number);
    return this.toPosition(this.lap + Math.min(Math.max(Math.round(number), 0), this.frames - 1));
  }

  /** So many frames on, or back, and stands there. In a loop the first follows the last. */
  step(frames: number): Promise<void> {
    checkFinite(frames);
    this.pause();
    const position = this.ring.stepped(this.following ?? this.goal ?? this.shown.position, Math.round(frames));
    if (this.loop) return this.toPosition(position < 0 ? position + this.frames : position);
    return this.toPosition(Math.min(Math.max(position, this.lap), this.end));
  }

  /** Shows the frame that is due. `time` in milliseconds. In a headset, where the page has no frames, whoever draws calls
   * this before each. */
  update(time = performance.now()): void {
    if (this.disposed) return;
    const now = Math.max(time, this.last ?? time); // a frame of the page has the time of its beginning, which may be past
    const seconds = this.last === null ? 0 : Math.min((now - this.last) / 1000, LONGEST);
    this.last = this.plays && this.goal === null ? now : null;
    if (this.goal === null && !this.plays) return;
    if (this.goal === null) {
      this.advance(seconds);
      this.sound?.follow(this.first + (this.clock % this.frames) / this.rate, this.pace);
    } else this.sound?.rest();
    const frame = this.ring.take(this.goal ?? Math.floor(this.clock));
    if (frame) this.show(frame);
    if (this.goal === null && !this.loop && this.clock >= this.end && this.ring.isOver(this.end)) this.pause();
  }

  dispose(): void {
    this.disposed = true;
    this.plays = false;
    globalThis.document?.removeEventListener("visibilitychange", this.hide);
    this.ring.dispose();
    this.sound?.dispose();
    this.settle();
  }

  /** The position of the first frame of this turn. */
  private get lap(): number {
    return this.shown.position - this.shown.number;
  }

  private get end(): number {
    return this.lap + this.frames - 1;
  }

  private advance(seconds: number): void {
    const [before, due] = [this.clock, seconds * this.pace * this.rate];
    const most = this.loop ? this.ring.reach : Math.min(this.ring.reach, this.end);
    this.clock = Math.max(before, Math.min(before + due, most));
    if (seconds > SMOOTH) return;
    const { watched } = this;
    watched.seconds += seconds;
    watched.due += due;
    if (this.ring.busy) watched.short += due - (this.clock - before);
    if (watched.seconds < WATCHED) return;
    if (watched.short > SLOW * watched.due) this.ring.leaveOut();
    this.watch();
  }

  /** Watches decoders from now on. */
  private watch(): void {
    this.watched = { seconds: 0, due: 0, short: 0 };
  }

  /** Nobody hears what a page that is not seen plays on without its frames. */
  private readonly hide = (): void => {
    if (document.hidden) this.sound?.rest();
  };

  private toPosition(position: number): Promise<void> {
    const shown = new Promise<void>((resolve) => void this.waiters.push(resolve));
    if (this.goal !== null) this.following = position;
    else this.begin(position);
    return shown;
  }

  private begin(wanted: number): void {
    const position = this.ring.standIn(wanted);
    this.following = null;
    this.watch();
    if (position === this.shown.position && this.ring.follows(position)) {
      this.goal = null;
      this.clock = position;
      return this.settle();
    }
    this.goal = this.ring.seek(position) ? position : null;
    this.preview();
    if (this.goal === null) return this.settle(); // it cannot be decoded, which has been said
    this.dispatchEvent({ type: "change" });
    this.wake();
  }

  private show(frame: ClipFrame): void {
    const { position, number } = frame;
    this.shown = { position, number };
    this.user.show(frame);
    this.note(frame);
    if (this.goal !== null && position !== this.goal && this.following === null) this.preview();
    else if (this.goal !== null) {
      this.goal = null;
      this.clock = position;
      if (this.following !== null) this.begin(this.following);
      else this.settle();
    }
    this.dispatchEvent({ type: "frame" });
  }

  /** If what is sought is not there in a moment, something on the way is shown. */
  private preview(): void {
    this.ring.previewsFrom = this.goal === null ? Infinity : performance.now() + PREVIEW;
  }

  /** Sees what of the clip is left out. */
  private note({ films }: ClipFrame): void {
    const found: Fallback[] = [];
    if (this.ring.sparse) found.push("keys");
    if (films.some((codes) => codes?.grown)) found.push("bits");
    if (films.includes(null)) found.push("textures");
    if (found.join() === this.lacking.join()) return;
    this.lacking = found;
    this.dispatchEvent({ type: "change" });
  }

  /** Frames that are sought may not come any more: those that stand for them do. */
  private thin(): void {
    const sought = this.following ?? this.goal;
    this.lacking = ["keys"];
    if (sought !== null) this.begin(sought);
    this.dispatchEvent({ type: "change" });
    this.wake();
  }

  /** Nothing is sought any more. */
  private settle(): void {
    for (const done of this.waiters.splice(0)) done();
    this.dispatchEvent({ type: "change" });
  }

  private wake(): void {
    if (this.asked !== null || this.disposed || (!this.plays && this.goal === null)) return;
    this.asked = requestAnimationFrame((now) => {
      this.asked = null;
      this.update(now);
      if (this.plays) this.wake(); // what is sought wakes it when it is there
    });
  }

  /** A group that cannot be decoded is left out: the frame before it stays. */
  private fail(reason: unknown, group: number | null): void {
    if (this.disposed) return;
    this.user.failed(reason);
    if (group === null) {
      this.lacking = [];
      this.pause();
    }
    const sought = this.goal !== null && groupOf(this.timeline, this.goal % this.frames);
    if (sought === false || (group !== null && sought !== group)) return;
    if (this.goal !== null) this.clock = this.goal; // what comes behind it is shown when it is due
    this.goal = this.following = null;
    this.settle();
  }
}

/** A frame without a place would be waited for for ever. Raises RangeError. */
function checkFinite(value: number): void {
  if (!Number.isFinite(value)) throw new RangeError("Times and numbers of frames are finite.");
}
