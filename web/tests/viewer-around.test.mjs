// The viewer with captures whose cameras stand around a thing: orbit, no plane; and how cameras are found in the list.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch } from "./harness.mjs";
import { apart, near, openViewer, picture, settled, state } from "./viewer-page.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

const drag = async (page, from, to, button = "left") => {
  await page.mouse.move(...from);
  await page.mouse.down({ button });
  await page.mouse.move(...to, { steps: 3 });
  await page.mouse.up({ button });
};

/** Length of a vector, and the angle between two. */
const length = (a) => Math.hypot(...a);
const angle = (a, b) => Math.acos(a.reduce((sum, value, i) => sum + value * b[i], 0) / length(a) / length(b));
const eye = async (page) => {
  await settled(page);
  return (await page.evaluate(() => window.eigenfield.eyes()))[0];
};

test("it opens in orbit, where the reference camera stood, and knows no plane", async () => {
  const { page, close } = await openViewer(browser, "around.glb", { width: 900, height: 600 });
  const now = await state(page);
  assert.deepEqual([now.status, now.mode, now.outside, now.loaded], ["ready", "orbit", false, 4]);
  const { centre } = await page.evaluate(() => window.eigenfield.field.info.cameras[0]);
  near(length((await eye(page)).map((value, i) => value - centre[i])), 0, 1e-3);
  assert.ok(new Set((await picture(page)).data).size > 50);
  await page.keyboard.press("o");
  await page.evaluate(() => window.eigenfield.set({ mode: "plane" }));
  assert.equal((await state(page)).mode, "orbit");
  assert.ok(await page.locator("input[value=plane]").isDisabled());
  assert.equal(await page.getByRole("button", { name: /^Orbit/ }).count(), 0, "no way to switch to a plane");
  await close();
});

test("turning along the ring stays inside; above it is outside; Escape comes back to the nearest camera", async () => {
  const { page, close } = await openViewer(browser, "around.glb");
  const start = await eye(page);
  await drag(page, [200, 180], [278, 180]); // 78 of 360 pixels: 0.52 radians, to the next camera
  const along = await eye(page);
  near(angle(start, along), 0.52, 0.03);
  near(along[1], start[1], 0.02);
  assert.equal((await state(page)).outside, false);
  await drag(page, [200, 100], [200, 320]);
  assert.equal((await state(page)).outside, true);
  assert.match(await page.locator(".cue").innerText(), /Outside the captured views/);
  await page.keyboard.press("Escape");
  const back = await state(page);
  assert.deepEqual([back.mode, back.camera, back.outside], ["orbit", null, false]);
  near(length(await eye(page)), 4, 0.01);
  await close();
});

test("right drag shifts, double click turns about the point under it", async () => {
  const { page, close } = await openViewer(browser, "around.glb");
  const start = await eye(page);
  await drag(page, [240, 180], [300, 180], "right");
  const shifted = await eye(page);
  assert.ok(length(shifted.map((value, i) => value - start[i])) > 0.2);
  near(shifted[1], start[1], 1e-3);
  await page.keyboard.press("Home");
  const before = await picture(page);
  await page.mouse.dblclick(300, 200);
  await drag(page, [240, 180], [250, 180]);
  assert.ok(apart(before, await picture(page)) > 0.2);
  await close();
});

test("cameras by name, numbers by value, held-out ones marked; N goes to the nearest", async () => {
  const { page, close } = await openViewer(browser, "around.glb", { width: 900, height: 600 });
  await settled(page);
  const options = (await page.locator("select option").allTextContents()).slice(1);
  assert.deepEqual(options.map((text) => Number(/\d+/.exec(text)[0])), [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
  assert.deepEqual(options.filter((text) => text.includes("held out")).map((text) => text.split(" ")[0]), [
    "round4.png", "round8.png",
  ]);
  assert.match(await page.locator(".held").innerText(), /2 held out/);
  await drag(page, [200, 180], [290, 180]);
  const at = await eye(page);
  await page.keyboard.press("n");
  const { camera } = await state(page);
  const centres = await page.evaluate(() => {
    const { names, cameras } = window.eigenfield.field.info;
    return cameras.map(({ centre }, i) => [names[i], centre]);
  });
  const away = centres.map(([name, centre]) => [name, length(at.map((value, i) => value - centre[i]))]);
  assert.equal(camera, away.sort((a, b) => a[1] - b[1])[0][0]);
  await close();
});

test("a grid is listed by its rows, each from the left", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { width: 900, height: 600 });
  await settled(page);
  const groups = await page.locator("select optgroup").evaluateAll((all) =>
    all.map((group) => [group.label, [...group.children].map((option) => option.textContent)]));
  assert.deepEqual(groups.map(([label]) => label), [1, 2, 3, 4, 5].map((row) => `Row ${row} of 5`));
  groups.forEach(([, names], row) => assert.deepEqual(names, [0, 1, 2, 3, 4].map((column) => `view_${row}_${column}`)));
  await close();
});

