// A draft: when the scene itself comes, and the page opened anew with it.

import { element } from "./dom";
import { words } from "./language";
import { hashOf } from "./url";
import type { Viewer } from "./viewer";

const PAUSE = 2000; // milliseconds between two questions

/** A line about the draft; empty where the scene is none. */
export function createDraft(viewer: Viewer, presenting: () => boolean): HTMLElement {
  const said = element("p", { class: "draft", role: "status", hidden: "" });
  const url = viewer.config.draft;
  if (url === null) return said;
  const say = (text: string): void => {
    if (said.textContent !== text) said.textContent = text;
    said.hidden = false;
  };
  const ask = async (): Promise<void> => {
    const answer = await fetch(url, { cache: "no-store" }).catch(() => null);
    if (answer === null) {
      say(words("draftLost")); // nobody answers any longer
      return;
    }
    if (answer.status === 404 && !presenting()) {
      openAnew(viewer);
      return;
    }
    if (answer.ok) {
      const { seconds } = (await answer.json()) as { seconds: number | null };
      say(seconds === null ? words("draft") : words("draftMinutes", { minutes: Math.max(1, Math.ceil(seconds / 60)) }));
    }
    window.setTimeout(() => void ask(), PAUSE);
  };
  void ask();
  return said;
}

/** The scene stands at the same view. Where cameras are estimated its world is another than the draft's, so that a free
 * view becomes that of the nearest camera. */
function openAnew(viewer: Viewer): void {
  if (!viewer.untouched()) {
    const camera = new URLSearchParams({ camera: viewer.nearestName() ?? "", mode: viewer.modeName() });
    history.replaceState(history.state, "", viewer.modeName() === "plane" ? hashOf(viewer) : `#${camera}`);
  }
  location.reload();
}
