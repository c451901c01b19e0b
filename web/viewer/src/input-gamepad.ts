// A gamepad: sticks move, bumpers change the camera, and a clip is played with what else is at hand. It is asked only
// while one is there.

import type { Push } from "./mode";
import { SKIP } from "./playback";
import type { Viewer } from "./viewer";

const DEAD = 0.14; // a resting stick is never quite at rest
const A = 0;
const B = 1;
const LEFT = 4;
const RIGHT = 5;
const [LEFT_TRIGGER, RIGHT_TRIGGER] = [6, 7];
const [CROSS_LEFT, CROSS_RIGHT] = [14, 15];

export interface Gamepads {
  wish(): Push | null;
}

export function listenToGamepads(viewer: Viewer): Gamepads {
  let wish: Push | null = null;
  let asking = false;
  let pressed = new Set<number>();

  const ask = (): void => {
    const pads = navigator.getGamepads().filter((pad) => pad !== null);
    asking = pads.length > 0;
    if (!asking) {
      wish = null;
      return;
    }
    const axis = (index: number): number => {
      const value = pads.reduce((sum, pad) => sum + (pad.axes[index] ?? 0), 0);
      return Math.abs(value) < DEAD ? 0 : Math.min(Math.max(value, -1), 1);
    };
    const push = { x: axis(0), y: -axis(1) || 0, closer: -axis(3) || 0, forward: 0 };
    wish = push.x !== 0 || push.y !== 0 || push.closer !== 0 ? push : null;
    if (wish) viewer.request();

    const now = new Set(pads.flatMap((pad) => pad.buttons.flatMap((one, index) => (one.pressed ? [index] : []))));
    const fresh = (index: number): boolean => now.has(index) && !pressed.has(index);
    if (fresh(LEFT)) viewer.nextCamera(-1);
    if (fresh(RIGHT)) viewer.nextCamera(1);
    if (fresh(B)) viewer.home();
    if (viewer.player()) {
      if (fresh(A)) viewer.playOrPause();
      if (fresh(CROSS_LEFT)) viewer.step(-1);
      if (fresh(CROSS_RIGHT)) viewer.step(1);
      if (fresh(LEFT_TRIGGER)) viewer.skip(-SKIP);
      if (fresh(RIGHT_TRIGGER)) viewer.skip(SKIP);
    } else if (fresh(A)) viewer.showPhotograph(!viewer.photographShown());
    pressed = now;
    requestAnimationFrame(ask); // looks at the sticks; nothing is drawn
  };
  addEventListener("gamepadconnected", () => {
    if (!asking) ask();
  });
  return { wish: () => wish };
}
