// What keeps the page and its scenes for times without a network: the service worker, public/worker.js.

const CACHE = "eigenfield"; // the worker's

/** Starts the worker. opened: what the scene was fetched from, once it is there, if it is a URL. */
export function keepOffline(worker: string, opened: Promise<string | Blob | undefined> | undefined): void {
  const { serviceWorker } = navigator;
  if (!serviceWorker) return; // no https
  const scope = serviceWorker.controller && new URL(".", new URL(worker, location.href)).href;
  serviceWorker.register(worker).catch(() => undefined);
  const keep = async (from: string): Promise<void> => {
    const { href, origin } = new URL(from, location.href);
    if (origin !== location.origin || (scope !== null && href.startsWith(scope))) return; // the worker saw it come
    const cache = await caches.open(CACHE);
    await cache.add(new Request(href, { cache: "force-cache" })); // which the browser has still
  };
  void opened?.then((from) => (typeof from === "string" ? keep(from) : undefined)).catch(() => undefined); // no room
}
