// All controls in one dialogue.

import { element } from "./dom";
import { keyOf } from "./keys";
import { words } from "./language";

/** Keys and hands, what they do, and how the same is done where there is only touch. */
const CONTROLS: readonly (readonly [keys: string, does: string, touch?: string])[] = [
  [words("byDrag"), words("doesMove"), words("byFinger")],
  [words("byArrows"), words("doesSteps")],
  [words("byWheel"), words("doesZoom"), words("byPinch")],
  [words("byShiftWheel"), words("doesDolly")],
  [words("byRightDrag"), words("doesShift"), words("byTwoFingers")],
  [words("byDoubleClick"), words("doesTurnAbout"), words("byDoubleTap")],
  [words("byMap"), words("doesMap"), words("byMap")],
  ["O", words("doesOrbit")],
  ["[ ]", words("doesCameras")],
  ["N", words("doesNearest")],
  [words("keySpace"), words("doesFlip")],
  [`${words("keySpace")} · , · .`, words("doesPlay")],
  ["[ ]", words("doesSpeed")],
  ["V", words("doesSound")],
  ["B", words("doesDivide")],
  ["1 2 3 4", words("doesViews")],
  ["− +", words("doesCount")],
  ["T", words("doesWeights")],
  ["M", words("doesWireframe")],
  [`${words("keyHome")} · 0`, words("doesHome")],
  [words("keyEscape"), words("doesBack")],
  ["P", words("doesSave")],
  [words("byTilt"), words("doesTilt"), words("byTilt")],
  ["I", words("doesPanel")],
  ["H · ?", words("doesHelp")],
  [words("byGamepad"), words("doesGamepad")],
  [words("byGamepad"), words("doesGamepadClip")],
  [words("byHeadset"), words("doesHeadset")],
];

export interface Help {
  readonly root: HTMLDialogElement;
  toggle(): void;
}

export function createHelp(version: string | null): Help {
  const heading = element("h2", { tabindex: "-1" }, words("controls"));
  const list = element("dl");
  const touchOnly = matchMedia("(hover: none)").matches;
  for (const [keys, does, touch] of CONTROLS) {
    if (touchOnly && touch === undefined) continue;
    list.append(element("dt", {}, touchOnly ? (touch ?? keys) : keys), element("dd", {}, does));
  }
  const close = element("button", { type: "submit" }, words("close"));
  const form = element("form", { method: "dialog" }, close);
  const program = version === null ? "eigenfield" : `eigenfield ${version}`;
  const root = element(
    "dialog",
    { class: "help", "aria-label": words("controls") },
    heading, list, element("p", { class: "quiet" }, words("about", { program })), form,
  );
  root.addEventListener("click", (event) => {
    if (event.target === root) root.close(); // beside the sheet
  });
  root.addEventListener("keydown", (event) => {
    if (!root.open || !["h", "?"].includes(keyOf(event))) return; // closed, it keeps the focus for a moment
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
