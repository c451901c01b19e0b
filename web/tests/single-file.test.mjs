// One page with everything in it: as `eigenfield export` writes it, opened without a server and without a network; and
// in the frame of a notebook.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { deflateSync } from "node:zlib";
import { eigenfield, python } from "./command.mjs";
import { decodePng, launch, openPage, sceneBytes, scenePath, serve, STATIC } from "./harness.mjs";
import { apart, openViewer, picture, state } from "./viewer-page.mjs";

const TITLE = "</title></script><script>window.broken = 1</script><img src=x onerror='window.broken = 1'>&amp;\"'";
let browser;
let folder;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), "eigenfield-single-"));
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
});

test("a file opened by itself, offline: the served page's picture; hostile names are text", async () => {
  const path = join(folder, "names.html");
  eigenfield("export", scenePath("names.glb"), "-o", path, "--laboratory", "--title", TITLE);
  const parts = ["index.html", "viewer.css"].map((name) => statSync(join(STATIC, name)).size);
  const packed = deflateSync(readFileSync(join(STATIC, "viewer.js")), { level: 9 }).length;
  const expected = (4 / 3) * (sceneBytes("names.glb").length + packed) + parts.reduce((a, b) => a + b);
  const { size } = statSync(path);
  assert.ok(Math.abs(size - expected) < 20_000, `${size} bytes, ${expected} expected`);

  const served = await openViewer(browser, "names.glb", { width: 900, height: 600 });
  const wanted = await picture(served.page);
  await served.close();

  const { page, close } = await openPage(browser, null, { width: 900, height: 600, context: { offline: true } });
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto(pathToFileURL(path).href);
  await page.waitForFunction(() => window.eigenfield);
  const now = await state(page);
  assert.deepEqual([now.status, now.loaded, now.title], ["ready", 6, TITLE]);
  assert.equal(apart(wanted, await picture(page)), 0, "pixel for pixel");
  assert.equal(await page.title(), `${TITLE} – eigenfield`);
  assert.equal(await page.locator("h1").innerText(), TITLE);
  assert.equal(await page.locator("img").count(), 0);
  const names = await page.evaluate(() => window.eigenfield.field.info.names);
  const shown = await page.locator("select option").allTextContents();
  assert.deepEqual(new Set(shown.slice(1)), new Set(names));
  for (const name of names.slice(0, 4)) {
    await page.evaluate((one) => window.eigenfield.goToCamera(one), name);
    await state(page);
    assert.equal((await page.locator(".tag").textContent()).startsWith(name), true);
  }
  assert.equal(await page.evaluate(() => window.broken), undefined);
  await close();
});

test("a page for guests: offline with its poster, neither panel nor a way to it, and embedded by its snippet", async () => {
  const path = join(folder, "plain.html");
  const options = ["--title", TITLE, "--at", "0.5,-0.25", "--url", "https://example.org/a/plain.html"];
  eigenfield("export", scenePath("scene.glb"), "-o", path, ...options);
  const { page, close } = await openPage(browser, null, { width: 900, height: 600, context: { offline: true } });
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto(pathToFileURL(path).href);
  await page.waitForFunction(() => window.eigenfield);
  const { status, x, y } = await state(page);
  assert.deepEqual([status, x, y], ["ready", 0.5, -0.25]);
  assert.equal(await page.title(), TITLE);
  assert.equal(await page.locator(".title").innerText(), TITLE);
  assert.equal(await page.locator("img").count(), 0, "the poster has gone");
  assert.ok(await page.locator(".panel").isHidden());
  assert.equal(await page.locator("[property='og:image']").getAttribute("content"), "https://example.org/a/plain.jpg");
  assert.equal(await page.locator("[property='og:title']").getAttribute("content"), TITLE);
  assert.equal(await page.getByRole("button", { name: "Laboratory" }).count(), 0);
  assert.equal(await page.evaluate(() => window.broken), undefined);
  await close();

  const show = "import sys, eigenfield as ef; print(ef.export(*sys.argv[1:3], overwrite=True)[1])";
  const [snippet] = /<iframe.*<\/iframe>/.exec(python("-c", show, scenePath("scene.glb"), path));
  const head = '<!doctype html><meta charset="utf-8"><title>mine</title><link rel="icon" href="data:,">';
  const server = await serve({
    routes: { "/": { body: head + snippet, type: "text/html; charset=utf-8" } }, folders: [folder],
  });
  try {
    const outer = await openPage(browser, server.url, { width: 900, height: 700 });
    const frame = await (await outer.page.waitForSelector("iframe")).contentFrame();
    await frame.waitForFunction(() => window.eigenfield);
    assert.equal((await state(frame)).loaded, 6);
    assert.deepEqual(await frame.evaluate(() => [document.fullscreenEnabled, document.title]), [true, "plain"]);
    assert.deepEqual(server.requests, ["/", "/plain.html"]);
    await outer.close();
  } finally {
    await server.close();
  }
});

