// A clip that plays for long takes no more memory than after its first seconds.
//
// Environment:
//   EIGENFIELD_SECONDS   how long it plays; else 20

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { sceneBytes, startLab } from "./harness.mjs";

const SECONDS = Number(process.env.EIGENFIELD_SECONDS ?? 20);
const EARLY = Math.min(10, SECONDS / 4); // seconds after which memory is what it is to stay
const TURNED = 100; // frames after which it is: all groups were open, and what draws and decodes is compiled
const SAMPLES = 5;
const MORE = 1.1;
const MIB = 2 ** 20;
const bytes = sceneBytes("far.glb");

/** Ranges of the clip, whose groups lie 2 MB apart: each that is wanted again is fetched again. */
const ROUTES = {
  "/ranged.glb": (request, response) => {
    const [, from = "0", last = String(bytes.length - 1)] = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "") ?? [];
    const part = bytes.subarray(Number(from), Number(last) + 1);
    const range = { "Content-Range": `bytes ${from}-${last}/${bytes.length}` };
    response.writeHead(request.headers.range ? 206 : 200, { "Content-Length": part.length, ...(request.headers.range && range) });
    response.end(part);
  },
};
let lab;
before(async () => (lab = await startLab(ROUTES)));
after(() => lab?.close());

for (const name of ["clip-sheets.glb", "ranged.glb"]) {
  test(`${name}: ${SECONDS} seconds of play in the memory of ${EARLY}`, async (context) => {
    const { page, close } = await lab.open({ init: countFrames });
    const session = await page.context().newCDPSession(page);
    await page.evaluate(async (url) => {
      const { lab } = window;
      const { gltf, field } = await lab.loadEigenfield(url);
      lab.show(gltf);
      lab.drawView(field, field.info.cameras[0]);
      await field.complete;
      Object.assign(window, { field, frames: 0 });
      field.player.speed = 2;
      field.player.addEventListener("frame", () => {
        window.frames += 1;
        lab.drawView(field, field.info.cameras[0]);
      });
      field.player.play();
    }, name);
    const measured = async () => {
      const found = [];
      for (let i = 0; i < SAMPLES; i++) {
        await new Promise((resolve) => setTimeout(resolve, 400));
        await session.send("HeapProfiler.collectGarbage");
        found.push(await session.send("Runtime.getHeapUsage"));
      }
      const least = (kind) => Math.min(...found.map((one) => one[kind])); // without what is just being decoded or fetched
      const own = await page.evaluate(() => ({ gpu: window.field.gpuBytes, frames: window.frames, most: window.most }));
      return { heap: least("usedSize"), buffers: least("backingStorageSize"), ...own };
    };
    const start = Date.now();
    const until = (seconds) => new Promise((resolve) => setTimeout(resolve, start + 1000 * seconds - Date.now()));
    await until(EARLY);
    await page.waitForFunction((frames) => window.frames >= frames, TURNED, { timeout: 120_000 });
    const early = await measured();
    await until(SECONDS + (Date.now() - start) / 1000 - EARLY);
    const late = await measured();
    const megabytes = ({ heap, buffers, gpu }) => [heap, buffers, gpu].map((size) => (size / MIB).toFixed(2)).join(" + ");
    const [before, behind] = [early, late].map((one) => `${megabytes(one)} after ${one.frames} frames`);
    context.diagnostic(`${name}: heap + buffers + GPU, MiB: ${before}, ${behind}; ${late.most} frames open at most`);
    assert.ok(late.frames > early.frames + 2 * (SECONDS - EARLY), `${late.frames} frames`);
    const total = ({ heap, buffers, gpu }) => heap + buffers + gpu;
    assert.ok(total(late) <= MORE * total(early), `${total(early)}, then ${total(late)} bytes`);
    assert.equal(late.gpu, early.gpu);
    assert.ok(late.most > 0 && late.most <= 3 * 4 && late.gpu > 0); // of each film at most four are on the way
    await page.evaluate(() => window.field.player.pause());
    await page.waitForFunction(() => window.open === 0 && window.field.player.open === 0);
    await close();
  });
}

/** Counts the frames of decoders: `open` now, and at `most`. */
function countFrames() {
  Object.assign(window, { open: 0, most: 0 });
  const { close } = VideoFrame.prototype;
  const counted = new WeakSet();
  VideoFrame.prototype.close = function () {
    if (counted.delete(this)) window.open -= 1;
    close.call(this);
  };
  window.VideoDecoder = class extends VideoDecoder {
    constructor({ output, error }) {
      super({
        error,
        output: (frame) => {
          counted.add(frame);
          window.most = Math.max(window.most, (window.open += 1));
          output(frame);
        },
      });
    }
  };
}
