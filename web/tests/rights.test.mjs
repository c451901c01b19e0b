// Whose a scene is, in the page: a line for guests, rows in the panel, the file as it is for those who may have it; and
// what shows the page within another one.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { eigenfield } from "./command.mjs";
import { launch, openPage, scenePath, serve } from "./harness.mjs";
import { drop, openViewer, picture, settled, state } from "./viewer-page.mjs";

const TITLE = 'A "stone" & <img src=x onerror=alert(1)>';
const POLICY = "default-src 'self'; object-src 'none'"; // of a server that allows nothing inline
const URL_OF_PAGE = "https://example.org/a/page.html?a=1&b=2";
let browser;
let folder;
let server;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), "eigenfield-rights-"));
  eigenfield("export", scenePath("rights.glb"), "-o", join(folder, "page.html"), "--url", URL_OF_PAGE);
  eigenfield("export", scenePath("rights.glb"), "-o", join(folder, "kept.html"), "--no-download");
  eigenfield("export", scenePath("rights.glb"), "--as", "app", "-o", join(folder, "open"));
  server = await serve({ folders: [folder] });
});
after(async () => {
  await browser.close();
  await server.close();
  rmSync(folder, { recursive: true, force: true });
});

const clipboard = { permissions: ["clipboard-read", "clipboard-write"] };
const open = async (path, options = {}) => {
  const { context, ...rest } = options;
  const opened = await openPage(browser, null, { width: 640, height: 400, ...rest, context: { reducedMotion: "reduce", ...context } });
  await opened.page.goto(`${server.url}/${path}`);
  await opened.page.waitForFunction(() => window.eigenfield?.state().status === "ready");
  return opened;
};
const copied = async (page, name, said) => {
  await page.getByRole("button", { name }).click();
  await page.getByText(said).waitFor();
  return page.evaluate(() => navigator.clipboard.readText());
};

test("a single page has author and licence in one line, as text, however long they are", async () => {
  for (const [width, height] of [[640, 400], [300, 300]]) {
    const { page, close } = await open("page.html", { width, height });
    await settled(page);
    const line = page.locator(".title small");
    assert.match(await line.textContent(), /^Ada and a long .* · CC BY 4\.0$/);
    const box = await line.boundingBox();
    assert.ok(box.height < 22 && box.x + box.width <= width, JSON.stringify(box));
    assert.equal(await page.title(), TITLE);
    assert.equal(await page.locator("img:not(.poster)").count(), 0, "no markup");
    await close();
  }
});

test("the panel has all of it, and leads to where it comes from; a scene without has no such rows", async () => {
  const { page, close } = await openViewer(browser, "rights.glb", { width: 900, height: 600 });
  await settled(page);
  await page.getByText("About this file").click();
  await page.locator(".facts a").waitFor();
  const rows = await page.locator(".facts tr").evaluateAll((all) => all.map((row) => row.innerText.split("\t")));
  const found = Object.fromEntries(rows);
  assert.equal(found.title, TITLE);
  assert.match(found.author, /^Ada and a long/);
  assert.deepEqual([found.licence, found.source], ["CC BY 4.0", "https://example.org/stone"]);
  const link = page.locator(".facts a");
  assert.deepEqual(await link.evaluateAll((all) => all.map(({ href, rel }) => [href, rel])), [["https://example.org/stone", "noopener noreferrer"]]);
  await drop(page, "scene.glb");
  await page.waitForFunction(() => window.eigenfield.state().title === "scene");
  await settled(page);
  assert.equal(await page.locator(".facts a").count(), 0);
  assert.doesNotMatch(await page.locator(".facts").innerText(), /Rights/);
  await close();
});

test("the scene is saved as it stands in the page; --no-download and files of one's own have no button", async () => {
  const { page, close } = await open("page.html");
  const button = page.getByRole("button", { name: "Download the scene" });
  const [saved] = await Promise.all([page.waitForEvent("download"), button.click()]);
  assert.match(saved.suggestedFilename(), /^A-stone-img.*\.glb$/);
  const text = readFileSync(join(folder, "page.html"), "utf8");
  const [, base64] = /id="eigenfield-scene">([^<]*)</.exec(text);
  assert.ok(readFileSync(await saved.path()).equals(Buffer.from(base64, "base64")));
  await drop(page, "scene.glb");
  await page.waitForFunction(() => window.eigenfield.state().title === "scene");
  assert.ok(await button.isHidden());
  await close();
  const kept = await open("kept.html");
  assert.ok(await kept.page.getByRole("button", { name: "Download the scene" }).isHidden());
  await kept.close();
});

