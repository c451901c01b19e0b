// A clip and its page: frames are drawn as they come, and a clip that nobody has asked otherwise plays at once.

import type { Player } from "eigenfield-three";
import { reducedMotion } from "./mode";
import type { Session } from "./session";

export const SKIP = 1; // seconds on or back at a press of a trigger
const SPEEDS = [0.25, 0.5, 1, 2, 4];

export interface Playback {
  /** The player of the clip that is open; null: no clip is. */
  player(): Player | null;
  playOrPause(): void;
  toFrame(number: number): void;
  /** The same while somebody drags: it rests until `letGo`. */
  scrub(number: number): void;
  letGo(): void;
  /** So many seconds on, or back. */
  skip(seconds: number): void;
  /** Frames on, or back, and stands there. */
  step(frames: number): void;
  /** The next speed, or the one before; behind the last the first follows if `around`. */
  changeSpeed(step: 1 | -1, around?: boolean): void;
  setLoop(on: boolean): void;
  mute(on: boolean): void;
}

export interface Clips extends Playback {
  /** A scene is here. */
  opened(): void;
  /** It stands still, and what was sought is shown. */
  stopped(): Promise<void>;
}

/** moved: the picture is another one. changed: what is said of the clip. */
export function createPlayback(session: Session, moved: () => void, changed: () => void): Clips {
  const player = (): Player | null => session.scene?.field?.player ?? null;
  let goesOn: Player | null = null; // played when somebody began to drag
  return {
    player,
    playOrPause: () => {
      const own = player();
      if (own?.playing) own.pause();
      else own?.play();
    },
    toFrame: (number) => void player()?.toFrame(number),
    scrub: (number) => {
      const own = player();
      if (own?.playing) goesOn = own;
      own?.pause();
      void own?.toFrame(number);
    },
    letGo: () => {
      if (goesOn === player()) goesOn?.play();
      goesOn = null;
    },
    skip: (seconds) => {
      const own = player();
      void own?.toFrame(own.sought + seconds * own.rate);
    },
    step: (frames) => void player()?.step(frames),
    changeSpeed: (step, around = false) => {
      const own = player();
      if (!own) return;
      const next = SPEEDS.indexOf(own.speed) + step;
      const speed = SPEEDS[around ? next % SPEEDS.length : Math.min(Math.max(next, 0), SPEEDS.length - 1)];
      if (speed !== undefined) own.speed = speed;
    },
    setLoop: (on) => {
      const own = player();
      if (own) own.loop = on;
    },
    mute: (on) => {
      const sound = player()?.sound;
      if (sound) sound.muted = on;
    },
    opened: () => {
      const own = player();
      own?.addEventListener("frame", moved);
      own?.addEventListener("change", changed);
      if (!reducedMotion()) own?.play();
    },
    stopped: async () => {
      const own = player();
      own?.pause();
      if (own?.waiting) await own.toFrame(own.sought);
    },
  };
}
