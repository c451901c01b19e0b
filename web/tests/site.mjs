// The built site in Chromium: tests/test_site.py names its folder in EIGENFIELD_SITE and runs this.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, openPage, serve } from "./harness.mjs";
import { AXE, PAGES, SITE } from "./site-pages.mjs";

const FIRST_PICTURE_MS = 1000;
const FIRST_PAGE_BYTES = 1_200_000;
/** Their tables fit a phone. Others, of figures, move within their own frames. */
const WITHOUT_WIDE_TABLES = ["capture-formats", "captures", "coding", "install", "measures", "time", "usage"].map((name) => `${name}.html`);

let browser;
let site;
before(async () => {
  browser = await launch();
  site = await serve({ folders: [SITE] });
});
after(async () => {
  await browser.close();
  await site.close();
});

const open = (path, options = {}) =>
  openPage(browser, null, { width: 1280, height: 800, ...options, context: { reducedMotion: "reduce", ...options.context } }).then(
    async (opened) => {
      await opened.page.goto(`${site.url}/${path}`, { waitUntil: "domcontentloaded" });
      return opened;
    },
  );

test("the first page: a picture within a second, few bytes, nobody else asked, a scene that turns", async (context) => {
  const times = [];
  let bytes = 0;
  for (let i = 0; i < 3; i++) {
    const { page, close } = await open("index.html");
    times.push(
      await page.evaluate(
        () =>
          new Promise((resolve) => {
            const look = (list) => {
              const shown = list.getEntries().find((entry) => entry.url.endsWith("/scene.jpg"));
              if (shown) resolve(shown.startTime);
            };
            new PerformanceObserver(look).observe({ type: "largest-contentful-paint", buffered: true });
          }),
      ),
    );
    await close();
  }
  context.diagnostic(`first picture after ${times.map((time) => time.toFixed(0)).join(", ")} ms`);
  assert.ok(Math.min(...times) < FIRST_PICTURE_MS);

  const { page, close } = await openPage(browser, null, { width: 1280, height: 800, context: { reducedMotion: "reduce" } });
  const hosts = new Set();
  page.on("request", (request) => hosts.add(new URL(request.url()).origin));
  page.on("response", (response) => (bytes += Number(response.headers()["content-length"] ?? 0)));
  await page.goto(`${site.url}/index.html`);
  const isScene = (one) => one.url().endsWith("/scene.html");
  const frame = page.frames().find(isScene) ?? (await page.waitForEvent("framenavigated", isScene));
  await frame.waitForFunction(() => window.eigenfield?.state().status === "ready");
  context.diagnostic(`${bytes} bytes`);
  assert.ok(bytes > 600_000 && bytes < FIRST_PAGE_BYTES);
  assert.deepEqual([...hosts].filter((host) => host !== site.url && host !== "null"), []);

  const box = await page.evaluate(() => document.querySelector(".scene").getBoundingClientRect().toJSON());
  assert.ok(box.y >= 0 && box.y + box.height <= 800, "the scene is above the fold");
  const seen = () => frame.evaluate(() => window.eigenfield.state());
  const before = await seen();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2, { steps: 4 });
  await page.mouse.up();
  assert.notDeepEqual((await seen()).x, before.x);
  await close();
});

test("the clip of the first page shows its picture there, and plays when it is opened", async () => {
  const first = await open("index.html");
  const card = first.page.locator(".scenes a", { hasText: "clip" });
  await card.scrollIntoViewIfNeeded();
  await first.page.waitForFunction((image) => image.naturalWidth > 100, await card.locator("img").elementHandle());
  const path = await card.getAttribute("href");
  await first.close();
  const { page, close } = await open(path, { context: { reducedMotion: "no-preference" } });
  await page.waitForFunction(() => window.eigenfield?.field?.player?.frame > 1, undefined, { timeout: 60_000 });
  const { playing, message } = await page.evaluate(() => window.eigenfield.state());
  assert.deepEqual([playing, message], [true, null]);
  await close();
});

test("pages can be read by everybody: contrast, names, headings, keys, in light and dark, on a desk and a phone", async () => {
  assert.ok(PAGES.length > 15, `${PAGES.length} pages`);
  const found = [];
  for (const [width, colorScheme] of [[1280, "light"], [390, "dark"]]) {
    const { page, close } = await open("genindex.html", { width, height: 844, context: { colorScheme } });
    for (const path of PAGES) {
      await page.goto(`${site.url}/${path}`, { waitUntil: "domcontentloaded" });
      const wide = await page.evaluate(() => document.scrollingElement.scrollWidth - innerWidth);
      if (wide > 0) found.push(`${path} at ${width}: ${wide} pixels too wide`);
      if (WITHOUT_WIDE_TABLES.includes(path)) {
        const tables = await page.evaluate(() => [...document.querySelectorAll("article table")].map((one) => one.scrollWidth - one.parentElement.clientWidth));
        if (Math.max(...tables) > 0) found.push(`${path} at ${width}: a table is ${Math.max(...tables)} pixels too wide`);
      }
      await page.evaluate(AXE);
      const { violations } = await page.evaluate(() => axe.run({ exclude: [".sig dl"] }, { iframes: false, runOnly: ["wcag2a", "wcag2aa", "wcag21aa"], rules: { "heading-order": { enabled: true } } }));
      for (const { id, nodes } of violations) {
        found.push(`${path} ${colorScheme}: ${id}: ${nodes[0].target} ${nodes[0].failureSummary}`);
      }
    }
    await close();
  }
  assert.deepEqual(found, []);
});

test("by keys alone: the first one skips to the content, the next ones reach the scene", async () => {
  const { page, close } = await open("index.html");
  await page.keyboard.press("Tab");
  assert.match(await page.evaluate(() => document.activeElement.textContent), /skip to content/i);
  await page.keyboard.press("Enter");
  const reached = () => page.evaluate(() => document.activeElement.tagName === "IFRAME");
  for (let i = 0; i < 8 && !(await reached()); i++) await page.keyboard.press("Tab");
  assert.ok(await reached());
  await close();
});