test("the embed code names the address that --url says and the view, and no title escapes from it", async () => {
  const { page, close } = await open("page.html", { context: clipboard });
  await page.evaluate(() => window.eigenfield.goTo(0.25, -0.5));
  await settled(page);
  const html = await copied(page, "Copy embed code", "Embed code copied");
  const blank = await openPage(browser, "about:blank"); // the page's own policy would complain of the frame's style
  const frame = await blank.page.evaluate((code) => {
    const { body } = new DOMParser().parseFromString(code, "text/html");
    const [one] = body.children;
    return { count: body.querySelectorAll("*").length, ...Object.fromEntries([...one.attributes].map(({ name, value }) => [name, value])) };
  }, html);
  assert.deepEqual(frame, {
    count: 1, src: `${URL_OF_PAGE}#x=0.25&y=-0.5&mode=plane`, title: TITLE, width: "640", height: "480", style: "border: 0",
    allow: "fullscreen; xr-spatial-tracking; gyroscope; accelerometer",
  });
  await blank.close();
  await close();
});

test("the embed code of a page with panel and tools leads to the view for guests", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { width: 900, height: 600, context: clipboard });
  await settled(page);
  const html = await copied(page, "Copy embed code", "Embed code copied");
  assert.match(html, /^<iframe src="http:[^"]*\/\?ui=plain#x=0&amp;y=0&amp;mode=plane" title="scene" width="640" height="480"/);
  await close();
});

test("a frame of 300 pixels: a picture, a line of buttons, and nothing beside it; ?ui=0 the picture alone", async () => {
  for (const [query, tools] of [["", true], ["?ui=0", false]]) {
    const frame = `<!doctype html><title>host</title><link rel="icon" href="data:,"><iframe src="page.html${query}" width="300" height="200"></iframe>`;
    const host = await serve({ routes: { "/host.html": { body: frame, type: "text/html" } }, folders: [folder] });
    const { page, close } = await openPage(browser, `${host.url}/host.html`, { width: 640, height: 400 });
    const inner = await (await page.locator("iframe").elementHandle()).contentFrame();
    await inner.waitForFunction(() => window.eigenfield?.state().status === "ready");
    await inner.evaluate(() => window.eigenfield.settled());
    const found = await inner.evaluate(() => {
      const boxes = [...document.querySelectorAll(".tools button")].map((one) => one.getBoundingClientRect()).filter(({ width }) => width > 0);
      const { scrollWidth, scrollHeight } = document.scrollingElement;
      return { scroll: [scrollWidth, scrollHeight], rows: new Set(boxes.map(({ top }) => top)).size, right: Math.max(0, ...boxes.map(({ right }) => right)), count: boxes.length };
    });
    assert.deepEqual(found.scroll, [300, 200]);
    assert.ok(found.right <= 300 && found.rows === (tools ? 1 : 0) && found.count >= (tools ? 4 : 0), JSON.stringify(found));
    const drawn = await inner.evaluate(() => new Set(window.eigenfield.pixels().data).size);
    assert.ok(drawn > 50, "something is drawn");
    await close();
    await host.close();
  }
});

test("a server that forbids whatever is inline: the folder plays, and says nothing inline", async () => {
  const files = {};
  for (const name of ["", "index.html", "viewer.js", "viewer.css", "worker.js", "icon.svg", "icon-192.png", "icon-512.png", "manifest.webmanifest", "samples/rights.glb", "samples/rights.jpg"]) {
    const body = readFileSync(join(folder, "open", name || "index.html"));
    const type = { html: "text/html", js: "text/javascript", css: "text/css", svg: "image/svg+xml" }[(name || "index.html").split(".").pop()];
    files[`/${name}`] = { body, ...(type && { type }), headers: { "Content-Security-Policy": POLICY } };
  }
  const strict = await serve({ routes: files });
  const html = files["/index.html"].body.toString();
  assert.doesNotMatch(html, /<script(?![^>]*(src=|type="application\/json"))|<style|\sstyle=|\son\w+=|javascript:/i);
  const init = () => {
    window.broken = [];
    document.addEventListener("securitypolicyviolation", ({ violatedDirective, blockedURI }) => window.broken.push(`${violatedDirective} ${blockedURI}`));
  };
  const { page, close } = await openPage(browser, `${strict.url}/?load=samples/rights.glb`, { width: 640, height: 400, init });
  await page.waitForFunction(() => window.eigenfield?.state().status === "ready");
  assert.equal((await state(page)).loaded, 6);
  assert.ok(new Set((await picture(page)).data).size > 50, "something is drawn");
  assert.deepEqual(await page.evaluate(() => window.broken), []);
  await close();
  await strict.close();
});
