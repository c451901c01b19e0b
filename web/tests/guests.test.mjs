// The page for guests, as `eigenfield export` writes it: how soon it shows something, a bar without words, links, a title
// of any length, a browser without WebGL 2, and the way to the laboratory where one is built in.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { gzipSync } from "node:zlib";
import { eigenfield } from "./command.mjs";
import { launch, openPage, scenePath, serve, STATIC } from "./harness.mjs";
import { apart, openViewer, picture, state } from "./viewer-page.mjs";

const MOST_BYTES = 400_000; // of page and viewer, gzipped
const FIRST_PICTURE_MS = 1000;
const BUSY_RATIO = 5; // where even a page of the poster alone takes more than a fifth of that, the machine is busy
const LONG = "A title that goes on and on. ".repeat(173).slice(0, 5000);
const URL_OF_PAGE = "https://example.org/a/page.html";
let browser;
let folder;
let server;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), "eigenfield-guests-"));
  eigenfield("export", scenePath("scene.glb"), "-o", join(folder, "page.html"), "--title", LONG, "--url", URL_OF_PAGE);
  eigenfield("export", scenePath("scene.glb"), "-o", join(folder, "measure.html"), "--laboratory");
  server = await serve({ folders: [folder] });
});
after(async () => {
  await browser.close();
  await server.close();
  rmSync(folder, { recursive: true, force: true });
});

const open = async (path, options = {}) => {
  const { context, ...rest } = options;
  const opened = await openPage(browser, null, { width: 640, height: 400, ...rest, context: { reducedMotion: "reduce", ...context } });
  await opened.page.goto(`${server.url}/${path}`);
  return opened;
};
const ready = (page) => page.waitForFunction(() => window.eigenfield?.state().status === "ready");

test("page and viewer are light, and the poster is there at once", async (context) => {
  const parts = ["index.html", "viewer.js", "viewer.css"].map((name) => gzipSync(readFileSync(join(STATIC, name))).length);
  const bytes = parts.reduce((a, b) => a + b);
  assert.ok(bytes < MOST_BYTES, `${bytes} bytes`);
  writeFileSync(join(folder, "bare.html"), '<!doctype html><title>bare</title><link rel="icon" href="data:,"><img class="poster" src="page.jpg">');
  const times = [], bare = [];
  for (let i = 0; i < 3; i++) {
    for (const [path, found] of [["page.html", times], ["bare.html", bare]]) {
      const { page, close } = await open(path, { init: () => { // later, the poster may have been taken away
        const look = (list) => list.getEntries().forEach(({ element, startTime }) => element?.matches(".poster") && (window.posterAt ??= startTime));
        new PerformanceObserver(look).observe({ type: "largest-contentful-paint", buffered: true });
      } });
      found.push(await (await page.waitForFunction(() => window.posterAt)).jsonValue());
      await close();
    }
  }
  const shown = (all) => all.map((time) => time.toFixed(0)).join(", ");
  context.diagnostic(`${bytes} bytes gzipped; first picture after ${shown(times)} ms, of a page that has no more than it after ${shown(bare)}`);
  assert.ok(Math.min(...times) < Math.max(FIRST_PICTURE_MS, BUSY_RATIO * Math.min(...bare)));
});

test("no words of ours: a bar that loads, a title of 5,000 letters that is cut, a few buttons", async () => {
  for (const [width, height] of [[640, 400], [390, 844]]) {
    const { page, close } = await open("page.html", { width, height });
    await ready(page);
    await state(page);
    const title = await page.locator(".title").boundingBox();
    assert.ok(title.height < 80 && title.width <= width - 24, JSON.stringify(title));
    assert.equal(await page.evaluate(() => document.scrollingElement.scrollHeight), height);
    assert.ok(await page.locator(".progress p").isHidden());
    const names = await page.locator(".tools button:visible").evaluateAll((all) => all.map((one) => one.ariaLabel));
    assert.deepEqual(names, ["First view", "Copy a link to this view", "Copy embed code", "Download the scene", "Full screen"]);
    assert.doesNotMatch(await page.locator("body").innerText(), /eigen|laboratory|camera|texture/i);
    await close();
  }
});

