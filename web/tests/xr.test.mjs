// A headset, emulated by iwer: the session, both eyes, their weights, and the way back.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, WEB } from "./harness.mjs";
import { apart, near, openViewer, picture, settled, state } from "./viewer-page.mjs";

const IWER = readFileSync(join(WEB, "node_modules/iwer/build/iwer.min.js"), "utf8");
const HEADSET = `${IWER}
  delete window.XRWebGLBinding; // Chromium's own does not take the emulator's sessions
  window.headset = new IWER.XRDevice(IWER.metaQuest3, { stereoEnabled: true, ipd: 0.063 });
  window.headset.installRuntime({ forceInstall: true });`;

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

/** A viewer in a running session. */
async function present(scene, options = {}) {
  const opened = await openViewer(browser, scene, { init: HEADSET, width: 640, height: 320, ...options });
  const { page } = opened;
  const before = await state(page);
  await page.evaluate((known) => {
    if (!known) window.eigenfield.field.info.metresPerUnit = null;
  }, options.config !== undefined);
  const free = await picture(page);
  await page.getByRole("button", { name: "Enter VR" }).click();
  await page.waitForFunction(() => window.eigenfield.field.lastWeights.length === 2);
  await frames(page);
  return { ...opened, before, free };
}

/** Some frames of the headset. */
const frames = (page) => page.evaluate(async () => {
  for (let i = 0; i < 4; i++) await new Promise((done) => headset.activeSession.requestAnimationFrame(done));
});

/** How many colours each eye sees. */
const colours = (page) =>
  page.evaluate(async () => {
    await new Promise((done) => headset.activeSession.requestAnimationFrame(done));
    const gl = document.querySelector("canvas.view").getContext("webgl2");
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const data = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, data);
    const half = (from) => {
      const seen = new Set();
      for (let y = 0; y < height; y++)
        for (let x = from; x < from + width / 2; x++) {
          const at = 4 * (y * width + x);
          seen.add(data.slice(at, at + 3).join());
        }
      return seen.size;
    };
    return { left: half(0), right: half(width / 2) };
  });

/** Of each eye: the weights it was drawn with, its X, Y, and the weights that belong there. */
const eyes = (page) =>
  page.evaluate(() => {
    const { field } = window.eigenfield;
    const { origin, right, up, normal, extent } = field.info.viewPlane;
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    return window.eigenfield.eyes().map((eye, i) => {
      const offset = eye.map((value, axis) => value - origin[axis]);
      const [x, y] = [dot(offset, right) / extent[0], extent[1] > 0 ? dot(offset, up) / extent[1] : 0];
      return {
        x, y, off: dot(offset, normal) / extent[0],
        drawn: [...field.lastWeights[i]],
        wanted: [...field.componentWeights(x, y)],
      };
    });
  });

test("no headset, no button", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await settled(page);
  assert.equal(await page.getByRole("button", { name: "Enter VR" }).count(), 0);
  await close();
});

test("both eyes are drawn, each with the weights of its own place, around the array's middle", async () => {
  const { page, close, before, free } = await present("scene.glb");
  const [left, right] = await eyes(page);
  for (const eye of [left, right]) {
    eye.drawn.forEach((weight, j) => near(weight, eye.wanted[j], 1e-4));
    near(eye.y, 0, 1e-3);
    near(eye.off, 0, 1e-3);
  }
  near(left.x, -0.063 / 2 / 0.25, 1e-3); // the array is half a metre wide: nobody knows how wide it was
  near(right.x, 0.063 / 2 / 0.25, 1e-3);
  assert.ok(left.drawn.some((weight, j) => Math.abs(weight - right.drawn[j]) > 1e-3), "the weights differ");

  const shot = await colours(page);
  assert.ok(shot.left > 500 && shot.right > 500, `colours: ${JSON.stringify(shot)}`);

  await page.setViewportSize({ width: 400, height: 360 });
  await page.evaluate(() => headset.activeSession.end());
  await settled(page);
  const size = await page.locator("canvas.view").evaluate((canvas) => [canvas.width, canvas.height]);
  assert.deepEqual(size, [400, 360], "of the window, which was another one meanwhile");
  await page.setViewportSize({ width: 640, height: 320 });
  await page.waitForFunction(() => document.querySelector("canvas.view").width === 640);
  const now = await state(page);
  assert.deepEqual([now.x, now.y, now.mode], [before.x, before.y, before.mode]);
  assert.ok(apart(free, await picture(page)) < 0.01, "the view before");
  for (const name of ["requestSession", "requestReferenceSpace"]) {
    await page.evaluate((name) => {
      const own = name === "requestSession" ? navigator.xr : IWER.XRSession.prototype;
      const before = own[name];
      own[name] = () => {
        own[name] = before; // for the next time
        return Promise.reject(new Error(`no ${name}`));
      };
    }, name);
    await page.getByRole("button", { name: "Enter VR" }).dispatchEvent("click"); // the emulator leaves the canvas over it
    await page.getByText(`The headset cannot show the scene: no ${name}`).waitFor();
    assert.ok(apart(free, await picture(page)) < 0.01, "the page goes on");
  }
  await close();
});

