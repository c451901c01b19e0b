// The viewer in another engine than Chromium's: the same tests for each.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { difference, launch } from "./harness.mjs";
import { openViewer, picture, state } from "./viewer-page.mjs";

const GROUND = { background: [21, 23, 26] };

const SIZE = { width: 480, height: 360 };
const PLACE = "#x=0.5&y=-0.25";
/** The page in a frame of the size that Chromium's window has. */
const FRAME = {
  body:
    '<!doctype html><meta charset="utf-8"><title>frame</title>' +
    `<iframe src="/${PLACE}" width="${SIZE.width}" height="${SIZE.height}" style="border: 0"></iframe>` +
    '<script>Object.defineProperty(window, "eigenfield", { get: () => frames[0].eigenfield });</script>',
  type: "text/html; charset=utf-8",
};

/** start: of engines.mjs. */
export function testEngine(start) {
  let browser;
  let engine;
  before(async () => {
    browser = await launch();
    engine = await start();
  });
  after(async () => {
    await engine?.close();
    await browser.close();
  });

  /** What the engine shows of a scene, and how far its picture is from Chromium's. */
  async function drawn(scene) {
    const options = { ...SIZE, hash: PLACE, routes: { "/frame": FRAME } };
    const { page, server, close } = await openViewer(browser, scene, options);
    const expected = await picture(page);
    await engine.open(`${server.url}/frame`);
    await engine.evaluate(async () => {
      while (!window.eigenfield) await new Promise((resolve) => setTimeout(resolve, 50));
    });
    const found = { ...(await state(engine)), ...difference(await picture(engine), expected, GROUND) };
    await close();
    assert.ok(found.pixels > 50_000, `${found.pixels} pixels compared`);
    return found;
  }

  test("a scene opens at the place that its address names, and is drawn as Chromium draws it", async () => {
    const { status, loaded, message, x, y, mean, largest } = await drawn("scene.glb");
    assert.deepEqual([status, loaded, message, x, y], ["ready", 6, null, 0.5, -0.25]);
    assert.ok(mean <= 0.5 && largest <= 4, `mean ${mean}, largest ${largest}`); // Chromium's own: 2 from the software's
  });

  for (const name of ["coded.glb", "fitted.glb", "sheets-coded.glb"]) {
    test(`${name}: AV1 of 10 bits, or 8 of them where the engine gives no more`, async () => {
      const { status, message, mean, largest } = await drawn(name);
      assert.deepEqual([status, message], ["ready", null]);
      assert.ok(mean <= 0.5 && largest <= 4, `mean ${mean}, largest ${largest}`);
      const decoder = await engine.evaluate(() => "ImageDecoder" in frames[0]);
      assert.ok(decoder || mean >= 0.15, `mean ${mean}, as if all ten bits were there`);
    });
  }

  for (const name of ["clip.glb", "clip-sheets.glb"]) {
    test(`${name} plays, each frame as Chromium draws it, or the first one of each group; the panel says what is shown`, async (context) => {
      const options = { ...SIZE, hash: PLACE, config: { ui: "full" }, routes: { "/frame": FRAME } };
      const { page, server, close } = await openViewer(browser, name, options);
      await engine.open(`${server.url}/frame`);
      const fallbacks = await engine.evaluate(async () => {
        const errors = (window.errors = []);
        for (const kind of ["error", "unhandledrejection"]) {
          frames[0].addEventListener(kind, ({ message, reason }) => errors.push(String(message ?? reason)));
        }
        const later = () => new Promise((resolve) => setTimeout(resolve, 50));
        while (window.eigenfield?.state().status !== "ready") await later();
        const { player } = window.eigenfield.field;
        player.play();
        while (window.eigenfield.state().message === null && player.frame < 5) await later();
        player.pause();
        return player.fallbacks;
      });
      const { message } = await engine.evaluate(() => window.eigenfield.state());
      assert.equal(message, null, message?.text);
      const keys = fallbacks.includes("keys");
      for (const frame of [14, 3, 24, 5]) {
        const shown = (one, frame) =>
          one.evaluate(async (frame) => {
            const { player } = window.eigenfield.field;
            await player.toFrame(frame);
            return player.frame;
          }, frame);
        const stands = await shown(engine, frame);
        assert.equal(stands, keys ? { 14: 13, 3: 0, 24: 13, 5: 5 }[frame] : frame);
        await shown(page, stands);
        const { mean, largest } = difference(await picture(engine), await picture(page), GROUND);
        assert.ok(mean <= 0.5 && largest <= 4, `frame ${frame}: mean ${mean}, largest ${largest}`);
      }
      const said = await engine.evaluate(() => frames[0].document.querySelector(".brief").textContent);
      for (const [kind, text] of Object.entries({ keys: "key pictures", bits: "8 of 10 bits", textures: "no eigen textures" })) {
        assert.equal(said.includes(text), fallbacks.includes(kind), `${kind}: ${said}`);
      }
      context.diagnostic(`${name}: ${fallbacks.join() || "all"}`);
      assert.deepEqual(await engine.evaluate(() => window.errors), []);
      await close();
    });
  }
}
