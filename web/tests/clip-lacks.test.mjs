// Clips where the browser has less than it takes, or fails midway: what is shown in its place, and what is said of it.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { startLab } from "./harness.mjs";
import { assertSame, facts, FRAMES, groupOf, openNumbered, playThrough, STARTS } from "./numbered-clip.mjs";

const { groups } = facts;
const LONG = STARTS[3] + groups[3] - 1; // the last frame of the longest group
let lab;
before(async () => (lab = await startLab()));
after(() => lab?.close());

const openClip = (init, options = {}) => openNumbered(lab, options.name ?? "clip.glb", { init, ...options });
const fallbacks = (page) => page.evaluate(() => window.field.player.fallbacks);
const sought = (page, frames) =>
  page.evaluate(async (frames) => {
    const list = [];
    for (const frame of frames) {
      await window.field.player.toFrame(frame);
      list.push(window.read());
    }
    return list;
  }, frames);

const KEYS = {
  "no decoder of videos": () => delete globalThis.VideoDecoder,
  "a decoder that refuses AV1": () => (VideoDecoder.isConfigSupported = async () => ({ supported: false })),
  "a decoder that knows no AV1": () => (VideoDecoder.isConfigSupported = () => Promise.reject(new TypeError("codec"))),
  "a decoder that finds out late": () => {
    window.VideoDecoder = class extends VideoDecoder {
      constructor(given) {
        super(given);
        this.fail = given.error;
      }

      decode() {
        this.close();
        this.fail(new DOMException("not here", "NotSupportedError"));
      }
    };
  },
};
for (const [name, init] of Object.entries(KEYS)) {
  for (const clip of name === "no decoder of videos" ? ["clip.glb", "clip-sheets.glb"] : ["clip.glb"]) {
    test(`${name}, ${clip}: a flip book of the key pictures, which are sought and stepped through too`, async () => {
      const { page, close } = await openClip(init, { name: clip });
      const { played, errors } = await playThrough(page, 1, groups.length + 1);
      played.forEach(assertSame);
      assert.deepEqual([...new Set(played.map(([frame]) => frame))].sort((a, b) => a - b), STARTS);
      assert.deepEqual(errors, []);
      assert.deepEqual(await fallbacks(page), ["keys"]);
      const found = await sought(page, [LONG, 3, 6, LONG - 3, 12]);
      found.forEach(assertSame);
      assert.deepEqual(found.map(([frame]) => frame), [LONG, 3, 6, LONG - 3, 12].map((frame) => STARTS[groupOf(frame)]));
      const stepped = await page.evaluate(async () => {
        const list = [];
        for (const step of [1, 1, -1, -2, -1]) {
          await window.field.player.step(step);
          list.push(window.read());
        }
        return list;
      });
      stepped.forEach(assertSame);
      const [, , third, last] = STARTS;
      assert.deepEqual(stepped.map(([frame]) => frame), [last, 0, last, STARTS[1], 0], `from ${third}`);
      await close();
    });
  }
}

test("frames that a browser does not hand out are read where they are drawn, with eight bits", async () => {
  const { page, close } = await openClip(() => {
    Object.defineProperty(VideoFrame.prototype, "format", { get: () => null });
    const refuse = () => {
      throw new DOMException("no format", "NotSupportedError");
    };
    Object.assign(VideoFrame.prototype, { allocationSize: refuse, copyTo: refuse });
  });
  const { played, errors } = await playThrough(page, 1, 16);
  played.forEach(assertSame);
  assert.deepEqual([errors, await fallbacks(page)], [[], ["bits"]]);
  await close();
});

/** Has each frame of a decoder come so many milliseconds after the one before it. */
const slowly = (milliseconds) => `
  window.pause = ${milliseconds};
  window.VideoDecoder = class extends VideoDecoder {
    constructor({ output, error }) {
      super({
        error,
        output: (frame) => {
          const { turn } = this;
          this.before = this.before.then(() => turn === this.turn && new Promise((resolve) => setTimeout(resolve, window.pause))).then(() => {
            if (turn === this.turn && this.state === "configured") output(frame);
            else frame.close();
          });
        },
      });
      Object.assign(this, { turn: 0, before: Promise.resolve() });
    }

    async flush() {
      await super.flush();
      await this.before;
    }

    reset() {
      this.turn += 1;
      super.reset();
    }
  };`;

