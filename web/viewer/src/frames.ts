// Frames: what moves before each of them, with how much care it is drawn, and who hears of it.

import { createLoop, type Mover } from "./loop";
import { createPace, FULL, type Detail } from "./pace";
import type { Session } from "./session";
import type { Stage } from "./stage";

export interface Frames {
  /** Something else is to be shown: a frame is drawn, and who listens hears of it once. */
  changed(): void;
  /** A clip does something else, which the picture does not show yet. */
  told(): void;
  request(): void;
  /** A hand moved something: the next frame shows movement even if nothing glides. */
  touch(): void;
  drawn(): number; // so far
  rate(): number | null; // a second, while drawing goes on
  /** How the last one was drawn: not in full while movement is too much for the machine. */
  detail(): Detail;
  /** Draws now and in full, for those who read the canvas. */
  drawNow(): void;
  /** After another frame, once nothing moves, the full picture is drawn and nothing is `pending`. */
  rested(pending: () => boolean): Promise<void>;
  /** A headset takes over, and hands back. */
  suspend(): void;
  resume(): void;
  onChange(listener: () => void): void;
  onDraw(listener: () => void): void;
}

/** movers: what moves, of which more may be added. plays: a clip brings pictures of its own. paint: draws one frame. */
export function createFrames(
  session: Session,
  stage: Stage,
  movers: readonly Mover[],
  plays: () => boolean,
  paint: (detail: Detail) => void,
): Frames {
  const changeListeners: (() => void)[] = [];
  const drawListeners: (() => void)[] = [];
  const restWaiters: (() => void)[] = [];
  let changePending = false;
  let suspended = false;
  let detail = FULL;

  const draw = (next: Detail): void => {
    detail = next;
    paint(detail);
    for (const listener of drawListeners) listener();
  };
  const loop = createLoop(
    movers,
    plays,
    ({ now, moves, follows, wanted }) => {
      const next = pace.frame(now, moves, follows);
      if (!wanted && next === detail) return false;
      draw(next);
      return true;
    },
    () => {
      for (const done of restWaiters.splice(0)) done();
      for (const listener of drawListeners) listener();
    },
  );
  const pace = createPace(loop.request, () => session.options.filter, stage.ratio);
  const told = (): void => {
    loop.next();
    if (changePending) return;
    changePending = true;
    queueMicrotask(() => {
      changePending = false;
      for (const listener of changeListeners) listener();
    });
  };

  const changed = (): void => {
    loop.request();
    told();
  };

  return {
    changed,
    told,
    request: loop.request,
    touch: loop.touch,
    drawn: loop.frames,
    rate: loop.rate,
    detail: () => detail,
    drawNow: () => {
      if (!suspended) draw(FULL);
    },
    rested: async (pending) => {
      do await new Promise<void>((done) => void (restWaiters.push(done), loop.request()));
      while (pending() || !loop.idle() || pace.waiting());
    },
    suspend: () => {
      suspended = true;
      stage.setScale(FULL.scale);
      loop.pause();
      changed();
    },
    resume: () => {
      suspended = false;
      loop.resume();
      changed();
    },
    onChange: (listener) => void changeListeners.push(listener),
    onDraw: (listener) => void drawListeners.push(listener),
  };
}
