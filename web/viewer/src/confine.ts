// The policy of a page that opens files. It is written before anybody has typed an address, and so it allows any host:
// here it is narrowed, before a scene is read.

const NARROW = "connect-src 'self' blob: data:; img-src 'self' blob: data:";

/** From now on a page that has a policy asks no other host, whatever a scene holds. */
export function confine(page: Document): void {
  const policies = page.querySelectorAll<HTMLMetaElement>('meta[http-equiv="Content-Security-Policy"]');
  if (policies.length === 0 || [...policies].some(({ content }) => content === NARROW)) return;
  const meta = page.createElement("meta");
  meta.httpEquiv = "Content-Security-Policy";
  meta.content = NARROW;
  page.head.append(meta);
}

/** Whether one of the addresses is of another host, to which a request may go before the page is confined. */
export function leadElsewhere(addresses: readonly (string | null)[]): boolean {
  return addresses.some((address) => {
    try {
      return new URL(address ?? "", location.href).origin !== location.origin;
    } catch {
      return false; // no address at all
    }
  });
}
