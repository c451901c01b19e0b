// Two scenes beside each other: one eye, a line between them, and what is said of both.

import assert from "node:assert/strict";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { eigenfield, view } from "./command.mjs";
import { launch, openPage, sceneBytes, scenePath, serve } from "./harness.mjs";
import { drop, near, openViewer, picture, set, settled, state } from "./viewer-page.mjs";

const SIZE = { width: 480, height: 360 };
let browser;
let folder;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), "eigenfield-beside-"));
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
});

/** The viewer with two of the test scenes. */
async function open(first, second, options = {}) {
  const opened = await openViewer(browser, first, {
    ...SIZE, ...options,
    config: { beside: { names: [first, second], scene: "second.glb", bytes: sceneBytes(second).length } },
    routes: { "/second.glb": { body: sceneBytes(second) } },
  });
  await opened.page.waitForSelector(".compared.right:not([hidden])", { state: "attached" }); // ?ui=0 hides it
  await settled(opened.page);
  return opened;
}

/** Mean difference, in grey levels, of columns of two pictures. */
function apart(a, b, from, to) {
  let [sum, count] = [0, 0];
  for (let y = 0; y < a.height; y++) {
    for (let x = Math.ceil(from * a.width); x < Math.floor(to * a.width); x++) {
      for (let c = 0; c < 3; c++) sum += Math.abs(a.data[3 * (y * a.width + x) + c] - b.data[3 * (y * a.width + x) + c]);
      count += 3;
    }
  }
  return sum / count;
}

/** A page of a scene alone: `seen` is what it draws at a place. */
async function alone(name) {
  const { page, close } = await openViewer(browser, name, { ...SIZE, query: "?ui=0" });
  const seen = async (go) => {
    await go(page);
    await settled(page);
    return picture(page);
  };
  return { seen, close };
}

test("left of the line the first, right of it the second, seen from one place: on the plane, off it, and by a camera", async () => {
  const places = [
    (page) => page.evaluate(() => window.eigenfield.goTo(0.4, -0.3)),
    (page) => page.evaluate(() => (location.hash = "#eye=0.3,0.4,3.6&at=0,0,0&mode=orbit")),
    (page) => page.evaluate(() => window.eigenfield.goToCamera("view_1_3")),
  ];
  const { page, close } = await open("scene.glb", "one.glb", { query: "?ui=0" });
  const [left, right] = [await alone("scene.glb"), await alone("one.glb")];
  for (const go of places) {
    await set(page, { divider: 0.4 });
    await go(page);
    await settled(page);
    const { frame } = await state(page);
    const both = await picture(page);
    const [first, second] = [await left.seen(go), await right.seen(go)];
    const at = frame.left + 0.4 * frame.width;
    assert.equal(apart(both, first, 0, at - 0.01), 0);
    assert.ok(apart(both, second, at + 0.01, 1) < 0.01, `${apart(both, second, at + 0.01, 1)}`);
    assert.ok(apart(first, second, 0, 1) > 1, "they differ");
    await set(page, { divider: null });
    assert.equal(apart(await picture(page), first, 0, 1), 0);
  }
  for (const one of [{ close }, left, right]) await one.close();
});

test("names, bytes and scores stand above; the line is dragged, by a finger too, moved by keys, and goes by B", async () => {
  const { page, close } = await open("scene.glb", "one.glb", { context: { hasTouch: true } });
  const labels = await page.locator(".compared").allInnerTexts();
  assert.match(labels[0].replaceAll(/\s/g, " "), /^scene\.glb 102 kB · 33\.3 dB$/);
  assert.match(labels[1].replaceAll(/\s/g, " "), /^one\.glb [\d.]+ kB · 33\.3 dB$/);
  const line = page.getByRole("slider", { name: "Line between the two scenes" });
  const at = async () => (await state(page)).divider;
  assert.equal(await at(), 0.5);
  const { frame } = await state(page);
  const stage = await page.locator(".stage").boundingBox();
  const [middle, to] = [0.5, 0.25].map((part) => stage.x + stage.width * (frame.left + part * frame.width));
  const y = stage.y + stage.height / 2;
  await page.mouse.move(middle, y);
  await page.mouse.down();
  await page.mouse.move(to, y, { steps: 4 });
  await page.mouse.up();
  near(await at(), 0.25, 0.005);
  await line.press("ArrowRight");
  near(await at(), 0.27, 0.005);
  await line.blur();
  const divide = page.locator("button.wide", { hasText: "beside" });
  assert.deepEqual([await divide.isEnabled(), await divide.getAttribute("aria-pressed")], [true, "true"]);
  await page.keyboard.press("b");
  assert.equal(await at(), null);
  assert.ok(await line.isHidden());
  await page.keyboard.press("b");
  assert.equal(await at(), 0.5);
  const touch = await page.context().newCDPSession(page);
  const finger = (type, x) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: x === null ? [] : [{ x, y }] });
  await finger("touchStart", middle);
  await finger("touchMove", (middle + to) / 2);
  await finger("touchMove", to);
  await finger("touchEnd", null);
  near(await at(), 0.25, 0.01);
  await page.waitForFunction(() => location.hash.includes("divider=0.2"));
  await close();
});

