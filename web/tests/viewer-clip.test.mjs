// A clip in the built viewer: its bar, its keys, its time in the address, and what is said where nothing plays it.

import assert from "node:assert/strict";
import { cpSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { eigenfield } from "./command.mjs";
import { launch, openPage, scenePath } from "./harness.mjs";
import { holdGamepad, openViewer, picture, settled } from "./viewer-page.mjs";

const CLIP = "clip.glb";
const FRAMES = 25;
let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

const state = (page) => page.evaluate(() => window.eigenfield.state());
const until = (page, check, given) => page.waitForFunction(check, given, { timeout: 60_000 });
const frame = (page) => page.evaluate(() => window.eigenfield.field.player.frame);
const opened = (page) => until(page, () => window.eigenfield.state().status === "ready");

test("a clip plays when it is opened, while the eye moves, and stands still where less motion is wished for", async () => {
  const moving = await openViewer(browser, CLIP, { glide: true });
  await until(moving.page, () => window.eigenfield.field?.player.frame > 1);
  assert.equal((await state(moving.page)).playing, true);
  const { x } = await state(moving.page);
  await moving.page.keyboard.down("ArrowRight"); // held: a slow page sees no short press
  await until(moving.page, (before) => window.eigenfield.state().x !== before, x);
  await moving.page.keyboard.up("ArrowRight");
  assert.equal((await state(moving.page)).playing, true);
  await settled(moving.page);
  const { playing, time } = await state(moving.page);
  assert.equal(playing, false);
  assert.equal(time, (await frame(moving.page)) / 10);
  await moving.close();
  const { page, close } = await openViewer(browser, CLIP);
  await opened(page);
  assert.deepEqual([(await state(page)).playing, (await state(page)).time], [false, 0]);
  await close();
});

test("the folder of a clip is dropped on the page, and one that lacks a file says which", async () => {
  const lacking = mkdtempSync(join(tmpdir(), "eigenfield-clip-"));
  cpSync(scenePath("folder"), lacking, { recursive: true });
  rmSync(join(lacking, "groups/00001.eftg"));
  const { page, close } = await openViewer(browser, CLIP);
  const devtools = await page.context().newCDPSession(page);
  const dropFolder = async (path) => {
    const data = { items: [], files: [path], dragOperationsMask: 1 };
    for (const type of ["dragEnter", "dragOver", "drop"]) await devtools.send("Input.dispatchDragEvent", { type, x: 200, y: 150, data });
  };
  await opened(page);
  await dropFolder(scenePath("folder"));
  await until(page, () => document.title.startsWith("folder"));
  for (const number of [7, 13]) {
    await page.evaluate((number) => window.eigenfield.field.player.toFrame(number), number);
    assert.equal(await frame(page), number);
  }
  await dropFolder(lacking);
  await until(page, () => document.title.startsWith("eigenfield-clip-"));
  const said = await page.evaluate(() => window.eigenfield.field.player.seek(0.9).then(() => "", ({ message }) => message));
  assert.match(`${said} ${await page.locator(".stage").innerText()}`, /groups\/00001\.eftg/);
  await close();
  rmSync(lacking, { recursive: true });
});

for (const ui of ["plain", "full"]) {
  test(`bar and keys of a clip (${ui})`, async () => {
    const { page, close } = await openViewer(browser, CLIP, { config: { ui }, width: 800, height: 600 });
    await opened(page);
    const bar = page.getByRole("group", { name: "Playback" });
    await bar.getByRole("button", { name: "Play", exact: true }).click();
    await until(page, () => window.eigenfield.field.player.frame > 1);
    await bar.getByRole("button", { name: "Pause" }).click();
    assert.equal((await state(page)).playing, false);
    const place = bar.getByRole("slider", { name: "Time" });
    await place.fill("7");
    await until(page, () => window.eigenfield.field.player.frame === 7);
    assert.equal(await place.getAttribute("aria-valuetext"), "0.70\u00a0s");
    const [start, end] = JSON.parse(readFileSync(scenePath("clip.json"), "utf8")).places[1];
    const facts = [["frame", "8 of 25\u00a0· 10\u00a0Hz"], ["group", `2 of 4\u00a0· ${end - start}\u00a0B`]];
    for (const [name, value] of facts) {
      const row = page.getByRole("row", { name: `${name} ${value}` });
      await row.waitFor({ state: ui === "full" ? "visible" : "hidden" }); // guests see no words
    }
    await place.press("ArrowRight");
    await until(page, () => window.eigenfield.field.player.frame === 8);
    await page.keyboard.press(",");
    await until(page, () => window.eigenfield.field.player.frame === 7);
    await page.keyboard.press(".");
    await until(page, () => window.eigenfield.field.player.frame === 8);
    await page.keyboard.press("]");
    assert.equal(await bar.getByRole("button", { name: /Speed/ }).textContent(), "2×");
    for (let i = 0; i < 3; i++) await page.keyboard.press("[");
    assert.equal(await bar.getByRole("button", { name: /Speed/ }).textContent(), "0.25×");
    await page.keyboard.press(" ");
    assert.equal((await state(page)).playing, true);
    await page.keyboard.press(" ");
    assert.equal((await state(page)).playing, false);
    await bar.getByRole("button", { name: "Repeat" }).click();
    assert.equal(await page.evaluate(() => window.eigenfield.field.player.loop), false);
    await close();
  });
}

test("the address says when, and an address that does is opened there", async () => {
  const { page, close } = await openViewer(browser, CLIP, { hash: "#x=0&y=0&t=1.25", glide: true });
  await until(page, () => window.eigenfield.field?.player.frame === 13);
  assert.equal((await state(page)).playing, false);
  await page.keyboard.press(".");
  await until(page, () => /[#&]t=1.4(&|$)/.test(location.hash));
  await close();
});

test("a still scene has no bar, and its keys do what they did", async () => {
  const { page, close } = await openViewer(browser, "scene.glb");
  await opened(page);
  assert.equal(await page.getByRole("group", { name: "Playback" }).count(), 0);
  await page.keyboard.press("]");
  await until(page, () => window.eigenfield.state().camera !== null);
  assert.equal((await state(page)).time, null);
  await close();
});

const noVideos = () => delete globalThis.VideoDecoder;
const LACKS = {
  "without a decoder of videos": noVideos,
  "with a decoder that refuses AV1": () => (globalThis.VideoDecoder.isConfigSupported = async () => ({ supported: false })),
};
for (const [name, init] of Object.entries(LACKS)) {
  test(`${name} key pictures are shown in full, and the panel says why`, async () => {
    const { page, close } = await openViewer(browser, CLIP, { init, width: 800, height: 600, config: { ui: "full" } });
    await opened(page);
    assert.equal(await page.evaluate(() => window.eigenfield.field.loaded), 4);
    await page.keyboard.press(" ");
    await until(page, () => window.eigenfield.field.player.frame === 5);
    await until(page, () => window.eigenfield.field.player.frame === 13);
    await page.getByRole("row", { name: /shown here key pictures: this browser decodes no AV1/ }).waitFor();
    const { message, playing, status } = await state(page);
    assert.deepEqual([message, playing, status], [null, true, "ready"]);
    await close();
  });
}

test("without a secure context key pictures are shown, and the panel says where the clip plays", async () => {
  const elsewhere = await launch({ args: ["--host-resolver-rules=MAP clip.test 127.0.0.1"] });
  const { server, close } = await openViewer(browser, CLIP, { config: { ui: "full" } });
  const { page, ...opening } = await openPage(elsewhere, server.url.replace("127.0.0.1", "clip.test"), { width: 800, height: 600 });
  await until(page, () => window.eigenfield?.state().status === "ready");
  assert.deepEqual(await page.evaluate(() => [isSecureContext, typeof VideoDecoder]), [false, "undefined"]);
  await page.evaluate(() => window.eigenfield.field.player.play());
  await until(page, () => window.eigenfield.field.player.frame === 13);
  await page.getByRole("row", { name: /shown here key pictures: browsers play clips from https and localhost alone/ }).waitFor();
  await opening.close();
  await elsewhere.close();
  await close();
});

test("where pictures of AV1 are not decoded either, the file's own picture is shown, and a line says why", async () => {
  const init = () => {
    delete globalThis.VideoDecoder;
    delete globalThis.ImageDecoder;
    const { createImageBitmap } = window;
    window.createImageBitmap = (from, ...how) =>
      from instanceof Blob && /avif/.test(from.type) ? Promise.reject(new DOMException("no", "InvalidStateError")) : createImageBitmap(from, ...how);
  };
  const { page, close } = await openViewer(browser, CLIP, { init, width: 800, height: 600, config: { ui: "full" } });
  await opened(page);
  const { message, time } = await state(page);
  assert.deepEqual([message.code, time], ["codec", null]);
  assert.match(message.text, /decodes no AV1.*The first frame is shown/);
  assert.match(await page.locator(".panel header").textContent(), /The first frame is shown/);
  assert.ok((await picture(page)).data.some((value) => value > 100), "the picture");
  await close();
});

test("a finger on the bar: the clip rests while it is dragged, shows where it is, and plays on", async () => {
  const { page, close } = await openViewer(browser, CLIP, { glide: true, context: { hasTouch: true }, width: 800, height: 600 });
  await until(page, () => window.eigenfield.field?.player.frame > 1);
  const place = page.getByRole("slider", { name: "Time" });
  const { x, y, width, height } = await place.boundingBox();
  const session = await page.context().newCDPSession(page);
  const touch = (type, part) => {
    const touchPoints = part === undefined ? [] : [{ x: x + part * width, y: y + height / 2 }];
    return session.send("Input.dispatchTouchEvent", { type, touchPoints });
  };
  await touch("touchStart", 0.1);
  await until(page, () => !window.eigenfield.field.player.playing); // or it passes the place by itself
  for (const part of [0.2, 0.4, 0.6, 0.8]) {
    await touch("touchMove", part);
    await until(page, (near) => Math.abs(window.eigenfield.field.player.frame - near) < 2, part * (FRAMES - 1));
    assert.equal((await state(page)).playing, false);
    assert.ok(Math.abs((await place.inputValue()) - part * (FRAMES - 1)) < 2);
  }
  await touch("touchEnd");
  await until(page, () => window.eigenfield.state().playing);
  await close();
});

test("a gamepad plays a clip: A, the cross and the triggers", async () => {
  const { page, close } = await openViewer(browser, CLIP, { init: holdGamepad });
  await opened(page);
  await page.evaluate(() => window.dispatchEvent(new Event("gamepadconnected")));
  const press = (button) =>
    page.evaluate(async (button) => {
      for (const pressed of [true, false]) {
        window.pad.buttons[button].pressed = pressed;
        for (let i = 0; i < 3; i++) await new Promise(requestAnimationFrame);
      }
    }, button);
  const shows = (number) => until(page, (number) => window.eigenfield.field.player.frame === number, number);
  await press(15);
  await shows(1);
  await press(7); // a second of ten frames
  await shows(11);
  await press(14);
  await shows(10);
  await press(6);
  await shows(0);
  await press(0);
  await until(page, () => window.eigenfield.field.player.frame > 1);
  assert.equal((await page.evaluate(() => window.eigenfield.state())).playing, true);
  await press(0);
  await until(page, () => !window.eigenfield.state().playing);
  await close();
});

test("a page that `export` wrote plays from the disk", async () => {
  const file = scenePath("clip-page.html");
  eigenfield("export", scenePath(CLIP), "-o", file, "--overwrite", "--quiet");
  assert.ok(readFileSync(file).length > 0);
  const { page, close } = await openPage(browser, pathToFileURL(file).href);
  await until(page, () => window.eigenfield?.field?.player.frame > 2);
  const seen = new Set();
  while (seen.size < 3) seen.add(await frame(page));
  assert.ok(Math.max(...seen) < FRAMES);
  await close();
});
