// The policy of a page that opens files. It is written before anybody has typed an address, and so it allows any host:
// here it is narrowed, before a scene is read.

const NARROW = "connect-src 'self' blob: data:";
const IMAGES = "img-src 'self' blob: data:";
const SERVER = /^https?:\/\/[\w.-]+(:\d+)?$/; // what a policy takes as one

/** From now on a page that has a policy asks no other host, whatever a scene holds. `scene`: its address, whose server is
 * still asked: it has the rest of a clip. */
export function confine(page: Document, scene: string | Blob = ""): void {
  const policies = page.querySelectorAll<HTMLMetaElement>('meta[http-equiv="Content-Security-Policy"]');
  if (policies.length === 0 || [...policies].some(({ content }) => content.startsWith(NARROW))) return;
  const meta = page.createElement("meta");
  meta.httpEquiv = "Content-Security-Policy";
  const { origin = "" } = (typeof scene === "string" && addressOf(scene)) || {};
  meta.content = `${NARROW}${SERVER.test(origin) ? ` ${origin}` : ""}; ${IMAGES}`;
  page.head.append(meta);
}

/** Whether one of the addresses is of another host, to which a request may go before the page is confined. */
export function leadElsewhere(addresses: readonly (string | null)[]): boolean {
  return addresses.some((address) => (addressOf(address ?? "") ?? location).origin !== location.origin);
}

/** Where an address leads; null: it is none. */
export function addressOf(text: string): URL | null {
  try {
    return new URL(text, location.href);
  } catch {
    return null;
  }
}
