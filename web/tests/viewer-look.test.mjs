// The viewer: what it shows, and how it compares.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { decodePng, difference, launch, scenePath } from "./harness.mjs";
import { apart, near, openViewer, picture, set, settled, state } from "./viewer-page.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

const references = () => JSON.parse(readFileSync(scenePath("references.json"), "utf8"));
const PHOTOGRAPHS = { view_1_2: "capture/view_1_2.png", view_2_2: "capture/view_2_2.png" };

test("at view-plane coordinates the picture is the software renderer's", async () => {
  const wanted = ({ scene, at, filter }) => scene === "scene.glb" && at && filter === "bicubic";
  for (const reference of references().filter(wanted)) {
    const { width, height, at, file, filter } = reference;
    const { page, close } = await openViewer(browser, "scene.glb", { width, height });
    await set(page, { background: "#000000", filter });
    await page.evaluate(([x, y]) => window.eigenfield.goTo(x, y), at);
    const { largest, mean, pixels } = difference(await picture(page), decodePng(readFileSync(scenePath(file))));
    assert.ok(pixels > 20_000, `${pixels} pixels compared`);
    assert.ok(largest <= 2 && mean <= 0.5, `${file}: ${largest} at most, ${mean} in the mean`);
    await close();
  }
});

test("the slider: fewer textures, fewer bytes, another picture, its SSIM where the file has it", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { width: 900, height: 600 });
  const all = await state(page);
  const full = await picture(page);
  const slider = page.locator(".panel input[type=range]").nth(1);
  await slider.focus();
  for (let i = 0; i < 4; i++) await page.keyboard.press("ArrowLeft");
  const two = await state(page);
  const sizes = await page.evaluate(() => window.eigenfield.field.info.bytes);
  assert.equal(two.count, 2);
  assert.equal(all.bytes, sizes.total);
  assert.equal(two.bytes, sizes.total - sizes.textures.slice(2).reduce((a, b) => a + b, 0));
  const { curve } = await page.evaluate(() => window.eigenfield.field.info.scores);
  assert.equal(two.uvSsim, curve.find(({ textures }) => textures === 2).uv_ssim);
  assert.match(await page.locator("p.figures").innerText(), /kB · UV SSIM 0\.\d{4}/);
  await page.emulateMedia({ forcedColors: "active", reducedMotion: "reduce" });
  const looks = (selector, key) => page.locator(selector).first().evaluate((one, name) => getComputedStyle(one)[name], key);
  const colours = [":checked", ":not(:checked)"].map((which) => looks(`.segments ${which} + span`, "backgroundColor"));
  assert.equal(new Set(await Promise.all(colours)).size, 2, "what is chosen is seen in the system's own colours, too");
  assert.equal(await looks("input[type=range]", "appearance"), "auto");
  await page.emulateMedia({ forcedColors: "none", reducedMotion: "reduce" });
  assert.ok(apart(full, await picture(page)) > 0.2);
  await set(page, { count: 0 });
  const none = await picture(page);
  await set(page, { view: "mean", count: Infinity });
  assert.ok(apart(none, await picture(page)) < 0.01, "no texture at all is the mean");
  await page.evaluate(() => {
    window.eigenfield.field.info.scores.curve = [];
    window.eigenfield.set({ count: 4 });
  });
  assert.equal((await state(page)).uvSsim, null);
  assert.doesNotMatch(await page.locator("p.figures").innerText(), /UV SSIM/);
  await close();
});

