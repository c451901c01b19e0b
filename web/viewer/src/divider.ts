// The line between the drawing, left of it, and the photograph or a second scene: a hand or the arrow keys move it.

import { element } from "./dom";
import { words } from "./language";
import { clamp } from "./mode";
import type { Viewer } from "./viewer";

const STEP = 0.02; // of the picture's width, a key

export interface Divider {
  readonly root: HTMLElement;
  /** After a frame: to where the picture lies. */
  tick(): void;
}

export function createDivider(viewer: Viewer): Divider {
  const root = element("div", {
    class: "divider", role: "slider", tabindex: "0", hidden: "", "aria-valuemin": "0",
    "aria-valuemax": "100",
  });
  const set = (part: number): void => viewer.set({ divider: clamp(part, 0, 1) });
  root.addEventListener("pointerdown", (event) => root.setPointerCapture(event.pointerId));
  root.addEventListener("pointermove", (event) => {
    const stage = root.parentElement?.getBoundingClientRect();
    if (!stage || !root.hasPointerCapture(event.pointerId)) return;
    const { left, width } = viewer.frame();
    set(((event.clientX - stage.left) / stage.width - left) / width);
  });
  root.addEventListener("keydown", ({ key }) => {
    const { divider } = viewer.options();
    const by = { ArrowLeft: -STEP, ArrowRight: STEP }[key];
    if (by !== undefined && divider !== null) set(divider + by);
  });
  return {
    root,
    tick: () => {
      const { divider } = viewer.options();
      const second = viewer.beside() !== null && !viewer.photographShown();
      root.hidden = divider === null || !(viewer.photographShown() || viewer.beside()?.scene);
      root.classList.toggle("scenes", second);
      root.setAttribute("aria-label", words(second ? "dividerScenes" : "divider"));
      if (divider === null) return;
      const { left, top, width, height } = viewer.frame();
      const percent = (part: number): string => `${(100 * part).toFixed(3)}%`;
      Object.assign(root.style, { left: percent(left + divider * width), top: percent(top), height: percent(height) });
      root.setAttribute("aria-valuenow", (100 * divider).toFixed(0));
    },
  };
}