test("where scripts are forbidden, words say so; where they run, nobody sees the words", async () => {
  const path = join(folder, "forbidden.html");
  eigenfield("export", scenePath("scene.glb"), "-o", path);
  for (const policy of ["default-src 'self'", "script-src 'self'", "sandbox", ""]) {
    const headers = { "Content-Security-Policy": policy };
    const server = await serve({ routes: { "/": { body: readFileSync(path), type: "text/html", headers } } });
    const init = () => { // whether the words were ever to be seen
      const look = () => {
        window.seen ||= document.querySelector(".unscripted")?.checkVisibility({ visibilityProperty: true });
        requestAnimationFrame(look);
      };
      look();
    };
    const { page, close } = await openPage(browser, server.url, { allowed: /Content Security|sandbox/, init });
    const words = page.locator(".unscripted");
    if (policy === "") {
      await page.waitForFunction(() => window.eigenfield);
      assert.deepEqual([(await state(page)).loaded, await words.count(), await page.evaluate(() => window.seen ?? false)], [6, 0, false]);
    } else {
      await words.waitFor({ timeout: 5000 });
      assert.match(await words.innerText(), /^The script of this page does not run here\. Download.*\n+Das Skript/);
    }
    await close();
    await server.close();
  }
});

test("in a notebook: a frame of its own that draws, moves and saves, and begins with its panel folded", async () => {
  const frame = join(folder, "frame.html");
  const show = "import sys, eigenfield; open(sys.argv[2], 'w').write(eigenfield.load(sys.argv[1])._repr_html_())";
  python("-c", show, scenePath("scene.glb"), frame);
  const head = '<!doctype html><meta charset="utf-8"><title>notebook</title><link rel="icon" href="data:,"><p>cell</p>';
  const body = head + readFileSync(frame, "utf8");
  const server = await serve({ routes: { "/": { body, type: "text/html; charset=utf-8" } } });
  try {
    const { page, close } = await openPage(browser, server.url, { width: 1100, height: 700 });
    const inner = await (await page.waitForSelector("iframe")).contentFrame();
    await inner.waitForFunction(() => window.eigenfield);
    const before = await state(inner);
    assert.deepEqual([before.status, before.loaded], ["ready", 6]);
    assert.ok(await inner.locator(".panel").isHidden(), "480 pixels high");
    const still = await picture(inner);
    assert.ok(new Set(still.data).size > 50);

    const box = await page.locator("iframe").boundingBox();
    await page.mouse.move(box.x + 500, box.y + 250);
    await page.mouse.down();
    await page.mouse.move(box.x + 440, box.y + 230, { steps: 3 });
    await page.mouse.up();
    const moved = await state(inner);
    assert.ok(moved.x > before.x + 0.1 && moved.y < before.y, `${moved.x}, ${moved.y}`);
    assert.ok(apart(still, await picture(inner)) > 0.2);
    await page.waitForTimeout(500); // the address would be written now: a frame has none

    const save = inner.getByRole("button", { name: /^Save the picture/ });
    const [download] = await Promise.all([page.waitForEvent("download"), save.click()]);
    const saved = decodePng(readFileSync(await download.path()));
    assert.deepEqual([saved.width, saved.height], [box.width, box.height]);
    assert.deepEqual(server.requests, ["/"], "the frame asks for nothing");
    await close();
  } finally {
    await server.close();
  }
});