test("through a captured camera: its own weights and exposure, and the photograph over it", async () => {
  const options = { photographs: PHOTOGRAPHS, width: 480, height: 300 };
  const { page, close, problems } = await openViewer(browser, "scene.glb", options);
  await state(page);
  assert.ok(await page.evaluate(() => window.eigenfield.goToCamera("view_1_2")));
  const now = await state(page);
  assert.deepEqual([now.camera, now.photograph], ["view_1_2", false]);
  near(now.frame.height, 1, 1e-9);
  near(now.frame.width, (320 / 240) * (300 / 480), 1e-9);
  const drawn = await picture(page);
  await page.keyboard.press(" ");
  assert.equal((await state(page)).photograph, true);
  const photograph = await picture(page);
  const distance = difference(drawn, photograph, { background: [21, 23, 26] });
  assert.ok(distance.mean > 0 && distance.mean < 3, `photograph and drawing lie over each other: ${distance.mean}`);
  assert.match(await page.locator(".tag").innerText(), /view_1_2 · photograph/);
  await page.keyboard.press("4");
  const error = await picture(page);
  assert.equal((await state(page)).view, "error");
  assert.ok(apart(error, drawn) > 20, "the error is dark where both agree");
  await page.keyboard.press("Escape");
  const free = await state(page);
  assert.deepEqual([free.camera, free.view, free.photograph], [null, "picture", false]);
  await page.keyboard.press(" ");
  assert.equal((await state(page)).photograph, true, "from a free view: the nearest camera's");
  assert.equal((await state(page)).camera, "view_1_2");
  assert.deepEqual(problems, []);
  await close();
});

test("a divider between drawing and photograph, by hand and by keys; a scale on the error; keys show once one was pressed", async () => {
  const options = { photographs: PHOTOGRAPHS, width: 900, height: 600, hash: "#camera=view_1_2" };
  const { page, close } = await openViewer(browser, "scene.glb", options);
  await state(page);
  const caps = page.locator("kbd:visible");
  assert.equal(await caps.count(), 0);
  const drawn = await picture(page);
  await page.keyboard.press(" ");
  const photograph = await picture(page);
  assert.ok((await caps.count()) > 8);
  await page.keyboard.press("b");
  const { divider, photograph: shown, frame } = await state(page);
  assert.deepEqual([divider, shown], [0.5, true]);
  const line = page.getByRole("slider", { name: "Drawing beside photograph" });
  const mixed = async (part) => { // left of the line the drawing, right of it the photograph, to a pixel
    const now = await picture(page);
    const at = (frame.left + part * frame.width) * now.width;
    for (let i = 0; i < now.data.length; i += 3) {
      const x = (i / 3) % now.width;
      if (Math.abs(x - at) > 1) assert.equal(now.data[i], (x < at ? drawn : photograph).data[i], `column ${x}`);
    }
  };
  await mixed(0.5);
  const box = await line.boundingBox();
  await page.mouse.move(box.x + box.width / 2, 300);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 - 0.25 * frame.width * drawn.width, 300, { steps: 3 });
  await page.mouse.up();
  near((await state(page)).divider, 0.25, 0.005);
  await mixed((await state(page)).divider);
  await line.focus();
  await page.keyboard.press("ArrowRight");
  near((await state(page)).divider, 0.27, 0.005);
  assert.equal((await state(page)).camera, "view_1_2", "the eye stays");
  await page.waitForFunction(() => location.hash.includes("divider=0.27"));
  await page.keyboard.press("b");
  assert.equal((await state(page)).divider, null);
  assert.ok(await line.isHidden());
  await page.keyboard.press("4");
  await state(page);
  assert.equal(await page.locator(".scale").innerText().then((text) => text.replaceAll(/\s+/g, " ")), "0 17 34 51 grey levels off");
  await close();
});

test("without photographs the comparison is off, and says how to have it", async () => {
  const { page, close } = await openViewer(browser, "scene.glb", { width: 900, height: 600 });
  await page.evaluate(() => window.eigenfield.goTo(0.3, 0.1));
  for (const key of [" ", "b"]) await page.keyboard.press(key);
  const free = await state(page);
  assert.deepEqual([free.x, free.y, free.camera], [0.3, 0.1, null], "the eye stays where it is");
  await page.keyboard.press("]");
  await page.keyboard.press(" ");
  await page.keyboard.press("4");
  const now = await state(page);
  assert.deepEqual([now.photograph, now.view, now.camera !== null], [false, "picture", true]);
  assert.ok((await page.locator("button.wide:disabled").count()) === 2);
  assert.match(await page.locator(".panel").innerText(), /eigenfield view scene\.glb CAPTURE/);
  await close();
});

test("[ and ] step through the cameras, and round", async () => {
  const { page, close } = await openViewer(browser, "line.glb");
  await state(page);
  await page.evaluate(() => window.eigenfield.goToCamera("view_0_4"));
  await page.keyboard.press("]");
  assert.equal((await state(page)).camera, "view_0_0");
  await page.keyboard.press("[");
  assert.equal((await state(page)).camera, "view_0_4");
  await close();
});

