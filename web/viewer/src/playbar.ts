// Below the picture of a clip: plays, and says where it is. Without words, but for screen readers.

import { button, element, icon, ICONS, keyCaps } from "./dom";
import { words } from "./language";
import { shown } from "./text";
import type { Viewer } from "./viewer";

export interface Playbar {
  readonly root: HTMLElement;
  update(): void;
  /** After a frame. */
  tick(): void;
}

export function createPlaybar(viewer: Viewer): Playbar {
  const play = button(words("play"), ICONS.play, viewer.playOrPause);
  const place = element("input", { type: "range", min: "0", max: "0", step: "1", "aria-label": words("time") });
  let held = false; // the knob is where the hand has it
  place.addEventListener("input", () => {
    held = true;
    viewer.scrub(Number(place.value));
  });
  for (const end of ["change", "pointerup", "pointercancel", "blur"]) { // no change where it ends as it began
    place.addEventListener(end, () => {
      held = false;
      viewer.letGo();
    });
  }
  const time = element("output", { class: "figures", "aria-hidden": "true" });
  const speed = element("button", { type: "button", class: "speed figures" });
  speed.addEventListener("click", () => viewer.changeSpeed(1, true));
  const loop = button(words("repeat"), ICONS.loop, () => viewer.setLoop(viewer.player()?.loop === false));
  const sound = button(words("sound"), ICONS.sound, () => viewer.mute(viewer.player()?.sound?.muted === false));
  const root = element("div", { class: "playbar", role: "group", "aria-label": words("playback") }, play, place, time, speed, sound, loop);

  const tick = (): void => {
    const player = viewer.player();
    if (!player) return;
    const at = held ? player.sought : player.frame;
    const now = shown(player.first + at / player.rate, 2, "\u00a0s");
    place.value = String(at);
    place.style.setProperty("--part", `${(100 * at) / Math.max(player.frames - 1, 1)}%`);
    place.setAttribute("aria-valuetext", now);
    time.textContent = now;
  };
  return {
    root,
    tick,
    update: () => {
      const player = viewer.player();
      root.hidden = player === null;
      document.body.toggleAttribute("data-clip", player !== null);
      if (!player) return;
      const label = words(player.playing ? "pause" : "play");
      play.replaceChildren(icon(player.playing ? ICONS.pause : ICONS.play), keyCaps(words("keySpace")));
      play.title = label;
      play.setAttribute("aria-label", label);
      place.max = String(player.frames - 1);
      const digits = String(player.speed).split(".")[1]?.length ?? 0;
      const rate = shown(player.speed, digits, "×");
      speed.textContent = rate;
      speed.title = words("speed");
      speed.setAttribute("aria-label", `${words("speed")} ${rate}`);
      const heard = player.sound?.playable === true && !player.sound.muted;
      sound.hidden = player.sound === null;
      sound.disabled = player.sound?.playable === false;
      sound.title = words(sound.disabled ? "noSound" : "sound");
      sound.replaceChildren(icon(heard ? ICONS.sound : ICONS.muted), keyCaps("V"));
      sound.setAttribute("aria-pressed", String(heard));
      loop.setAttribute("aria-pressed", String(player.loop));
      tick();
    },
  };
}
