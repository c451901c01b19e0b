// Leaning the device moves the eye on the view plane, from however it was held when tilting was switched on.

import { words } from "./language";
import type { Viewer } from "./viewer";

const REACH = 18; // degrees from the middle to the array's edge

/** Safari asks the person, and only on a tap. */
interface Asking {
  requestPermission?(): Promise<"granted" | "denied">;
}

export interface Tilt {
  readonly possible: boolean;
  on(): boolean;
  toggle(): Promise<void>;
}

export function createTilt(viewer: Viewer, changed: () => void): Tilt {
  let on = false;
  let start: { across: number; down: number; x: number; y: number } | null = null;
  let aim: { x: number; y: number } | null = null; // where it leads

  const lean = (event: DeviceOrientationEvent): void => {
    if (event.beta === null || event.gamma === null) return;
    const turn = ((screen.orientation?.angle ?? 0) * Math.PI) / 180;
    const across = event.gamma * Math.cos(turn) + event.beta * Math.sin(turn);
    const down = event.beta * Math.cos(turn) - event.gamma * Math.sin(turn);
    const plane = viewer.scene()?.plane;
    if (!plane || viewer.modeName() !== "plane" || viewer.captured() !== null) {
      start = null;
      return;
    }
    const { x, y } = plane.goal();
    if (x !== aim?.x || y !== aim.y) start = null; // something else has moved the eye since
    start ??= { across, down, x, y };
    plane.goTo(start.x + (across - start.across) / REACH, start.y + (down - start.down) / REACH);
    aim = plane.goal();
    viewer.moving();
  };

  return {
    possible: typeof DeviceOrientationEvent !== "undefined" && matchMedia("(pointer: coarse)").matches,
    on: () => on,
    toggle: async () => {
      if (on) {
        removeEventListener("deviceorientation", lean);
        on = false;
      } else {
        const { requestPermission } = DeviceOrientationEvent as unknown as Asking;
        // The method must be called on its own object, or Safari refuses.
        const answer = requestPermission ? await requestPermission.call(DeviceOrientationEvent) : "granted";
        if (answer === "granted") {
          start = null;
          addEventListener("deviceorientation", lean);
          on = true;
        } else {
          viewer.say(words("tiltDenied"));
        }
      }
      changed();
    },
  };
}
