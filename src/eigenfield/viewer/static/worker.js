// Of the page that `eigenfield export --as app` writes: what was fetched once is there without a network, too. With one,
// everything is asked for anew, so that a page that was replaced on its server is never an old one.

const CACHE = "eigenfield";
const PAGE = ["./", "viewer.js", "viewer.css", "manifest.webmanifest", "icon.svg", "icon-192.png", "icon-512.png"];

addEventListener("install", (event) => {
  skipWaiting();
  event.waitUntil(caches.open(CACHE).then((cache) => cache.addAll(PAGE)));
});

addEventListener("activate", (event) => event.waitUntil(clients.claim()));

addEventListener("fetch", (event) => {
  const { request } = event;
  const url = new URL(request.url);
  if (request.method !== "GET" || url.origin !== location.origin) return; // another site's is not kept
  event.respondWith(answer(request, url, (work) => event.waitUntil(work)));
});

/** The page is one, whatever its address asks it to load. */
function keyOf({ origin, pathname, href }) {
  const folder = origin + pathname.replace(/index\.html$/, "");
  return folder === registration.scope ? folder : href;
}

async function answer(request, url, meanwhile) {
  const cache = await caches.open(CACHE);
  const key = keyOf(url);
  try {
    const response = await fetch(request);
    const own = url.href.startsWith(registration.scope); // beside it, the page keeps what it draws
    if (own && response.status === 200) meanwhile(cache.put(key, response.clone()).catch(() => undefined));
    return response;
  } catch (error) {
    const kept = await cache.match(key);
    if (!kept) throw error;
    return kept;
  }
}
