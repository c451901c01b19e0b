// A clip's clock: which frame is due, and when another one is shown.

import { EventDispatcher } from "three";
import type { ClipFrame, FrameRing, RingUser } from "./frame-ring.js";
import type { Sound } from "./sound.js";
import { frameAt, groupOf, timeOf, type Timeline } from "./timeline.js";

const LONGEST = 0.25; // seconds: after a pause of the page the clock goes on by no more

export interface PlayerEvents {
  /** Another frame is shown; who draws on demand draws. */
  frame: {};
  /** It plays, or stands still, or waits, or plays otherwise, or is heard or not. */
  change: {};
}

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
    this.ring = makeRing({ ready: () => this.wake(), failed: (reason, group) => this.fail(reason, group) });
    this.sound = makeSound && makeSound(() => void this.dispatchEvent({ type: "change" }));
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
    this.dispatchEvent({ type: "change" });
  }

  play(): void {
    if (this.plays || this.disposed) return;
    this.plays = true;
    this.last = null;
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
    this.dispatchEvent({ type: "change" });
  }

  /** To the frame that is nearest to a time in seconds; resolves when it is shown, or another that was sought since. */
  seek(seconds: number): Promise<void> {
    return this.toFrame(frameAt(this.timeline, seconds));
  }

  /** To a frame by its number, as `seek`. */
  toFrame(number: number): Promise<void> {
    return this.toPosition(this.lap + Math.min(Math.max(Math.round(number), 0), this.frames - 1));
  }

  /** So many frames on, or back, and stands there. In a loop the first follows the last. */
  step(frames: number): Promise<void> {
    this.pause();
    const position = (this.following ?? this.goal ?? this.shown.position) + Math.round(frames);
    if (this.loop) return this.toPosition(position < 0 ? position + this.frames : position);
    return this.toPosition(Math.min(Math.max(position, this.lap), this.end));
  }

  /** Shows the frame that is due. `now` in milliseconds. In a headset, where the page has no frames, whoever draws calls
   * this before each. */
  update(now = performance.now()): void {
    if (this.disposed) return;
    const seconds = this.last === null ? 0 : Math.min((now - this.last) / 1000, LONGEST);
    this.last = this.plays && this.goal === null ? now : null;
    if (this.goal === null && !this.plays) return;
    if (this.goal === null) {
      this.clock = this.advanced(seconds);
      this.sound?.follow(this.first + (this.clock % this.frames) / this.rate, this.pace);
    } else this.sound?.rest();
    const frame = this.ring.take(this.goal ?? Math.floor(this.clock));
    if (frame) this.show(frame);
    if (this.goal === null && !this.loop && this.clock >= this.end && this.ring.isOver(this.end)) this.pause();
  }

  dispose(): void {
    this.disposed = true;
    this.plays = false;
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

  private advanced(seconds: number): number {
    const next = this.clock + seconds * this.pace * this.rate;
    const most = this.loop ? this.ring.reach : Math.min(this.ring.reach, this.end);
    return Math.max(this.clock, Math.min(next, most));
  }

  private toPosition(position: number): Promise<void> {
    const shown = new Promise<void>((resolve) => void this.waiters.push(resolve));
    if (this.goal !== null) this.following = position;
    else this.begin(position);
    return shown;
  }

  private begin(position: number): void {
    this.following = null;
    if (position === this.shown.position) {
      this.goal = null;
      this.clock = position;
      return this.settle();
    }
    this.goal = this.ring.seek(position) ? position : null;
    if (this.goal === null) return this.settle(); // it cannot be decoded, which has been said
    this.dispatchEvent({ type: "change" });
    this.wake();
  }

  private show(frame: ClipFrame): void {
    const { position, number } = frame;
    this.shown = { position, number };
    this.user.show(frame);
    if (position === this.goal) {
      this.goal = null;
      this.clock = position;
      if (this.following !== null) this.begin(this.following);
      else this.settle();
    }
    this.dispatchEvent({ type: "frame" });
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
    if (group === null) this.pause();
    const sought = this.goal !== null && groupOf(this.timeline, this.goal % this.frames);
    if (sought === false || (group !== null && sought !== group)) return;
    this.goal = this.following = null;
    this.settle();
  }
}