test("the panel shows quality, bytes and memory; ?memory= keeps to so many megabytes and says so", async () => {
  const wide = { width: 900, height: 600 };
  const full = await openViewer(browser, "scene.glb", wide);
  await settled(full.page);
  const words = await full.page.locator(".panel header").innerText();
  assert.match(words, /25 cameras · 6 eigen textures · [\d.]+\skB/);
  assert.match(words, /encoded views\s+33\.25\sdB\s· SSIM\s0\.9510/);
  assert.match(words, /GPU memory\s+[\d.]+\s[kM]B/);
  assert.equal(await full.page.evaluate(() => window.eigenfield.field.limitation), null);
  await full.close();
  const { page, close } = await openViewer(browser, "scene.glb", { ...wide, query: "?memory=0.5" });
  const now = await state(page);
  assert.equal(now.status, "ready");
  const { limitation, gpuBytes } = await page.evaluate(() => {
    const { limitation, gpuBytes } = window.eigenfield.field;
    return { limitation, gpuBytes };
  });
  assert.match(limitation, /0\.5 MB may be used/);
  assert.ok(gpuBytes <= 5e5 || now.loaded === 0, `${gpuBytes} bytes`);
  assert.ok((await page.locator(".panel").innerText()).includes(limitation));
  await close();
  const german = await openViewer(browser, "scene.glb", { ...wide, query: "?memory=0.5&lang=de" });
  await settled(german.page);
  const parts = "Eigentexturen haben 33 % ihrer Breite und Höhe und die mittlere Textur hat 50 % ihrer Breite und Höhe";
  const warnings = await german.page.locator(".panel .warning:visible").allInnerTexts();
  assert.deepEqual(warnings, [`Der Grafikspeicher reicht nicht für alles: ${parts}.`]);
  await german.close();
});

test("tilting the device moves the eye, from however it is held", async () => {
  const init = () => {
    const real = window.matchMedia.bind(window);
    window.matchMedia = (query) => (query === "(pointer: coarse)" ? { matches: true } : real(query));
  };
  const { page, close } = await openViewer(browser, "scene.glb", {
    init, context: { permissions: ["accelerometer", "gyroscope", "magnetometer"] },
  });
  const start = await state(page);
  const tilted = (angles) => void dispatchEvent(new DeviceOrientationEvent("deviceorientation", angles));
  const lean = (beta, gamma) => page.evaluate(tilted, { beta, gamma });
  await lean(50, 10);
  assert.equal((await state(page)).x, start.x, "not before it is asked for");
  await page.getByRole("button", { name: /tilting/ }).click();
  await page.waitForSelector("[aria-label*=tilting][aria-pressed=true]"); // the browser is asked first
  await lean(50, 10);
  assert.equal((await state(page)).x, start.x);
  await lean(46.4, 19);
  const now = await state(page);
  near(now.x - start.x, 0.5, 0.01); // 9 of 18 degrees
  near(now.y - start.y, -0.2, 0.01);
  await page.keyboard.press("Home");
  await lean(46.4, 19);
  near((await state(page)).x, start.x, 1e-9); // from where it was led, as the device is held now
  await lean(50, 10);
  near((await state(page)).x, start.x - 0.5, 0.01);
  await lean(46.4, 28);
  near((await state(page)).x, now.x, 0.01);
  await page.getByRole("button", { name: /tilting/ }).click();
  await lean(50, 10);
  near((await state(page)).x, now.x, 0.01);
  await close();
});

test("who asked for less motion is not glided", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  const before = await state(page);
  await page.evaluate(() => window.eigenfield.goTo(0.8, 0.1));
  const now = await state(page);
  assert.equal(now.x, 0.8);
  assert.ok(now.frames - before.frames <= 3, `${now.frames - before.frames} frames`);
  await close();
});
