// The keyboard. Keys that are held move; the others act once.

import { keyOf } from "./keys";
import type { Push } from "./mode";
import type { Options } from "./options";
import type { Viewer } from "./viewer";

type Axis = readonly [keyof Push, number];

const HELD: Readonly<Record<string, Axis>> = {
  ArrowLeft: ["x", -1], KeyA: ["x", -1],
  ArrowRight: ["x", 1], KeyD: ["x", 1],
  ArrowUp: ["y", 1], KeyW: ["y", 1],
  ArrowDown: ["y", -1], KeyS: ["y", -1],
  KeyE: ["closer", 1], KeyQ: ["closer", -1],
  KeyR: ["forward", 1], KeyF: ["forward", -1],
};

const PLAIN: readonly string[] = ["0", "home", "escape"]; // keys of pages without a laboratory
const REPEATED: readonly string[] = ["[", "]", "-", "+", "=", ",", "."]; // while they are held

export interface Actions {
  /** Panel, map and tools are not shown. */
  plain(): boolean;
  help(): void;
  panel(): void;
  divide(): void;
  screenshot(): void;
}

export interface Keys {
  /** What the held keys ask for now; null for nothing. */
  wish(): Push | null;
}

export function listenToKeys(viewer: Viewer, actions: Actions): Keys {
  const held = new Set<string>();
  const once = (key: string): (() => void) | undefined => {
    const { view, count, weights, wireframe } = viewer.options();
    const field = viewer.scene()?.field;
    const show = (next: Options["view"]) => () => viewer.set({ view: next === view ? "picture" : next });
    const sum = (step: number) => () =>
      viewer.set({ count: Math.min(Math.max(Math.min(count, field?.total ?? 0) + step, 0), field?.total ?? 0) });
    const table: Record<string, () => void> = {
      o: () => viewer.setMode(viewer.modeName() === "plane" ? "orbit" : "plane"),
      "[": () => viewer.nextCamera(-1),
      "]": () => viewer.nextCamera(1),
      n: viewer.nearestCamera,
      " ": () => viewer.showPhotograph(!viewer.photographShown()),
      b: actions.divide,
      "1": () => viewer.set({ view: "picture" }),
      "2": show("mean"),
      "3": show("eigen"),
      "4": show("error"),
      "-": sum(-1),
      "+": sum(1),
      "=": sum(1),
      t: () => viewer.set({ weights: weights === "ray" ? "eye" : "ray" }),
      m: () => viewer.set({ wireframe: !wireframe }),
      "0": viewer.home,
      home: viewer.home,
      escape: () => {
        if (viewer.captured() !== null) viewer.moving();
        else if (viewer.modeName() === "orbit") viewer.comeBack();
      },
      p: actions.screenshot,
      i: actions.panel,
      h: actions.help,
      "?": actions.help,
    };
    return table[key];
  };

  /** Keys of a clip, which go before the others. */
  const playing = (key: string): (() => void) | undefined => {
    const table: Record<string, () => void> = {
      " ": viewer.playOrPause,
      ",": () => viewer.step(-1),
      ".": () => viewer.step(1),
      "[": () => viewer.changeSpeed(-1),
      "]": () => viewer.changeSpeed(1),
      v: () => viewer.mute(viewer.player()?.sound?.muted === false),
    };
    return viewer.player() ? table[key] : undefined;
  };

  addEventListener("keydown", (event) => {
    const key = keyOf(event);
    if (key === "" || taken(event)) return;
    const act = playing(key) ?? (actions.plain() && !PLAIN.includes(key) ? undefined : once(key));
    if (act || HELD[event.code]) document.body.dataset["keys"] = ""; // the style sheet shows which keys do what
    if (!act && HELD[event.code]) { // a letter that acts and is printed there comes first
      event.preventDefault();
      held.add(event.code);
      viewer.request();
      return;
    }
    if (!act || (event.repeat && !REPEATED.includes(key))) return;
    event.preventDefault();
    act();
  });
  addEventListener("keyup", (event) => void held.delete(event.code));
  addEventListener("blur", () => held.clear());

  return {
    wish: () => {
      if (held.size === 0) return null;
      const push: Push = { x: 0, y: 0, closer: 0, forward: 0 };
      for (const code of held) {
        const axis = HELD[code];
        if (axis) push[axis[0]] += axis[1];
      }
      return push;
    },
  };
}

/** Keys that belong to the control that has the focus. */
function taken(event: KeyboardEvent): boolean {
  const { target, key } = event;
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog[open]")) return true;
  if (key === "Escape") return false;
  if (target.closest("[role=slider]")) return key.startsWith("Arrow");
  if (target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement) return (key === " " && target.type !== "range") || key === "Home" || key.startsWith("Arrow");
  return key === " " && target.closest("button, summary, a") !== null;
}