test("decoders that are too slow: means alone while it plays, and all of what is paused, sought and played in time", async () => {
  const { page, close } = await openClip(slowly(250));
  await page.evaluate(() => window.field.player.play());
  await page.waitForFunction(() => window.field.player.fallbacks.includes("textures"), null, { timeout: 60_000 });
  await page.evaluate(() => (window.played = []));
  await page.waitForFunction(() => window.played.length > 4, null, { timeout: 60_000 });
  const plain = await page.evaluate(() => window.played.filter((one) => one && window.field.plain));
  for (const [frame, byMean, , strength, shades] of plain) {
    assert.deepEqual([byMean, Math.abs(strength) < 0.1], [frame, true], `${frame}: ${byMean}, ${strength} of ${shades}`);
  }
  assert.ok(plain.length > 0);
  await page.evaluate(() => {
    window.pause = 0;
    window.field.player.pause();
  });
  await page.waitForFunction(() => !window.field.player.waiting);
  assertSame(await page.evaluate(() => window.read()));
  assert.deepEqual(await fallbacks(page), []);
  (await sought(page, [20, 3])).forEach(assertSame);
  await page.evaluate(() => (window.played = []));
  const { played, errors } = await playThrough(page, 1, 16);
  played.forEach(assertSame);
  assert.deepEqual(errors, []);
  await close();
});

test("a page that is slow itself, or whose file comes slowly, leaves nothing out", async () => {
  const { page, close } = await openClip(() => {
    const { requestAnimationFrame } = window;
    window.requestAnimationFrame = (draw) => setTimeout(() => requestAnimationFrame(draw), 250);
  });
  await page.evaluate(() => {
    window.field.player.speed = 4;
    window.field.player.play();
  });
  await page.waitForTimeout(4000);
  assert.deepEqual(await fallbacks(page), []);
  assert.ok((await page.evaluate(() => window.field.player.late)) > 0, "frames are late all the same");
  await close();
});

test("where pictures of AV1 are not decoded either, the picture for other viewers is shown, and a reason given", async () => {
  const { page, close } = await lab.open({
    init: () => {
      delete globalThis.VideoDecoder;
      delete globalThis.ImageDecoder;
      const { createImageBitmap } = window;
      window.createImageBitmap = (blob, ...options) => {
        if (blob instanceof Blob && /avif/.test(blob.type)) return Promise.reject(new DOMException("no", "InvalidStateError"));
        return createImageBitmap(blob, ...options);
      };
    },
  });
  const found = await page.evaluate(async () => {
    const { gltf, field, error } = await window.lab.loadEigenfield("clip.glb");
    window.lab.show(gltf);
    const { camera, THREE } = window.lab;
    new THREE.Box3().setFromObject(gltf.scene).getCenter(camera.position);
    camera.position.z += 2;
    window.lab.draw();
    return { field, code: error.code, text: error.message, shades: window.lab.greens([[160, 120], [100, 100]]) };
  });
  assert.deepEqual([found.field, found.code], [null, "codec"]);
  assert.match(found.text, /decodes no AV1.*The first frame is shown/);
  assert.ok(found.shades.every((shade) => shade > 20), `${found.shades}`);
  await close();
});

test("a decoder that fails once is made anew at the key picture before, and no frame of that group is lost for good", async () => {
  const { page, close } = await openClip(() => {
    window.failures = 0;
    window.VideoDecoder = class extends VideoDecoder {
      constructor(given) {
        super(given);
        this.fail = given.error;
      }

      decode(chunk) {
        if (chunk.timestamp !== 8 || window.failures) return super.decode(chunk);
        window.failures += 1;
        return setTimeout(() => {
          this.close();
          this.fail(new DOMException("a fault of its own", "EncodingError"));
        });
      }
    };
  });
  const { played, errors } = await playThrough(page, 1, FRAMES);
  played.forEach(assertSame);
  assert.deepEqual([errors, await page.evaluate(() => window.failures)], [[], 1]);
  assert.ok(played.some(([frame]) => frame > 8 && groupOf(frame) === 1), "frames behind the failure");
  await close();
});

