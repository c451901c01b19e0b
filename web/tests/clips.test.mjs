// Clips in Chromium: each frame that is played shows its number in two ways, whatever is sought and however fast it
// plays; its codes are those that Python decodes; and no frame of the browser's decoder stays open.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { scenePath, startLab } from "./harness.mjs";

const { groups, rate, bits, textures, codes } = JSON.parse(readFileSync(scenePath("clip.json"), "utf8"));
const FRAMES = groups.reduce((a, b) => a + b);
const DURATION = (1000 * FRAMES * rate[1]) / rate[0]; // milliseconds
let lab;
before(async () => (lab = await startLab()));
after(() => lab?.close());

/** Loads the clip as `window.field`; `window.read` draws and tells the number of the player, of the mean and of the
 * textures; `window.played` collects that of each frame. */
async function openClip(name = "clip.glb", options = {}) {
  const opened = await lab.open(options);
  await opened.page.evaluate(
    async ([url, bits, textures]) => {
      const { gltf, field } = await window.lab.loadEigenfield(url);
      const { lab } = window;
      lab.show(gltf);
      field.camera = field.info.cameras.length - 1;
      const view = () => lab.drawView(field, field.info.cameras[field.camera]);
      view();
      await field.complete;
      const places = [
        ...Array.from({ length: bits }, (_, bit) => [(bit + 0.5) / bits, 0.25]),
        ...Array.from({ length: textures }, (_, index) => [(index + 0.5) / textures, 0.75]),
      ];
      window.field = field;
      window.read = () => {
        view();
        const shades = lab.greens(lab.pixelsOf(field, places));
        const columns = shades.slice(bits);
        const byMean = shades.slice(0, bits).reduce((sum, shade, bit) => sum + (shade > 128 ? 2 ** bit : 0), 0);
        return [field.player.frame, byMean, columns.indexOf(Math.max(...columns)), shades.join()];
      };
      window.played = [];
      field.player.addEventListener("frame", () => window.played.push(window.read()));
    },
    [name, bits, textures],
  );
  return opened;
}

function assertSame([frame, byMean, texture, shades]) {
  assert.deepEqual([byMean, texture], [frame, frame % textures], `frame ${frame} shows ${byMean}, ${texture}: ${shades}`);
}

test("the first frame is there before anything plays", async () => {
  const { page, close } = await openClip();
  assertSame(await page.evaluate(() => window.read()));
  const { player, ...found } = await page.evaluate(() => {
    const { frames, rate, duration, first, time, playing, open, loop, speed } = window.field.player;
    return { player: { frames, rate, duration, first, time, playing, open, loop, speed }, total: window.field.total };
  });
  const expected = { frames: FRAMES, rate: rate[0] / rate[1], duration: DURATION / 1000, first: 0, time: 0 };
  assert.deepEqual(player, { ...expected, playing: false, open: 0, loop: true, speed: 1 });
  assert.equal(found.total, textures);
  await close();
});

for (const speed of [1, 2, 0.5]) {
  test(`every frame that is played at speed ${speed} shows its number two ways, across groups and from the end on`, async () => {
    const { page, close } = await openClip();
    const { played, open } = await page.evaluate(
      async ([pace, frames]) => {
        const { player } = window.field;
        player.speed = pace;
        player.play();
        const turns = () => window.played.filter(([frame], i) => i && frame < window.played[i - 1][0]).length;
        while (turns() < 1 || window.played.length < frames) await new Promise((resolve) => setTimeout(resolve, 50));
        player.pause();
        while (player.open) await new Promise((resolve) => setTimeout(resolve, 50));
        return { played: window.played, open: player.open };
      },
      [speed, 16],
    );
    played.forEach(assertSame);
    const steps = played.slice(1).map(([frame], i) => (frame - played[i][0] + FRAMES) % FRAMES);
    assert.ok(steps.every((step) => step > 0 && step < FRAMES / 2), `steps of ${steps}`);
    const starts = groups.map((_, i) => groups.slice(0, i).reduce((a, b) => a + b, 0));
    const seen = new Set(played.map(([frame]) => starts.findLastIndex((start) => start <= frame)));
    assert.ok(seen.size >= groups.length - 1, `groups ${[...seen]}`); // one of them has a single frame
    assert.equal(open, 0);
    await close();
  });
}

test("after fifty random seeks, steps both ways and scrubbing, the frame that was asked for is shown", async () => {
  const { page, close } = await openClip();
  let seed = 7;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  const wanted = Array.from({ length: 50 }, () => Math.floor(FRAMES * random()));
  const found = await page.evaluate(
    async ([frames, rate]) => {
      const { player } = window.field;
      const list = [];
      for (const frame of frames) {
        await player.seek((frame + 0.3) / rate);
        list.push(window.read());
      }
      for (const step of [1, 1, -1, -3, 2, -1]) {
        await player.step(step);
        list.push(window.read());
      }
      const scrubbed = frames.slice(0, 20).map((frame) => player.toFrame(frame));
      await scrubbed.at(-1);
      list.push(window.read());
      return { list, played: window.played, open: player.open };
    },
    [wanted, rate[0] / rate[1]],
  );
  found.list.forEach(assertSame);
  found.played.forEach(assertSame);
  assert.deepEqual(found.list.slice(0, 50).map(([frame]) => frame), wanted);
  let at = wanted.at(-1);
  const steps = [1, 1, -1, -3, 2, -1].map((step) => (at = (at + step + FRAMES) % FRAMES));
  assert.deepEqual(found.list.slice(50, 56).map(([frame]) => frame), steps);
  assert.equal(found.list.at(-1)[0], wanted[19]);
  assert.equal(found.open, 0);
  await close();
});

test("the codes of every frame are those that Python decodes", async () => {
  const { page, close } = await openClip();
  const found = await page.evaluate(async (count) => {
    const digest = async ({ data, width, height, stride }) => {
      const whole = new Uint8Array(2 * width * height);
      for (let y = 0; y < height; y++) whole.set(data.subarray(y * stride, y * stride + 2 * width), 2 * width * y);
      const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", whole));
      return Array.from(hash, (byte) => byte.toString(16).padStart(2, "0")).join("");
    };
    const list = [];
    for (let frame = 0; frame < count; frame++) {
      await window.field.player.toFrame(frame);
      list.push(await Promise.all(window.field.source.films.map(digest)));
    }
    return list;
  }, FRAMES);
  assert.deepEqual(found, codes);
  await close();
});

test("a clip that does not repeat ends with its last frame, and begins anew", async () => {
  const { page, close } = await openClip();
  const found = await page.evaluate(async (frames) => {
    const { player } = window.field;
    player.loop = false;
    await player.toFrame(frames - 4);
    player.play();
    const changed = () => new Promise((resolve) => player.addEventListener("change", resolve, { once: true }));
    while (player.playing) await changed();
    const last = window.read();
    player.play();
    while (player.waiting) await changed();
    return { last, after: window.read(), played: window.played };
  }, FRAMES);
  assert.equal(found.last[0], FRAMES - 1);
  [found.last, found.after, ...found.played].forEach(assertSame);
  assert.ok(found.after[0] < 4);
  await close();
});

test("a graphics context that was lost comes back with the frame that was shown", async () => {
  const { page, close } = await openClip("clip.glb", { allowed: /Context (Lost|Restored)/ });
  const found = await page.evaluate(async () => {
    await window.field.player.toFrame(14);
    await window.lab.loseContext(window.field);
    return window.read();
  });
  assert.equal(found[0], 14);
  assertSame(found);
  await close();
});
