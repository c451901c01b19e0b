// A button that copies a link to what is seen.

import { button, element, ICONS } from "./dom";
import { words } from "./language";
import { hashOf } from "./url";
import type { Viewer } from "./viewer";

const SAID = 2500; // milliseconds

export interface Share {
  readonly root: HTMLButtonElement;
  /** Says that the link was copied. */
  readonly said: HTMLElement;
  /** Whether the page has an address that others can open. */
  readonly possible: boolean;
}

export function createShare(viewer: Viewer): Share {
  const { url } = viewer.config;
  const possible = url !== null || /^https?:$/.test(location.protocol);
  const said = element("p", { class: "said", role: "status", hidden: "" });
  let timer = 0;
  const copy = async (): Promise<void> => {
    const link = new URL(hashOf(viewer), url ?? location.href).href;
    said.textContent = (await copied(link)) ? words("linkCopied") : link;
    said.hidden = false;
    clearTimeout(timer);
    timer = window.setTimeout(() => void (said.hidden = true), SAID);
  };
  const root = button(words("share"), ICONS.share, () => void copy());
  return { root, said, possible };
}

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
