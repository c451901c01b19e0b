// What `eigenfield view` serves, in a browser: the real command, its own policy, photographs made on demand.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { view } from "./command.mjs";
import { difference, launch, openPage, scenePath } from "./harness.mjs";
import { apart, picture, set, state } from "./viewer-page.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

/** Opens what the command serves; `close` ends the command by Ctrl-C too, which is no failure. */
async function open(args, options) {
  const command = await view(...args);
  const asked = [];
  let opened;
  try {
    opened = await openPage(browser, null, options);
    opened.page.on("request", (request) => asked.push(request.url()));
    await opened.page.goto(command.address);
    await opened.page.waitForFunction(() => window.eigenfield);
  } catch (error) {
    await command.stop();
    throw error;
  }
  const close = async () => {
    try {
      await opened.close();
    } finally {
      assert.equal(await command.stop(), 0, "Ctrl-C is how it ends");
    }
    const elsewhere = asked.filter((url) => !url.startsWith(command.address) && !/^(blob|data):/.test(url));
    assert.deepEqual(elsewhere, [], "nothing is fetched from elsewhere");
  };
  return { page: opened.page, asked, close };
}

test("a clip as a folder plays, its groups and its sound from files of their own", async () => {
  const { page, asked, close } = await open([scenePath("folder")]);
  await page.waitForFunction(() => window.eigenfield.state().status === "ready");
  await page.mouse.click(240, 180); // somebody is there: it may be heard
  await page.evaluate(() => window.eigenfield.field.player.play());
  await page.waitForFunction(() => window.eigenfield.field.player.sound.time !== null, null, { timeout: 60_000 });
  await page.evaluate(() => window.eigenfield.field.player.toFrame(9));
  assert.equal(await page.evaluate(() => window.eigenfield.field.player.frame), 9);
  assert.equal((await state(page)).title, "folder");
  assert.ok(asked.some((url) => url.endsWith("/groups/00001.eftg")));
  await close();
});

test("a scene beside its photographs: drawn, flipped, compared; nothing from elsewhere; ended by Ctrl-C", async () => {
  const args = [scenePath("photographed.glb"), scenePath("capture")];
  const { page, asked, close } = await open(args, { width: 480, height: 360 });
  const now = await state(page);
  assert.deepEqual([now.status, now.loaded, now.total, now.title], ["ready", 6, 6, "photographed.glb"]);
  assert.ok(new Set((await picture(page)).data).size > 50, "something is drawn");
  assert.ok(!asked.some((url) => url.includes("photographs")), "photographs come when they are asked for");

  await page.evaluate(() => window.eigenfield.goToCamera("view_1_2.png"));
  const drawn = await picture(page);
  const flipped = await set(page, { photograph: true });
  assert.deepEqual([flipped.camera, flipped.photograph, flipped.message], ["view_1_2.png", true, null]);
  const photograph = await picture(page);
  assert.ok(asked.some((url) => url.endsWith("/photographs/7")));
  const { mean } = difference(drawn, photograph, { background: [21, 23, 26] }); // a quarter of it is 10 brighter
  assert.ok(mean > 0.5 && mean < 4, `photograph and drawing lie over each other: ${mean}`);
  const error = await set(page, { view: "error" });
  assert.equal(error.view, "error");
  assert.ok(apart(await picture(page), drawn) > 20, "the error is dark where both agree");
  await close();
});

test("a plain glTF file is served as one", async () => {
  const { page, close } = await open([scenePath("plain.glb")], { width: 480, height: 360 });
  const now = await state(page);
  assert.deepEqual([now.status, now.mode, now.total], ["ready", "orbit", 0]);
  assert.ok(new Set((await picture(page)).data).size > 50);
  await close();
});
