// Until somebody moves, the eye sways slowly within the array, so that one sees that there is something to look around.

import type { Mover } from "./loop";
import { type Mode, reducedMotion } from "./mode";
import type { Session } from "./session";

const PERIOD = 9; // seconds there and back
const TIMES = 7; // after which the eye rests: a page that is left open draws nothing
const WIDE = 0.1; // parts of the canvas's smaller side, as if a hand dragged it
const HIGH = 0.03;

export interface Sway extends Mover {
  /** Nobody has moved or set anything yet. */
  untouched(): boolean;
  /** It stops where it is: a hand lies on the picture. */
  stop(): void;
  /** It stops, and the first view is back: somebody wants a picture that is still. */
  settle(): void;
  /** Somebody moves or sets something. */
  end(): void;
}

/** wanted: the page shows its own first view. mode: what is moved. home: to the first view. coarse: too slow to sway. */
export function createSway(
  session: Session,
  wanted: boolean,
  mode: () => Mode | null,
  home: () => void,
  coarse: () => boolean,
): Sway {
  let untouched = wanted;
  let stopped = !wanted;
  let time = 0;
  let swayed: unknown = null; // the scene
  const offset = (): [number, number] => {
    const angle = (2 * Math.PI * time) / PERIOD;
    return [WIDE * Math.sin(angle), HIGH * Math.sin(2 * angle)];
  };
  const settle = (): void => {
    if (!stopped && time > 0) home();
    stopped = true;
  };

  return {
    untouched: () => untouched,
    step: (seconds) => {
      const { scene } = session;
      if (stopped || !scene?.field || session.status !== "ready" || session.arriving) return false;
      swayed ??= scene;
      if (swayed !== scene || reducedMotion()) stopped = true;
      else if (coarse() || time >= TIMES * PERIOD) settle();
      if (stopped) return false;
      const [x, y] = offset();
      time += seconds;
      const [nextX, nextY] = offset();
      mode()?.drag(x - nextX, nextY - y, false);
      return true;
    },
    stop: () => void (stopped = true),
    settle,
    end: () => {
      stopped = true;
      untouched = false;
    },
  };
}