test("scenes of different captures play, and the page says that cameras differ", async () => {
  for (const [first, second] of [["scene.glb", "line.glb"], ["scene.glb", "around.glb"], ["around.glb", "scene.glb"]]) {
    const { page, close } = await open(first, second);
    await page.getByText("The cameras of the two scenes differ").waitFor();
    const { frame } = await state(page);
    const both = await picture(page);
    const colours = new Set();
    for (let x = Math.ceil((frame.left + 0.6 * frame.width) * both.width); x < both.width; x++)
      for (let y = 0; y < both.height; y++) colours.add(both.data.slice(3 * (y * both.width + x), 3 * (y * both.width + x) + 3).join());
    assert.ok(colours.size > 50, `${first} beside ${second}: the second one is drawn`);
    await close();
  }
  const { page, close } = await open("scene.glb", "one.glb");
  assert.equal(await page.getByText("The cameras of the two scenes differ").count(), 0);
  await close();
});

test("a file that is dropped takes the place of both; a second one that is damaged is said, and the first stays", async () => {
  const { page, close } = await open("scene.glb", "one.glb");
  await drop(page, "four.glb");
  await page.waitForFunction(() => window.eigenfield.state().title === "four");
  await settled(page);
  assert.ok(await page.locator(".compared.right").isHidden());
  assert.ok(await page.locator(".divider").isHidden());
  await close();
  const config = { beside: { names: ["a", "b"], scene: "second.glb", bytes: 10 } };
  const bad = await openViewer(browser, "scene.glb", { ...SIZE, config, routes: { "/second.glb": { body: sceneBytes("damaged.glb") } } });
  await bad.page.getByText("b cannot be opened").waitFor();
  assert.equal((await state(bad.page)).status, "ready");
  await bad.close();
});

test("export of two scenes is one page for guests, in a small frame too, and view serves two", async () => {
  const page = join(folder, "compare.html");
  eigenfield("export", scenePath("scene.glb"), scenePath("one.glb"), "-o", page);
  assert.ok(existsSync(join(folder, "compare.jpg")));
  const server = await serve({ folders: [folder] });
  for (const [width, height] of [[640, 400], [300, 300]]) {
    const opened = await openPage(browser, `${server.url}/compare.html`, { width, height, context: { reducedMotion: "reduce" } });
    await opened.page.waitForSelector(".compared.right:not([hidden])");
    await settled(opened.page);
    const [left, right] = await Promise.all([".left", ".right"].map((one) => opened.page.locator(`.compared${one}`).boundingBox()));
    assert.ok(left.x + left.width <= right.x && right.x + right.width <= width, JSON.stringify([left, right]));
    assert.ok(await opened.page.locator(".divider").isVisible());
    assert.deepEqual(await opened.page.locator(".compared strong").allInnerTexts(), ["scene", "one"]);
    await opened.close();
  }
  await server.close();
  const served = await view(scenePath("scene.glb"), scenePath("one.glb"));
  const opened = await openPage(browser, served.address, SIZE);
  await opened.page.waitForSelector(".compared.right:not([hidden])");
  assert.deepEqual(await opened.page.locator(".compared strong").allInnerTexts(), ["scene", "one"]);
  await opened.close();
  assert.equal(await served.stop(), 0);
});

test("two clips keep step", async () => {
  const { page, close } = await open("clip.glb", "clip.glb", { glide: true });
  await page.evaluate(() => window.eigenfield.settled());
  const slider = page.getByRole("slider", { name: "Time" });
  await slider.fill("3");
  await settled(page);
  await page.waitForTimeout(300);
  const both = await picture(page);
  assert.equal((await state(page)).playing, false);
  await page.keyboard.press("b");
  assert.ok(apart(await picture(page), both, 0, 1) < 0.01, "both show the same frame");
  await close();
});
