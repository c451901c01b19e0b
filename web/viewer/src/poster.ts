// A picture of the scene that is shown until the scene itself is there.

import { element } from "./dom";

/** When the poster within the page is on the screen: starting WebGL would keep it from being drawn. Null without one. */
export function posterShown(page: Document): Promise<unknown> | null {
  const own = page.querySelector<HTMLImageElement>("img.poster");
  if (!own || page.hidden) return null;
  const drawn = (done: (value: unknown) => void): void => void requestAnimationFrame(() => setTimeout(done));
  return own.decode().catch(() => undefined).then(() => new Promise(drawn));
}

/** The one within the page, or one at the address that is asked for; null where there is neither. */
export function takePoster(page: Document, asked: string | null): HTMLImageElement | null {
  const own = page.querySelector<HTMLImageElement>("img.poster");
  if (own) return own;
  return asked === null || asked === "" ? null : element("img", { class: "poster", src: asked, alt: "" });
}