test("sheets are drawn for both eyes", async () => {
  const { page, close } = await present("sheets.glb");
  const shot = await colours(page);
  assert.ok(shot.left > 500 && shot.right > 500, `colours: ${JSON.stringify(shot)}`);
  await close();
});

test("the head moves: so do the weights; a known size is kept", async () => {
  const { page, close } = await present("scene.glb", { config: { metresPerUnit: 0.25 } });
  const [left] = await eyes(page); // half the array is 0.8 units, 0.2 m
  near(left.x, -0.063 / 2 / 0.2, 1e-3);
  await page.evaluate(() => {
    const { position } = headset;
    position.set(position.x + 0.1, position.y + 0.05, position.z - 0.2);
  });
  await frames(page);
  const [moved] = await eyes(page);
  near(moved.x - left.x, 0.1 / 0.2, 2e-3);
  near(moved.y - left.y, 0.05 / 0.2, 2e-3);
  near(moved.off, -0.2 / 0.2, 2e-3);
  moved.drawn.forEach((weight, j) => near(weight, moved.wanted[j], 1e-4));
  assert.equal(await page.evaluate(() => window.eigenfield.field.weightMode), "ray");
  assert.equal(await page.evaluate(() => window.eigenfield.field.filter), "bilinear", "quick, as a headset wants it");
  await close();
});

test("a thumbstick moves the eyes on the plane, and no further than its edge", async () => {
  const { page, close } = await present("scene.glb");
  const [start] = await eyes(page);
  await page.evaluate(() => headset.controllers.right.updateAxes("thumbstick", 1, 0));
  await page.waitForFunction(() => {
    const { origin, right, extent } = window.eigenfield.field.info.viewPlane;
    const [eye] = window.eigenfield.eyes();
    return eye.reduce((sum, value, i) => sum + (value - origin[i]) * right[i], 0) / extent[0] > 0.86;
  });
  await page.waitForTimeout(500);
  const [moved] = await eyes(page);
  near(moved.x - start.x, 1, 2e-3);
  near(moved.y, 0, 1e-3);
  await close();
});

test("hands play a clip in a headset: the trigger, and the grips a second back and on", async () => {
  const { page, close } = await present("clip.glb");
  const press = (hand, button) =>
    page.evaluate(async ([hand, button]) => {
      for (const value of [1, 0]) {
        headset.controllers[hand].updateButtonValue(button, value);
        for (let i = 0; i < 3; i++) await new Promise((done) => headset.activeSession.requestAnimationFrame(done));
      }
    }, [hand, button]);
  const until = (check, given) => page.waitForFunction(check, given, { timeout: 60_000 });
  await page.evaluate(() => window.eigenfield.field.player.pause());
  await page.evaluate(() => window.eigenfield.field.player.toFrame(2));
  await press("right", "squeeze");
  await until(() => window.eigenfield.field.player.frame === 12);
  await press("left", "squeeze");
  await until(() => window.eigenfield.field.player.frame === 2);
  await press("right", "trigger");
  await until(() => window.eigenfield.field.player.frame > 3);
  await press("left", "trigger");
  await until(() => !window.eigenfield.field.player.playing);
  await close();
});
