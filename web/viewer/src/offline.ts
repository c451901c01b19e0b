// What keeps the page and its scenes for times without a network: the service worker, public/worker.js.

const CACHE = "eigenfield"; // the worker's

/** Starts the worker. opened: what the scene was fetched from, once it is there, if it is a URL. */
export function keepOffline(worker: string, opened: Promise<string | Blob | undefined> | undefined): void {
  const { serviceWorker } = navigator;
  if (!serviceWorker) return; // no https
  const seen = serviceWorker.controller !== null; // it saw the scene come
  serviceWorker.register(worker).catch(() => undefined);
  void opened?.then(async (from) => {
    if (seen || typeof from !== "string" || new URL(from, location.href).origin !== location.origin) return;
    const cache = await caches.open(CACHE);
    await cache.add(new Request(from, { cache: "force-cache" })); // the browser has it still: nothing is asked for twice
  }).catch(() => undefined); // no room: not kept
}
