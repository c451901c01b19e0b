// Frames on demand: one is drawn when something asked for it, and the next only while something still moves. While a clip
// plays each frame of the browser passes through here, for what it tells of the machine, and most need no drawing.

/** What moves from frame to frame, by itself or by a hand. */
export interface Mover {
  /** One frame's movement, of so many seconds; true while there is more to come. */
  step(seconds: number): boolean;
}

export interface Loop {
  request(): void;
  /** The next frame is looked at, and drawn if there is something else to be seen. */
  next(): void;
  /** A hand moved something: the next frame shows movement even if nothing glides. */
  touch(): void;
  frames(): number; // drawn so far
  rate(): number | null; // frames per second while drawing goes on, else null
  idle(): boolean;
  pause(): void; // somebody else (a headset) paces the frames
  resume(): void;
}

const LONGEST = 0.1; // seconds: a step after a pause is no longer than this
const REMEMBERED = 30; // frames over which the rate is taken

/** What is known of a frame when it is drawn. */
export interface Moment {
  now: number; // milliseconds
  moves: boolean;
  follows: boolean; // the frame before asked for it
  wanted: boolean; // there is something else to be seen than before
}

/** movers: all that move in every frame. plays: a clip brings pictures of its own. draw: one frame; whether it drew.
 * rested: all is still. */
export function createLoop(
  movers: readonly Mover[],
  plays: () => boolean,
  draw: (moment: Moment) => boolean,
  rested: () => void,
): Loop {
  let handle: number | null = null;
  let last: number | null = null; // time of the frame before, null after a rest
  let drawn = 0;
  let paused = false;
  let touched = false;
  let wanted = false;
  const times: number[] = [];

  const frame = (now: number): void => {
    handle = null;
    const follows = last !== null;
    const seconds = last === null ? 1 / 60 : Math.min((now - last) / 1000, LONGEST);
    if (last === null) times.length = 0;
    last = now;
    const moves = movers.map((mover) => mover.step(seconds)).includes(true);
    const goesOn = plays();
    const drew = draw({ now, moves: moves || touched || goesOn, follows, wanted: moves || wanted });
    touched = wanted = false;
    if (drew) {
      drawn++;
      times.push(now);
      if (times.length > REMEMBERED) times.shift();
    }
    if (moves) request();
    else if (goesOn) next();
    if (handle === null) {
      last = null;
      rested();
    }
  };
  const next = (): void => {
    if (!paused) handle ??= requestAnimationFrame(frame);
  };
  const request = (): void => {
    wanted = true;
    next();
  };

  return {
    request,
    next,
    touch: () => {
      touched = true;
      request();
    },
    frames: () => drawn,
    rate: () => {
      const [first] = times;
      const latest = times[times.length - 1];
      if (last === null || times.length < 5 || first === undefined || latest === undefined) return null;
      return (1000 * (times.length - 1)) / (latest - first);
    },
    idle: () => handle === null,
    pause: () => {
      paused = true;
      if (handle !== null) cancelAnimationFrame(handle);
      handle = null;
      last = null;
    },
    resume: () => {
      paused = false;
      request();
    },
  };
}
