// What lies over the picture: progress, messages, the cue outside the captured views, the invitation to bring a file.

import type { Sample } from "./config";
import { button, element, ICONS, keyCaps } from "./dom";
import { words } from "./language";
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
  const bar = element("progress", { "aria-label": words("loading") });
  const amount = element("p", {});
  const progress = element("div", { class: "progress" }, bar, amount);

  const text = element("p", {});
  const code = element("p", { class: "quiet" });
  const chooseAnother = element("button", { type: "button" }, words("chooseAnother"));
  chooseAnother.addEventListener("click", choose);
  const dismiss = button(words("dismiss"), ICONS.close, viewer.dismiss);
  const message = element("div", { class: "message", role: "alert", hidden: "" }, text, code, chooseAnother, dismiss);

  const chooseFirst = element("button", { type: "button", class: "primary" }, words("chooseFile"));
  chooseFirst.addEventListener("click", choose);
  const invitation = element(
    "div", { class: "invitation", hidden: "" },
    element("p", { class: "large" }, words("dropHere")),
    chooseFirst,
    element("p", { class: "quiet" }, words("staysHere")),
    ...(viewer.config.samples.length > 0 ? [sampleLinks(viewer.config.samples)] : []),
  );
  const scale = errorScale();
  const drop = element("div", { class: "drop", hidden: "" }, element("p", { class: "large" }, words("dropToOpen")));

  const back = element("button", { type: "button" }, words("comeBack"));
  back.addEventListener("click", viewer.comeBack);
  const cue = element(
    "div", { class: "cue", hidden: "", role: "status" },
    element("p", {}, words("outside"), keyCaps(words("keyEscape"))), back,
  );
  const tag = element("p", { class: "tag", hidden: "" });
  const titleText = element("span");
  const credit = element("small", {});
  const title = element("p", { class: "title" }, titleText, credit);
  const hint = element("p", { class: "hint", hidden: "" }, words("hint"));

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
      const parts = [total === null ? bytes(loaded) : words("outOf", { part: bytes(loaded), whole: bytes(total) })];
      if (field) parts.push(words("textureOf", { part: field.loaded, whole: field.usable }));
      amount.textContent = parts.join(" · ");
    }
    const said = viewer.message();
    message.hidden = said === null;
    message.classList.toggle("small", scene !== null && status !== "lost");
    const about = [said?.code, said?.detail].filter(Boolean).join(" · ");
    if (said && (text.textContent !== said.text || code.textContent !== about)) {
      text.textContent = said.text;
      code.textContent = about;
    }
    chooseAnother.hidden = status !== "failed";
    dismiss.hidden = status !== "ready";
    invitation.hidden = status !== "empty";
    titleText.textContent = scene?.source.name ?? viewer.config.title ?? "";
    const { author = "", licence = "" } = field?.info.rights ?? {};
    credit.textContent = [author, licence].filter(Boolean).join(" · ");
    title.hidden = titleText.textContent === "" && credit.textContent === "";
    tick();
  };
  const tick = (): void => {
    hint.hidden = !viewer.untouched() || viewer.status() !== "ready" || viewer.arriving() || viewer.message() !== null;
    const outside = viewer.outside();
    cue.hidden = !outside;
    viewer.stage.canvas.parentElement?.classList.toggle("outside", outside);
    scale.hidden = viewer.options().view !== "error" || !viewer.hasPhotograph();
    const captured = viewer.captured();
    const name = captured === null ? undefined : viewer.scene()?.field?.info.names[captured];
    tag.hidden = name === undefined;
    if (name === undefined) return;
    const { view, eigen } = viewer.options();
    const drawn = {
      picture: words("drawn"), mean: words("mean"), eigen: words("eigenNumber", { number: eigen + 1 }),
      error: words("errorTimes"),
    }[view];
    const shown = `${name} · ${viewer.photographShown() ? words("photograph") : drawn}`;
    if (tag.textContent !== shown) tag.textContent = shown;
  };
  return {
    roots: [title, tag, cue, hint, scale, progress, message, invitation, drop],
    update,
    tick,
    hover: (over) => void (drop.hidden = !over),
  };
}

/** What the colours of the error mean: `heat` of the plug-in's material, of five times the error. */
function errorScale(): HTMLElement {
  const marks = [0, 1, 2, 3].map((part) => element("span", {}, String((part * 255) / 5 / 3)));
  return element(
    "div", { class: "scale", hidden: "" },
    element("div", { class: "heat" }), element("p", { class: "marks" }, ...marks), element("p", {}, words("greyLevels")),
  );
}

/** Links that name a scene by the page's own address, so that they can be kept and sent. */
function sampleLinks(samples: readonly Sample[]): HTMLElement {
  const links = samples.map(({ name, url, bytes: size, picture }) => {
    const query = new URLSearchParams(location.search);
    query.set("load", url);
    const amount = size === null ? [] : [element("span", { class: "quiet" }, bytes(size))];
    const shown = picture === null ? [] : [element("img", { src: picture, alt: "", loading: "lazy" })];
    return element("li", {}, element("a", { href: `?${query}` }, ...shown, name, ...amount));
  });
  return element("section", {}, element("h2", {}, words("samples")), element("ul", {}, ...links));
}
