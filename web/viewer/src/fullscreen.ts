// The whole page on the whole screen, where the browser and the page around it allow that.

import { button, ICONS } from "./dom";
import { words } from "./language";

export function createFullscreen(): HTMLButtonElement {
  const root = button(words("fullScreen"), ICONS.fullscreen, () => {
    if (document.fullscreenElement) void document.exitFullscreen();
    else void document.documentElement.requestFullscreen();
  });
  root.hidden = !document.fullscreenEnabled;
  document.addEventListener("fullscreenchange", () => {
    root.setAttribute("aria-pressed", String(document.fullscreenElement !== null));
  });
  return root;
}
