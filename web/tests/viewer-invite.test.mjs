// The viewer as a guest meets it: it moves by itself until somebody does, says how, and suits a phone.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, sceneBytes } from "./harness.mjs";
import { near, openViewer, settled, state } from "./viewer-page.mjs";

const SMALL = { width: 320, height: 240 };
const PHONE = { width: 390, height: 844, context: { hasTouch: true, isMobile: true } };
let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

const now = (page) => page.evaluate(() => window.eigenfield.state());
const swaying = (page) => page.waitForFunction(() => Math.abs(window.eigenfield.state().x) > 0.01);
const drag = async (page, [x0, y0], [x1, y1]) => {
  await page.mouse.move(x0, y0);
  await page.mouse.down();
  await page.mouse.move(x1, y1, { steps: 3 });
  await page.mouse.up();
};

test("the first view sways until it must be still, and words say how to look around until somebody does", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { ...SMALL, glide: true });
  await swaying(page);
  assert.equal(await page.locator(".hint").innerText(), "Drag to look around");
  assert.equal(await page.evaluate(() => location.hash), "", "a view that sways is no address");
  const still = await state(page);
  near(Math.hypot(still.x, still.y), 0, 1e-6); // who waits for a still picture has the first view
  assert.ok(await page.locator(".hint").isVisible());
  await drag(page, [200, 150], [216, 150]);
  await settled(page);
  assert.ok(await page.locator(".hint").isHidden());
  await close();
});

test("a hand on the picture stops it where it is", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { ...SMALL, glide: true });
  await swaying(page);
  await page.mouse.move(200, 150);
  await page.mouse.down();
  await page.waitForTimeout(500); // what it still glides
  const held = await now(page);
  await page.waitForTimeout(400);
  assert.deepEqual([(await now(page)).x, held.x !== 0], [held.x, true]);
  await close();
});

test("no sway for who asked for less motion, none and no words where the address names a view", async () => {
  const calm = await openViewer(browser, "scene.glb", SMALL);
  await calm.page.waitForSelector(".hint:not([hidden])");
  const { frames } = await state(calm.page);
  await calm.page.waitForTimeout(500);
  const later = await now(calm.page);
  near(later.x, 0, 1e-6);
  assert.ok(later.frames <= frames + 1, `${later.frames - frames} frames`);
  await calm.close();
  const named = await openViewer(browser, "scene.glb", { ...SMALL, glide: true, hash: "#x=0.2&y=0.1" });
  await state(named.page);
  await named.page.waitForTimeout(500);
  const { x, y } = await now(named.page);
  assert.deepEqual([x, y], [0.2, 0.1]);
  assert.ok(await named.page.locator(".hint").isHidden());
  await named.close();
});

test("orbit yields less and less beyond the captured views, and comes back at once", async () => {
  const { page, close } = await openViewer(browser, "around.glb");
  const elevation = async () => {
    await settled(page);
    const [[x, y, z]] = await page.evaluate(() => window.eigenfield.eyes());
    return Math.asin(y / Math.hypot(x, y, z));
  };
  const seen = [await elevation()];
  for (let i = 0; i < 4; i++) {
    await drag(page, [200, 150], [200, 222]); // 72 of 360 pixels: 0.48 radians
    seen.push(await elevation());
  }
  const steps = seen.slice(1).map((value, i) => Math.abs(value - seen[i]));
  near(steps[0], 0.48, 0.03); // among the captured views nothing holds it
  assert.ok(steps[2] < 0.25 && steps[3] < steps[2] && steps[3] > 0.01, `steps of ${steps}`);
  assert.equal((await state(page)).outside, true);
  const out = await elevation();
  await drag(page, [200, 222], [200, 150]);
  near(Math.abs((await elevation()) - out), 0.48, 0.03);
  await close();
});

test("H closes what H opens, and ? what ? opens", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await settled(page);
  for (const key of ["h", "?"]) {
    await page.keyboard.press(key);
    await page.waitForSelector("dialog[open]");
    await page.keyboard.press(key);
    await page.waitForSelector("dialog", { state: "hidden" });
  }
  await close();
});

test("at rest the panel says what is drawn and which camera is near", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { width: 900, height: 600 });
  await settled(page);
  assert.equal(await page.locator(".rate").textContent(), "Drawn in full, nearest camera view_2_2");
  await close();
});

