// How much care a frame is drawn with. Where frames come too slowly while something moves they are drawn with linear
// texels, and coarser if that is not enough; once all is still for a moment the full picture follows. Within one
// movement it only becomes coarser, so that nothing flickers.

import type { Filter } from "eigenfield-three";

const SLOW = 40; // milliseconds a frame may take while something moves
const REST = 200; // milliseconds without movement until the full picture is drawn
const PAUSE = 100; // milliseconds after a rest from which on a frame's delay may be the hand's, not the machine's
const MEASURED = 5; // frames: their mean counts, as a slow GPU takes two at once and then none for long
const ENOUGH = 3; // frames that tell how long one takes
const STUCK = 400; // milliseconds after which fewer do
const PATIENCE = 20_000; // milliseconds until a level that was too slow is tried again
const COARSEST = 0.5; // device pixels a CSS pixel
const WORK: Readonly<Record<Filter, number>> = { bilinear: 1, bicubic: 1.5 }; // of a pixel

export interface Detail {
  scale: number; // of the canvas's own resolution
  linear: boolean; // texels are read linearly, whatever filter was chosen
}

export const FULL: Detail = { scale: 1, linear: false };
const LEVELS: readonly Detail[] = [FULL, ...[1, 0.71, 0.5, 0.35, 0.25].map((scale) => ({ scale, linear: true }))];

export interface Pace {
  /** How the frame at this time (milliseconds) is to be drawn. follows: asked for by the frame before. */
  frame(now: number, moves: boolean, follows: boolean): Detail;
  /** The full picture is still to come. */
  waiting(): boolean;
}

/** request: asks for a frame. filter: the chosen one. ratio: device pixels a CSS pixel of the full picture. */
export function createPace(request: () => void, filter: () => Filter, ratio: () => number): Pace {
  const tooSlow: (number | undefined)[] = []; // when each level last was
  let level = 0;
  let last: number | null = null; // time of the frame before, while something moves
  let times: number[] = []; // of frames at this level
  let timer: number | null = null;

  const work = (index: number): number => {
    const { scale, linear } = LEVELS[index] ?? FULL;
    return scale * scale * WORK[linear ? "bilinear" : filter()];
  };
  const coarsest = (): number => Math.max(1, LEVELS.filter(({ scale }) => scale * ratio() >= COARSEST).length - 1);
  const setLevel = (next: number): void => {
    level = next;
    times = [];
    last = null; // the next frame makes its program and its buffers first
  };
  /** Milliseconds a frame would take at another level, by those it takes at this one. */
  const expected = (index: number): number | null => {
    const sum = times.reduce((a, b) => a + b, 0);
    return times.length < ENOUGH && sum < STUCK ? null : ((sum / times.length) * work(index)) / work(level);
  };
  const begin = (now: number): void => {
    const finer = level - 1;
    const then = tooSlow[finer];
    const time = level > 0 && (then === undefined || now - then > PATIENCE) ? expected(finer) : null;
    if (time !== null && time < 0.9 * SLOW) setLevel(finer);
  };
  const measure = (now: number, follows: boolean): void => {
    if (last !== null && (follows || now - last < PAUSE)) times = [...times, now - last].slice(-MEASURED);
    last = now;
    const time = expected(level);
    if (time === null || time <= SLOW || level >= coarsest()) return;
    tooSlow[level] = now;
    let next = level + 1;
    while (next < coarsest() && (expected(next) ?? 0) > SLOW) next++;
    setLevel(next);
  };

  return {
    waiting: () => timer !== null,
    frame: (now, moves, follows) => {
      if (!moves) {
        last = null;
        return (timer === null ? FULL : LEVELS[level]) ?? FULL;
      }
      if (timer === null && last === null) begin(now);
      measure(now, follows);
      if (timer !== null) clearTimeout(timer);
      timer = level === 0 ? null : window.setTimeout(() => {
        timer = null;
        request();
      }, REST);
      return LEVELS[level] ?? FULL;
    },
  };
}
