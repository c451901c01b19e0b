// All controls in one dialogue.

import { element } from "./dom";

const CONTROLS: readonly (readonly [string, string])[] = [
  ["Drag · one finger", "move the head within the captured array; around a point in orbit"],
  ["Arrow keys · W A S D", "the same, step by step"],
  ["Wheel · pinch · Q E", "smaller, larger"],
  ["Shift + wheel · R F", "forward and back, off the view plane"],
  ["Right drag · two fingers", "in orbit: shift"],
  ["Double click", "in orbit: turn about that point of the surface"],
  ["Map", "go to that place; dots are cameras"],
  ["O", "orbit, and back to the view plane"],
  ["[ ]", "previous, next captured camera"],
  ["Space", "flip between drawn view and photograph"],
  ["1 2 3 4", "picture, mean only, single eigen texture, error × 5"],
  ["− +", "fewer, more eigen textures"],
  ["T", "weights for each ray, or for the eye"],
  ["M", "wireframe"],
  ["Home · 0", "the first view"],
  ["Escape", "back inside the captured views"],
  ["P", "save the picture"],
  ["I", "show or hide the panel"],
  ["H · ?", "this list"],
  ["Gamepad", "sticks move; bumpers change camera; A flips; B goes home"],
];

export interface Help {
  readonly root: HTMLDialogElement;
  toggle(): void;
}

export function createHelp(version: string | null): Help {
  const list = element("dl");
  for (const [keys, does] of CONTROLS) list.append(element("dt", {}, keys), element("dd", {}, does));
  const close = element("button", { type: "submit" }, "Close");
  const form = element("form", { method: "dialog" }, close);
  const program = version === null ? "eigenfield" : `eigenfield ${version}`;
  const about = `${program}. Files stay on this machine: the page sends nothing.`;
  const root = element(
    "dialog",
    { class: "help", "aria-label": "Controls" },
    element("h2", {}, "Controls"), list, element("p", { class: "quiet" }, about), form,
  );
  root.addEventListener("click", (event) => {
    if (event.target === root) root.close(); // beside the sheet
  });
  return { root, toggle: () => (root.open ? root.close() : root.showModal()) };
}