test("a link to what is seen is copied: to the address that --url says, else to the page's own", async () => {
  for (const [path, base] of [["page.html", URL_OF_PAGE], ["measure.html?ui=plain", `${server.url}/measure.html?ui=plain`]]) {
    const { page, close } = await open(path, { context: { permissions: ["clipboard-read", "clipboard-write"] } });
    await ready(page);
    await page.evaluate(() => window.eigenfield.goTo(0.25, -0.5));
    await state(page);
    await page.getByRole("button", { name: "Copy a link" }).click();
    await page.getByText("Link copied").waitFor();
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), `${base}#x=0.25&y=-0.5&mode=plane`);
    await close();
  }
});

test("where the clipboard is closed, a selection is copied instead", async () => {
  const init = () => Object.defineProperty(navigator, "clipboard", { value: undefined });
  const { page, close } = await open("page.html", { init });
  await ready(page);
  const copied = page.evaluate(() => new Promise((done) => {
    addEventListener("copy", () => done(document.activeElement.value));
  }));
  await page.getByRole("button", { name: "Copy a link" }).click();
  assert.match(await copied, /^https:\/\/example\.org\/a\/page\.html#x=/);
  await page.getByText("Link copied").waitFor();
  await close();
});

test("without WebGL 2 the poster stays, with the title and a word", async () => {
  const init = () => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith("webgl") ? null : getContext.call(this, kind, ...rest);
    };
  };
  const { page, close } = await open("page.html", { init, allowed: /WebGL/ });
  await page.getByRole("alert").waitFor();
  assert.match(await page.getByRole("alert").innerText(), /This needs WebGL 2/);
  assert.ok(await page.locator("img.poster").isVisible());
  const [poster, word, title] = await Promise.all(
    ["img.poster", ".message", ".title"].map((one) => page.locator(one).boundingBox()),
  );
  assert.deepEqual([poster.width, poster.height], [640, 400]);
  assert.ok(word.y > 200 && word.y + word.height <= title.y, "the picture is to be seen");
  await close();
});

test("the laboratory: built in it is an i away, and back; a page for guests has none", async () => {
  const { page, close } = await open("measure.html?ui=plain", { width: 900, height: 600 });
  await ready(page);
  const way = page.getByRole("button", { name: "Laboratory" });
  assert.ok(await page.locator(".panel").isHidden());
  await way.click();
  assert.ok(await page.locator(".panel").isVisible());
  await way.click();
  assert.ok(await page.locator(".panel").isHidden());
  await page.goto(`${server.url}/page.html`);
  await ready(page);
  assert.equal(await way.count(), 0);
  await close();
});

test("outside the captured views the picture fades for guests, and nothing is black; the laboratory shows it as it is", async () => {
  const { page, close } = await openViewer(browser, "around.glb", { query: "?ui=plain" });
  const black = ({ data }) => data.filter((_, i) => i % 3 === 0 && data[i] === 21 && data[i + 1] === 23 && data[i + 2] === 26).length;
  const inside = await picture(page);
  assert.ok(black(inside) > 1000, "beside the thing");
  const away = "#eye=-2.1,-1.1,-3.2&at=0,0,0";
  await page.evaluate((hash) => (location.hash = hash), away);
  assert.equal((await state(page)).outside, true);
  const faded = await picture(page);
  assert.equal(black(faded), 0);
  assert.ok(await page.locator(".cue").isHidden());
  const { page: plainly, close: end } = await openViewer(browser, "around.glb", { hash: away });
  assert.equal((await state(plainly)).outside, true);
  const drawn = await picture(plainly);
  assert.ok(await plainly.locator(".cue").isVisible());
  const edges = ({ data }) => data.reduce((sum, value, i) => sum + Math.abs(value - (data[i + 3] ?? value)), 0) / data.length;
  assert.ok(edges(faded) < 0.5 * edges(drawn), `${edges(faded)} beside ${edges(drawn)}`);
  await page.keyboard.press("Home");
  await state(page);
  assert.ok(apart(inside, await picture(page)) < 0.01, "inside again as it was");
  await end();
  await close();
});
