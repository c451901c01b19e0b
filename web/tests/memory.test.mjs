// Little memory: textures become smaller within their charts. The scene is a ball of 96 charts with loud colours between
// them, and a picture is held against that of the whole scene. The scene is small, and so is its memory: what is 128 and
// 256 MB for an atlas of 2048² is 8 and 16 MB for its 512².

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { canvasPixels, difference, startLab } from "./harness.mjs";

let lab;
before(async () => (lab = await startLab()));
after(() => lab?.close());

// What of each is on the GPU, by megabytes of memory: the sides of the file's mean and eigen textures over those that are
// there, and whether codes of more than 8 bits have them all.
const PLANS = {
  "patched.glb": { 16: [1, 1, true], 8: [1, 1, true], 4: [1.5, 1.5, false], 2: [2, 3, false] },
  "patched-coded.glb": { 16: [1, 1, true], 8: [1, 1.5, false], 4: [1.5, 2.25, false], 2: [3, 3, false] },
};

/** Loads a scene with so much memory; its picture from a captured camera, and its plan. */
async function drawn(page, name, memory, camera = 1) {
  const plan = await page.evaluate(
    async ([url, memory, index]) => {
      window.field?.dispose();
      const { gltf, field } = await window.lab.loadEigenfield(url, { memory });
      window.lab.show(gltf);
      window.lab.draw();
      await field.complete;
      window.field = field;
      field.camera = index;
      window.lab.drawView(field, field.info.cameras[index]);
      const { plan } = field.textures;
      return { ...plan, total: field.total };
    },
    [name, memory, camera],
  );
  return { plan, picture: await canvasPixels(page) };
}

for (const [name, plans] of Object.entries(PLANS)) {
  test(`${name}: nothing that lies between charts gets into a picture`, async () => {
    const { page, close } = await lab.open();
    const whole = await drawn(page, name, 1e9);
    assert.equal(whole.plan.limitation, null);
    for (const [megabytes, wanted] of Object.entries(plans)) {
      const { plan, picture } = await drawn(page, name, 1e6 * megabytes);
      assert.deepEqual([plan.meanDown, plan.scaleDown, plan.halves], wanted, `${megabytes} MB`);
      assert.ok(plan.bytes <= 1e6 * megabytes && plan.usable === 4, JSON.stringify(plan));
      assert.equal(plan.limitation === null, plan.halves);
      const { mean, largest, pixels } = difference(picture, whole.picture, { margin: 6 }); // without the ball's outline
      assert.ok(pixels > 2e4 && mean < 2 && largest <= 10, `${megabytes} MB: mean ${mean}, largest ${largest}`);
    }
    await close();
  });
}

for (const name of Object.keys(PLANS)) {
  test(`${name}: nor while a slow device moves, which composes fewer texels`, async () => {
    const { page, close } = await lab.open();
    const whole = await drawn(page, name, 1e9);
    for (const coarser of [2, 4]) {
      await page.evaluate((times) => {
        Object.assign(window.field, { coarser: times, filter: "bilinear" });
        window.lab.drawView(window.field, window.field.info.cameras[1]);
      }, coarser);
      const { mean, largest, pixels } = difference(await canvasPixels(page), whole.picture, { margin: 6 });
      assert.ok(pixels > 2e4 && mean < 2 && largest <= 14, `1/${coarser}: mean ${mean}, largest ${largest}`);
    }
    await close();
  });
}

test("memory for nothing at all: a picture, or one sentence", async () => {
  const { page, close } = await lab.open();
  const little = await drawn(page, "patched-coded.glb", 1e6); // 16 MB at 2048²
  const why = "the scene needs 11 MB of graphics memory and 1.0 MB may be used.";
  const parts = ["Eigen textures have 25 % of their width and height", "eigen textures have 8 bits"];
  assert.equal(little.plan.limitation, [...parts, `the mean texture has 25 % of its width and height: ${why}`].join(", "));
  assert.ok(little.picture.data.some((value) => value > 100));
  const { plan } = await drawn(page, "patched.glb", 1);
  assert.equal(plan.usable, 0);
  assert.match(plan.limitation, /^0 of 4 eigen textures are drawn, /);
  await close();
});
