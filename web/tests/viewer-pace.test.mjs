// The viewer on a machine that is too slow: coarser while something moves, in full when it is still and in screenshots.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { decodePng, launch } from "./harness.mjs";
import { apart, openViewer, picture, settled, state } from "./viewer-page.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

/** Frames come so many milliseconds apart, `window.interval`, by a clock that shows just that. */
const paced = () => {
  window.interval = 120;
  let clock = 1000;
  window.requestAnimationFrame = (draw) => setTimeout(() => draw((clock += window.interval)), 5);
  window.cancelAnimationFrame = (handle) => clearTimeout(handle);
};
const detail = (page) => page.evaluate(() => window.eigenfield.state().detail);
const canvasWidth = (page) => page.evaluate(() => document.querySelector("canvas.view").width);

test("slow frames: linear and coarser in motion, never in a screenshot, in full when still", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { init: paced, glide: true });
  await page.evaluate(() => window.eigenfield.goTo(1, 0));
  const start = await picture(page);
  assert.deepEqual(await detail(page), { scale: 1, linear: false });
  await page.keyboard.down("ArrowRight");
  await page.waitForFunction(() => window.eigenfield.state().detail.scale < 1);
  assert.equal((await detail(page)).linear, true);
  assert.equal(await page.evaluate(() => window.eigenfield.field.filter), "bilinear");
  assert.match(await page.locator(".rate").textContent(), /until it rests|still/);
  const [{ scale }, width] = [await detail(page), await canvasWidth(page)];
  assert.ok(Math.abs(width - 480 * scale) <= 1, `${width} pixels`);

  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("p")]);
  const saved = decodePng(readFileSync(await download.path()));
  assert.deepEqual([saved.width, saved.height], [480, 360], "a screenshot in motion is a full one");

  // Within a movement it does not become finer again: that would flicker.
  const seen = await page.evaluate(async () => {
    window.interval = 17;
    const scales = [];
    for (let i = 0; i < 30; i++) {
      await new Promise((done) => setTimeout(done, 10));
      scales.push(document.querySelector("canvas.view").width);
    }
    return scales;
  });
  seen.forEach((one, i) => assert.ok(i === 0 || one <= seen[i - 1], seen.join()));

  await page.keyboard.up("ArrowRight");
  await page.evaluate(() => window.eigenfield.goTo(1, 0));
  const now = await state(page);
  assert.deepEqual([now.detail, now.x], [{ scale: 1, linear: false }, 1]);
  assert.equal(await canvasWidth(page), 480);
  assert.equal(apart(start, await picture(page)), 0, "the full picture as it was");
  await close();
});

test("fast frames stay as they are", async () => {
  const init = `(${paced})(); window.interval = 20;`;
  const { page, close } = await openViewer(browser, "scene.glb", { init, glide: true });
  await settled(page);
  await page.keyboard.down("ArrowRight");
  const seen = await page.evaluate(async () => {
    const details = [];
    for (let i = 0; i < 40; i++) {
      await new Promise((done) => setTimeout(done, 10));
      details.push(window.eigenfield.state().detail.linear);
    }
    return details;
  });
  await page.keyboard.up("ArrowRight");
  assert.ok(seen.every((linear) => !linear));
  await close();
});

test("a machine that was slow for a while is asked again", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { init: paced, glide: true });
  await settled(page);
  const move = async (key, interval) => {
    await page.evaluate((one) => void (window.interval = one), interval);
    const { frames } = await page.evaluate(() => window.eigenfield.state());
    await page.keyboard.down(key);
    await page.waitForFunction((count) => window.eigenfield.state().frames > count + 8, frames);
    const seen = await detail(page);
    await page.keyboard.up(key);
    await settled(page);
    return seen;
  };
  const slow = await move("ArrowRight", 60);
  assert.equal(slow.linear, true);
  await move("ArrowLeft", 6); // the first quick one shows it; patience is twenty seconds of the page's clock
  await page.evaluate(() => void (window.interval = 21_000));
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(done)));
  const again = await move("ArrowRight", 6);
  assert.ok(again.scale > slow.scale || !again.linear, `${JSON.stringify(slow)}, then ${JSON.stringify(again)}`);
  await close();
});

test("a clip is drawn coarser where frames are slow, and in full once it stands still", async () => {
  const { page, close } = await openViewer(browser, "clip.glb", { init: paced, glide: true });
  await page.waitForFunction(() => window.eigenfield.field?.player.playing && window.eigenfield.state().detail.scale < 1);
  await page.evaluate(() => window.eigenfield.field.player.pause());
  await page.waitForFunction(() => window.eigenfield.state().detail.scale === 1);
  const sought = await page.evaluate(async () => {
    await window.eigenfield.field.player.toFrame(20);
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    return window.eigenfield.state();
  });
  assert.ok(sought.detail.scale < 1 && sought.detail.linear, JSON.stringify(sought.detail));
  await page.waitForFunction(() => window.eigenfield.state().detail.scale === 1);
  assert.equal(await page.evaluate(() => window.eigenfield.field.player.frame), 20);
  await close();
});

test("a clip is drawn when it shows another frame, in full where frames are fast", async () => {
  const init = `(${paced})(); window.interval = 10;`;
  const { page, close } = await openViewer(browser, "clip.glb", { init });
  await page.waitForFunction(() => window.eigenfield.state().status === "ready");
  const seen = await page.evaluate(async () => {
    const { field, state } = window.eigenfield;
    await field.player.toFrame(3);
    let shown = 0;
    field.player.addEventListener("frame", () => shown++);
    const { frames } = state();
    field.player.play();
    let passed = 0;
    while (shown < 12) await new Promise((done) => requestAnimationFrame(() => done(passed++)));
    return { shown, passed, drawn: state().frames - frames, detail: state().detail };
  });
  assert.deepEqual(seen.detail, { scale: 1, linear: false });
  assert.ok(seen.drawn <= seen.shown + 3 && seen.passed > 3 * seen.shown, JSON.stringify(seen));
  await close();
});
