// What lies over the picture: progress, messages, the cue outside the captured views, the invitation to bring a file.

import { button, element, ICONS } from "./dom";
import { bytes } from "./text";
import type { Viewer } from "./viewer";

export interface Overlays {
  readonly roots: HTMLElement[];
  update(): void;
  /** After a frame. */
  tick(): void;
  /** A file hovers over the page. */
  hover(over: boolean): void;
}

export function createOverlays(viewer: Viewer, choose: () => void): Overlays {
  const bar = element("progress", { "aria-label": "Loading" });
  const amount = element("p", {});
  const progress = element("div", { class: "progress" }, bar, amount);

  const text = element("p", {});
  const code = element("p", { class: "quiet" });
  const chooseAnother = element("button", { type: "button" }, "Choose another file");
  chooseAnother.addEventListener("click", choose);
  const dismiss = button("Dismiss", ICONS.close, viewer.dismiss);
  const message = element("div", { class: "message", role: "alert", hidden: "" }, text, code, chooseAnother, dismiss);

  const chooseFirst = element("button", { type: "button", class: "primary" }, "Choose a file");
  chooseFirst.addEventListener("click", choose);
  const invitation = element(
    "div", { class: "invitation", hidden: "" },
    element("p", { class: "large" }, "Drop a .glb here, or choose a file"),
    chooseFirst,
    element("p", { class: "quiet" }, "It stays on this machine."),
  );
  const drop = element("div", { class: "drop", hidden: "" }, element("p", { class: "large" }, "Drop to open"));

  const back = element("button", { type: "button" }, "Come back");
  back.addEventListener("click", viewer.comeBack);
  const cue = element(
    "div", { class: "cue", hidden: "", role: "status" },
    element("p", {}, "Outside the captured views", element("kbd", {}, "Esc")), back,
  );
  const tag = element("p", { class: "tag", hidden: "" });
  const title = element("p", { class: "title" });
  const hint = element("p", { class: "hint", hidden: "" }, "Drag to look around");

  const update = (): void => {
    const scene = viewer.scene();
    const field = scene?.field;
    const status = viewer.status();
    const { loaded, total } = viewer.progress();
    const loading = status === "loading" || (status === "ready" && viewer.arriving());
    progress.hidden = !loading;
    if (loading) {
      if (total === null) bar.removeAttribute("value");
      else {
        bar.max = Math.max(total, 1);
        bar.value = loaded;
      }
      const parts = [total === null ? bytes(loaded) : `${bytes(loaded)} of ${bytes(total)}`];
      if (field) parts.push(`eigen texture ${field.loaded} of ${field.usable}`);
      amount.textContent = parts.join(" · ");
    }
    const said = viewer.message();
    message.hidden = said === null;
    message.classList.toggle("small", scene !== null && status !== "lost");
    if (said && (text.textContent !== said.text || code.textContent !== (said.code ?? ""))) {
      text.textContent = said.text;
      code.textContent = said.code ?? "";
    }
    chooseAnother.hidden = status !== "failed";
    dismiss.hidden = status !== "ready";
    invitation.hidden = status !== "empty";
    title.textContent = scene?.source.name ?? viewer.config.title ?? "";
    tick();
  };
  const tick = (): void => {
    hint.hidden = !viewer.untouched() || viewer.status() !== "ready" || viewer.arriving() || viewer.message() !== null;
    const outside = viewer.outside();
    cue.hidden = !outside;
    viewer.stage.canvas.parentElement?.classList.toggle("outside", outside);
    const captured = viewer.captured();
    const name = captured === null ? undefined : viewer.scene()?.field?.info.names[captured];
    tag.hidden = name === undefined;
    if (name === undefined) return;
    const { view, eigen } = viewer.options();
    const drawn = { picture: "drawn", mean: "mean", eigen: `eigen texture ${eigen + 1}`, error: "error × 5" }[view];
    const words = `${name} · ${viewer.photographShown() ? "photograph" : drawn}`;
    if (tag.textContent !== words) tag.textContent = words;
  };
  return {
    roots: [title, tag, cue, hint, progress, message, invitation, drop],
    update,
    tick,
    hover: (over) => void (drop.hidden = !over),
  };
}
