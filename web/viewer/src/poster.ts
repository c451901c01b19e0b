// A picture of the scene that is shown until the scene itself is there.

import { element } from "./dom";

/** The one within the page, or one at the address that is asked for; null where there is neither. */
export function takePoster(page: Document, asked: string | null): HTMLImageElement | null {
  const own = page.querySelector<HTMLImageElement>("img.poster");
  if (own) return own;
  return asked === null || asked === "" ? null : element("img", { class: "poster", src: asked, alt: "" });
}