test("every view draws something of its own", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  const seen = [await picture(page)];
  for (const options of [
    { view: "mean" },
    { view: "eigen", eigen: 0 },
    { view: "eigen", eigen: 3 },
    { view: "picture", wireframe: true },
    { wireframe: false, background: "#ffffff" },
  ]) {
    await set(page, options);
    const now = await picture(page);
    for (const before of seen) assert.ok(apart(before, now) > 0.05, JSON.stringify(options));
    seen.push(now);
  }
  await close();
});

test("a harmonised scene is given its camera's exposure only there", async () => {
  const { page, close } = await openViewer(browser, "harmonised.glb");
  const free = await picture(page);
  const name = await page.evaluate(() => window.eigenfield.field.info.names[0]);
  await page.evaluate((one) => window.eigenfield.goToCamera(one), name);
  await state(page);
  assert.equal(await page.evaluate(() => window.eigenfield.field.exposure), 0);
  assert.ok(apart(free, await picture(page)) > 1);
  await page.keyboard.press("Escape");
  await state(page);
  await picture(page);
  assert.equal(await page.evaluate(() => window.eigenfield.field.exposure), null);
  await close();
});

test("the panel describes the file; help and panel open by keys; a screenshot is a PNG of the canvas", async () => {
  const { page, close } = await openViewer(browser, "held-out.glb", { width: 900, height: 700 });
  await state(page);
  await page.locator("summary", { hasText: "About this file" }).click();
  await page.waitForSelector(".facts table");
  const text = await page.locator(".facts").innerText();
  assert.match(text, /held out/);
  assert.match(text, /GPU memory\s+[\d.]+\s[kM]B/);
  assert.match(text, /triangles/);
  await page.locator("canvas.view").focus();
  await page.keyboard.press("?");
  assert.ok(await page.locator("dialog").isVisible());
  await page.keyboard.press("Escape");
  assert.ok(await page.locator("dialog").isHidden());
  await page.keyboard.press("i");
  assert.ok(await page.locator(".panel").isHidden());
  await page.waitForFunction(() => document.querySelector("canvas.view").width === 900);
  const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("p")]);
  assert.match(download.suggestedFilename(), /^held-out-.*\.png$/);
  const saved = decodePng(readFileSync(await download.path()));
  const now = await picture(page);
  assert.deepEqual([saved.width, saved.height], [now.width, now.height]);
  assert.ok(apart(saved, now) < 0.5);
  await close();
});


test("a window that is drawn with other pixels: the picture and the map have theirs", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await settled(page);
  const session = await page.context().newCDPSession(page);
  for (const [ratio, drawn] of [[2, 2], [1.1, 1.1], [3, 2], [1, 1]]) { // no finer than 2
    const metrics = { width: 480, height: 360, deviceScaleFactor: ratio, mobile: false };
    await session.send("Emulation.setDeviceMetricsOverride", metrics);
    await page.waitForFunction(
      (finer) => [...document.querySelectorAll(".stage canvas")].every(
        (canvas) => Math.abs(canvas.width - finer * canvas.clientWidth) <= 1,
      ), drawn,
    );
    await settled(page);
    const { width, height } = await page.evaluate(() => window.eigenfield.pixels());
    assert.deepEqual([width, height], [480, 360].map((side) => Math.floor(side * drawn)));
  }
  await close();
});

test("textures of a part of the atlas are said to have its size", async () => {
  const { page, close } = await openViewer(browser, "layered.glb", { width: 900, height: 700 });
  await state(page);
  await page.locator("summary", { hasText: "About this file" }).click();
  const planes = await page.evaluate(() => window.eigenfield.field.info.planes);
  const parts = planes.flatMap(({ bases }) => bases).filter(({ size, grid }) => size.join() !== grid.join());
  assert.ok(parts.length > 0);
  await page.locator(".facts").waitFor();
  const text = await page.locator(".facts").innerText();
  for (const { textures, size } of parts) assert.ok(text.includes(`${textures} eigen textures of ${size.join(" × ")}`), text);
  await close();
});
