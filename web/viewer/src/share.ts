// Buttons that copy a link to what is seen, and the HTML that shows it within another page.

import { button, element, ICONS } from "./dom";
import { words } from "./language";
import { hashOf } from "./url";
import type { Viewer } from "./viewer";

const SAID = 2500; // milliseconds
const FRAME_WIDTH = 640; // pixels
const SAID_CHARACTERS = 200; // of a title where a screen reader says it for a frame
const FRAME_FEATURES = "fullscreen; xr-spatial-tracking; gyroscope; accelerometer";

export interface Share {
  readonly link: HTMLButtonElement;
  readonly embed: HTMLButtonElement;
  /** Says what was copied. */
  readonly said: HTMLElement;
  /** Whether the page has an address that others can open. */
  readonly possible: boolean;
}

export function createShare(viewer: Viewer): Share {
  const { url } = viewer.config;
  const possible = url !== null || /^https?:$/.test(location.protocol);
  const said = element("p", { class: "said", role: "status", hidden: "" });
  let timer = 0;
  const copy = async (text: string, done: string): Promise<void> => {
    said.textContent = (await copied(text)) ? done : text;
    said.hidden = false;
    clearTimeout(timer);
    timer = window.setTimeout(() => void (said.hidden = true), SAID);
  };
  const address = (): URL => new URL(hashOf(viewer), url ?? location.href);
  return {
    link: button(words("share"), ICONS.share, () => void copy(address().href, words("linkCopied"))),
    embed: button(words("copyEmbed"), ICONS.embed, () => void copy(frameOf(viewer, address()), words("embedCopied"))),
    said,
    possible,
  };
}

/** The HTML that shows the view in a frame of the photographs' shape: the page for guests, whatever this one is. */
function frameOf(viewer: Viewer, address: URL): string {
  if (viewer.config.ui === "full") address.searchParams.set("ui", "plain");
  const { source, field } = viewer.scene() ?? {};
  const view = field?.info.cameras[field.info.reference];
  const height = Math.round(FRAME_WIDTH * (view ? view.height / view.width : 3 / 4));
  const [src, title] = [address.href, source?.name.slice(0, SAID_CHARACTERS) ?? ""].map(escaped);
  const size = `width="${FRAME_WIDTH}" height="${height}"`;
  return `<iframe src="${src}" title="${title}" ${size} style="border: 0" allow="${FRAME_FEATURES}"></iframe>`;
}

/** A text within the quotes of an attribute. */
const escaped = (text: string): string =>
  text.replaceAll("&", "&amp;").replaceAll('"', "&quot;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");

/** Whether a text is in the clipboard now. Pages without https, and many within another one, may only copy a selection. */
async function copied(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const field = element("textarea", { readonly: "", class: "copied" });
    field.value = text;
    const before = document.activeElement;
    document.body.append(field);
    field.select();
    const done = document.execCommand("copy");
    field.remove();
    if (before instanceof HTMLElement) before.focus();
    return done;
  }
}
