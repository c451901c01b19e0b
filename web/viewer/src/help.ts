// All controls in one dialogue.

import { element } from "./dom";

/** Keys and hands, what they do, and how the same is done where there is only touch. */
const CONTROLS: readonly (readonly [keys: string, does: string, touch?: string])[] = [
  ["Drag · one finger", "move the head within the captured array; around a point in orbit", "One finger"],
  ["Arrow keys · W A S D", "the same, step by step"],
  ["Wheel · pinch · Q E", "smaller, larger", "Pinch"],
  ["Shift + wheel · R F", "forward and back, off the view plane"],
  ["Right drag · two fingers", "in orbit: shift", "Two fingers"],
  ["Double click", "in orbit: turn about that point of the surface", "Double tap"],
  ["Map", "go to that place; dots are cameras", "Map"],
  ["O", "orbit, and back to the view plane"],
  ["[ ]", "previous, next captured camera"],
  ["N", "the captured camera nearest to the eye"],
  ["Space", "flip between drawn view and photograph"],
  ["1 2 3 4", "picture, mean only, single eigen texture, error × 5"],
  ["− +", "fewer, more eigen textures"],
  ["T", "weights for each ray, or for the eye"],
  ["M", "wireframe"],
  ["Home · 0", "the first view"],
  ["Escape", "back inside the captured views"],
  ["P", "save the picture"],
  ["Tilt button", "move by tilting the device", "Tilt button"],
  ["I", "show or hide the panel"],
  ["H · ?", "this list"],
  ["Gamepad", "sticks move; bumpers change camera; A flips; B goes home"],
];

export interface Help {
  readonly root: HTMLDialogElement;
  toggle(): void;
}

export function createHelp(version: string | null): Help {
  const heading = element("h2", { tabindex: "-1" }, "Controls");
  const list = element("dl");
  const touchOnly = matchMedia("(hover: none)").matches;
  for (const [keys, does, touch] of CONTROLS) {
    if (touchOnly && touch === undefined) continue;
    list.append(element("dt", {}, touchOnly ? (touch ?? keys) : keys), element("dd", {}, does));
  }
  const close = element("button", { type: "submit" }, "Close");
  const form = element("form", { method: "dialog" }, close);
  const program = version === null ? "eigenfield" : `eigenfield ${version}`;
  const about = `${program}. Files stay on this machine: the page sends nothing.`;
  const root = element(
    "dialog",
    { class: "help", "aria-label": "Controls" },
    heading, list, element("p", { class: "quiet" }, about), form,
  );
  root.addEventListener("click", (event) => {
    if (event.target === root) root.close(); // beside the sheet
  });
  root.addEventListener("keydown", (event) => {
    if (!root.open || !["h", "?"].includes(event.key.toLowerCase())) return; // closed, it keeps the focus for a moment
    event.stopPropagation(); // the page would open it again
    root.close();
  });
  return {
    root,
    toggle: () => {
      if (root.open) return root.close();
      root.showModal();
      heading.focus(); // else the browser scrolls down to the button
    },
  };
}