test("an upright phone: the picture fills the height, zoom shows all of it, and fingers hit what they aim at", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", PHONE);
  const { frame } = await state(page);
  near(frame.height, 1, 1e-9);
  assert.ok(frame.width > 2);
  await page.evaluate(() => void (location.hash = "#x=0&y=0&zoom=0.1"));
  await page.waitForFunction(() => window.eigenfield.state().zoom < 1);
  near((await state(page)).frame.width, 1, 1e-9);
  await page.waitForFunction(() => location.hash.includes("zoom=0."));
  await page.reload();
  await page.waitForFunction(() => window.eigenfield?.state().status === "ready");
  near((await state(page)).frame.width, 1, 1e-3); // a link shows what was seen
  await page.getByRole("button", { name: /^Panel/ }).tap();
  for (const summary of await page.locator(".panel > details > summary").all()) await summary.tap();
  const targets = "button, select, summary, input[type=range], .segments span, .tick";
  const small = await page.locator(targets).evaluateAll((all) =>
    all
      .map((one) => [one.getAttribute("aria-label") ?? one.textContent, one.getBoundingClientRect()])
      .filter(([, { width, height }]) => width > 0 && (width < 44 || height < 44))
      .map(([name, { width, height }]) => `${name}: ${width} x ${height}`));
  assert.deepEqual(small, []);
  assert.ok((await page.locator(targets).count()) > 30);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  await close();
});

test("?ui=0 shows the picture alone, ?ui=plain a title and the way to the laboratory and back", async () => {
  const bare = await openViewer(browser, "scene.glb", { width: 900, height: 600, query: "?ui=0" });
  await settled(bare.page);
  for (const part of [".tools", ".map", ".panel", ".hint", ".title"])
    assert.ok(await bare.page.locator(part).isHidden(), part);
  assert.deepEqual((await bare.page.locator("canvas.view").boundingBox()).width, 900);
  await bare.close();
  const { page, close } = await openViewer(browser, "scene.glb", { width: 900, height: 600, query: "?ui=plain" });
  await settled(page);
  assert.equal(await page.locator(".title").innerText(), "scene");
  assert.equal(await page.title(), "scene");
  const shown = async () => Promise.all([".panel", ".map"].map((part) => page.locator(part).isVisible()));
  for (const key of ["i", "h", "m"]) await page.keyboard.press(key);
  assert.deepEqual(await shown(), [false, false]);
  assert.ok(await page.locator("dialog").isHidden());
  const names = await page.locator(".tools button:visible").evaluateAll((all) => all.map((one) => one.ariaLabel));
  assert.deepEqual(names, ["First view", "Copy a link to this view", "Copy embed code", "Download the scene", "Full screen", "Laboratory"]);
  const laboratory = page.getByRole("button", { name: "Laboratory" });
  await laboratory.click();
  assert.deepEqual(await shown(), [true, true]);
  await laboratory.click();
  assert.deepEqual(await shown(), [false, false]);
  await close();
});

test("a poster is shown until the scene is there", async () => {
  const bytes = sceneBytes("scene.glb");
  let release;
  const wanted = new Promise((resolve) => (release = resolve));
  const slow = async (request, response) => {
    await wanted;
    response.writeHead(200, { "Content-Type": "model/gltf-binary", "Content-Length": bytes.length }).end(bytes);
  };
  const routes = { "/scene.glb": slow, "/poster.png": { body: sceneBytes("scene-bicubic-0.png"), type: "image/png" } };
  const { page, close } = await openViewer(browser, "scene.glb", { routes, query: "?poster=poster.png" });
  await page.waitForFunction(() => document.querySelector("img.poster")?.naturalWidth > 0);
  assert.ok(await page.locator("img.poster").isVisible());
  release();
  await settled(page);
  assert.equal(await page.locator("img.poster").count(), 0);
  await close();
});

test("the page's own first view, to which Home leads back", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { config: { start: [0.5, -0.25] } });
  const first = await state(page);
  await page.evaluate(() => window.eigenfield.goTo(0, 0));
  await settled(page);
  await page.keyboard.press("Home");
  const home = await state(page);
  assert.deepEqual([first.x, first.y, home.x, home.y], [0.5, -0.25, 0.5, -0.25]);
  await close();
});

test("full screen and back", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await settled(page);
  const button = page.getByRole("button", { name: "Full screen" });
  await button.click();
  await page.waitForSelector("[aria-label='Full screen'][aria-pressed=true]");
  assert.ok(await page.evaluate(() => document.fullscreenElement === document.documentElement));
  await button.click();
  await page.waitForSelector("[aria-label='Full screen'][aria-pressed=false]");
  await close();
});