test("a page that is frozen, as one that is not looked at, goes on where it was", async () => {
  const { page, close } = await openClip(() => undefined);
  const session = await page.context().newCDPSession(page);
  await page.evaluate(() => window.field.player.play());
  await page.waitForFunction(() => window.played.length > 2);
  await session.send("Page.setWebLifecycleState", { state: "frozen" });
  await new Promise((resolve) => setTimeout(resolve, 1500));
  await session.send("Page.setWebLifecycleState", { state: "active" });
  const { played, errors } = await playThrough(page, 1, 16);
  played.forEach(assertSame);
  assert.deepEqual(errors, []);
  await close();
});

test("a frame that is sought is drawn within a second", async (context) => {
  const { page, close } = await openClip(() => undefined);
  await sought(page, [1]); // which makes the decoders
  const times = await page.evaluate(async (frames) => {
    const list = [];
    for (const frame of frames) {
      const start = performance.now();
      await window.field.player.toFrame(frame);
      window.read();
      list.push(performance.now() - start);
    }
    return list;
  }, [LONG, 2, 11, 20, 4, LONG - 1, 12, 6, 0, 17]);
  assert.ok(Math.max(...times) < 1000, `${times.map(Math.round)} milliseconds`);
  context.diagnostic(`sought: ${times.map(Math.round)} milliseconds`);
  await close();
});

test("while decoders take long something on the way is shown within 250 milliseconds, then the frame itself", async (context) => {
  const { page, close } = await openClip(slowly(60));
  await sought(page, [1]);
  const seeks = await page.evaluate(async (frames) => {
    const list = [];
    for (const [away, frame] of frames) {
      await window.field.player.toFrame(away);
      const start = performance.now();
      let first = null;
      const heard = () => (first ??= performance.now() - start);
      window.field.player.addEventListener("frame", heard);
      await window.field.player.toFrame(frame);
      window.field.player.removeEventListener("frame", heard);
      list.push({ first, whole: performance.now() - start, read: window.read() });
    }
    return list;
  }, [[1, LONG], [7, LONG - 1], [0, LONG], [9, LONG - 2], [4, LONG]]);
  seeks.forEach(({ read }) => assertSame(read));
  assert.deepEqual(seeks.map(({ read }) => read[0]), [LONG, LONG - 1, LONG, LONG - 2, LONG]);
  const firsts = seeks.map(({ first }) => Math.round(first)).sort((a, b) => a - b);
  context.diagnostic(`first pictures after ${firsts}, all of it after ${seeks.map(({ whole }) => Math.round(whole))} milliseconds`);
  assert.ok(firsts[0] <= 250, `${firsts} milliseconds`); // a busy machine makes some of them later
  assert.ok(seeks.every(({ whole }) => whole > 600));
  (await page.evaluate(() => window.played)).forEach(assertSame);
  await close();
});

test("a bar that is dragged from end to end and back shows pictures all the way, and in the end the frame itself", async (context) => {
  const { page, close } = await openClip(slowly(60));
  const { gaps, last } = await page.evaluate(async (frames) => {
    const { player } = window.field;
    await player.toFrame(1);
    const gaps = [];
    let before = performance.now();
    player.addEventListener("frame", () => {
      gaps.push(performance.now() - before);
      before = performance.now();
    });
    let done;
    for (let i = 0; i < 60; i++) {
      done = player.toFrame(Math.round((frames - 1) * Math.abs(Math.sin(i / 12))));
      await new Promise((resolve) => setTimeout(resolve, 40));
    }
    await done;
    await player.toFrame(13);
    return { gaps, last: window.read() };
  }, FRAMES);
  assertSame(last);
  assert.equal(last[0], 13);
  const sorted = gaps.map(Math.round).sort((a, b) => a - b);
  context.diagnostic(`pictures while it is dragged: ${gaps.length}, ${sorted.join()} milliseconds apart`);
  assert.ok(gaps.length >= 6 && sorted[Math.floor(0.8 * sorted.length)] <= 400, `${sorted}`);
  (await page.evaluate(() => window.played)).forEach(assertSame);
  await close();
});
