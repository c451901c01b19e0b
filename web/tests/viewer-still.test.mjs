// The viewer: idle when nothing moves, sizes, and a graphics context that is lost and found.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch } from "./harness.mjs";
import { apart, openViewer, picture, settled, state } from "./viewer-page.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

test("nothing moves: no frame is drawn", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  const before = await state(page);
  await page.waitForTimeout(700);
  const now = await page.evaluate(() => window.eigenfield.state().frames);
  assert.ok(now <= before.frames + 1, `${now - before.frames} frames of a still view`);
  await page.mouse.move(100, 100); // over the picture, with no button down
  await page.mouse.move(200, 150);
  await page.waitForTimeout(200);
  assert.equal(await page.evaluate(() => window.eigenfield.state().frames), now);
  await close();
});

test("the canvas follows the window, at no more than two pixels a point", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { context: { deviceScaleFactor: 3 } });
  await settled(page);
  const first = await picture(page);
  assert.deepEqual([first.width, first.height], [960, 720]);
  await page.setViewportSize({ width: 300, height: 420 });
  await page.waitForFunction(() => window.eigenfield.pixels().height === 840);
  const now = await picture(page);
  assert.deepEqual([now.width, now.height], [600, 840]);
  assert.ok(new Set(now.data).size > 50);
  await close();
});

test("a lost context: a message, then the same picture again", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { allowed: /context.(lost|restored)/i });
  await page.evaluate(() => window.eigenfield.goTo(0.4, 0.3));
  const before = await picture(page);
  await page.evaluate(() => {
    const gl = document.querySelector("canvas.view").getContext("webgl2");
    window.loss = gl.getExtension("WEBGL_lose_context");
    window.loss.loseContext();
  });
  await page.waitForFunction(() => window.eigenfield.state().status === "lost");
  assert.match(await page.locator(".message").innerText(), /Waiting until it can draw again/);
  await page.evaluate(() => window.loss.restoreContext());
  await page.waitForFunction(() => window.eigenfield.state().status === "ready");
  const now = await state(page);
  assert.deepEqual([now.loaded, now.x, now.y], [6, 0.4, 0.3]);
  assert.ok(await page.locator(".message").isHidden());
  assert.ok(apart(before, await picture(page)) < 0.5);
  await close();
});

test("on a phone the panel begins folded, and opens below the picture", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", {
    width: 390, height: 700, context: { hasTouch: true, isMobile: true },
  });
  await settled(page);
  assert.ok(await page.locator(".panel").isHidden());
  await page.getByRole("button", { name: /^Panel/ }).tap();
  const panel = await page.locator(".panel").boundingBox();
  const canvas = await page.locator("canvas.view").boundingBox();
  assert.ok(panel.y >= canvas.y + canvas.height - 1 && panel.width === 390);
  assert.ok(panel.y + panel.height <= 701);
  await close();
});
