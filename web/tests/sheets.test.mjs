// Sheets in three.js: what is said of them, how they mix with objects of others, and files that are damaged. Their
// pictures against the software renderer's are in plugin.test.mjs.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { canvasPixels, decodePng, difference, launch, readGlb, sceneBytes, scenePath } from "./harness.mjs";
import { startLab, writeGlb } from "./harness.mjs";
import { openViewer, picture, set, settled } from "./viewer-page.mjs";

const EXTENSION = "EIGENFIELD_eigen_textures";
const routes = {};
let lab;
before(async () => (lab = await startLab(routes)));
after(() => lab?.close());

const references = JSON.parse(readFileSync(scenePath("references.json"), "utf8"));
const reference = references.find(({ file }) => file === "sheets-bicubic-1.png");

/** Loads a scene as `window.field`, all of it. */
const load = (page, name, options = {}) =>
  page.evaluate(
    async ([url, given]) => {
      const { gltf, field } = await window.lab.loadEigenfield(url, given);
      window.lab.show(gltf);
      window.field = field;
      window.lab.draw();
      await field.complete;
    },
    [name, options],
  );

/** The picture from a place of the view plane after `field` got some settings. */
async function shot(page, settings = {}, at = reference.at) {
  await page.evaluate(
    ([values, place]) => {
      const { field, lab } = window;
      Object.assign(field, { view: "picture", filter: "bicubic", camera: null, coarser: 1, ...values });
      lab.drawView(field, lab.novelCamera(field, ...place));
    },
    [settings, at],
  );
  return canvasPixels(page);
}

const expected = () => decodePng(readFileSync(scenePath(reference.file)));

test("sheets, their bytes and those of what they are drawn into", async () => {
  const { page, close } = await lab.open();
  for (const [name, sheets] of [["sheets.glb", 3], ["sheets-coded.glb", 3], ["scene.glb", 0]]) {
    await load(page, name);
    const { info, bytes } = await page.evaluate(() => {
      const before = window.field.textures.plan.bytes;
      return { info: window.field.info, bytes: window.field.gpuBytes - before };
    });
    assert.equal(info.sheets, sheets, name);
    assert.equal(bytes, sheets ? 16 * 320 * 240 : 0, name);
    const { total, mesh, opacity, mean, weights, other, textures } = info.bytes;
    assert.equal(mesh + opacity + mean + weights + other + textures.reduce((a, b) => a + b, 0), total);
    assert.equal(opacity > 0, sheets > 0, name);
    assert.deepEqual(info.size, [128, 128]);
    await page.evaluate(() => window.field.dispose());
  }
  await close();
});

test("a thousand eyes see no pinhole in a sheet, and nothing of it twice", async () => {
  const { page, close } = await lab.open();
  await load(page, "pinholes.glb");
  const seen = await page.evaluate((eyes) => {
    const { lab, field } = window;
    const { renderer, camera, THREE } = lab;
    const [{ width, height }] = eyes;
    renderer.setSize(width, height);
    camera.parent.background = new THREE.Color(1, 1, 1);
    const pixels = new Uint8Array(4 * width * height);
    const gl = renderer.getContext();
    const counts = {};
    for (const eye of eyes) {
      lab.placeCamera(field, camera, eye, width / height);
      lab.draw();
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      for (let at = 0; at < pixels.length; at += 4) counts[pixels[at]] = (counts[pixels[at]] ?? 0) + 1;
    }
    return counts;
  }, JSON.parse(readFileSync(scenePath("pinholes.json"), "utf8")));
  // half opaque and black over white: a pinhole is 255, a pixel that is drawn twice 64
  assert.deepEqual(Object.keys(seen).filter((level) => Math.abs(level - 127.5) > 2), [], JSON.stringify(seen));
  await close();
});

test("one opaque sheet is what is drawn without sheets, but for edges", async () => {
  const { page, close } = await lab.open();
  await load(page, "scene.glb");
  const plain = await shot(page);
  const { json, binary } = readGlb(sceneBytes("scene.glb"));
  const white = await page.evaluate(async () => {
    const canvas = new OffscreenCanvas(48, 32);
    const context = canvas.getContext("2d");
    context.fillStyle = "#fff";
    context.fillRect(0, 0, 48, 32);
    return [...new Uint8Array(await (await canvas.convertToBlob()).arrayBuffer())];
  });
  const faces = [json.accessors[json.meshes[0].primitives[0].indices].count / 3];
  const bufferView = json.bufferViews.push({ buffer: 0, byteOffset: binary.length, byteLength: white.length }) - 1;
  const opacity = { bufferView, mimeType: "image/png", size: [48, 32] };
  json.extensions[EXTENSION].sheets = { faces, opacity };
  json.buffers[0].byteLength = binary.length + white.length;
  const end = Buffer.alloc((4 - (white.length % 4)) % 4);
  routes["/opaque.glb"] = { body: writeGlb({ json, binary: Buffer.concat([binary, Buffer.from(white), end]) }) };
  await load(page, "opaque.glb");
  assert.equal(await page.evaluate(() => window.field.info.sheets), 1);
  const { largest, pixels } = difference(await shot(page), plain);
  assert.ok(largest <= 1 && pixels > 38_000, `largest ${largest} of ${pixels} pixels`);
  await close();
});

test("objects of others hide sheets, are seen between them and are hidden by them", async () => {
  const { page, close } = await lab.open();
  await load(page, "sheets.glb");
  const alone = await shot(page);
  const shares = [];
  for (const z of [-1.2, -0.35, 0.6]) {
    await page.evaluate((depth) => {
      const { THREE } = window.lab;
      const material = new THREE.MeshBasicMaterial({ color: 0xff00ff, side: THREE.DoubleSide });
      window.other = new THREE.Mesh(new THREE.PlaneGeometry(4, 4), material);
      window.other.position.z = depth;
      window.field.mesh.add(window.other);
    }, z);
    const mixed = await shot(page);
    await page.evaluate(() => window.other.removeFromParent());
    let [theirs, ours] = [0, 0];
    for (let i = 0; i < mixed.data.length; i += 3) {
      const [r, g, b] = mixed.data.subarray(i, i + 3);
      if (alone.data[i] + alone.data[i + 1] + alone.data[i + 2] === 0) continue; // no sheet
      if (r === 255 && g === 0 && b === 255) theirs += 1;
      else if ([r, g, b].every((value, c) => Math.abs(value - alone.data[i + c]) <= 1)) ours += 1;
    }
    assert.ok(theirs + ours > 60_000, `${z}: ${theirs} and ${ours} pixels`);
    shares.push(theirs / (theirs + ours));
  }
  assert.ok(shares[0] > 0.999 && shares[1] > 0.5 && shares[1] < 0.95 && shares[2] < 0.01, `${shares}`);
  await close();
});

test("what others have drawn behind shows through what is not quite there", async () => {
  const { page, close } = await lab.open();
  await load(page, "folded.glb");
  const on = (colour) => page.evaluate((value) => window.lab.renderer.setClearColor(value), colour);
  const black = await shot(page);
  await on(0x808080);
  const grey = await shot(page);
  await on(0x000000);
  await page.evaluate(() => {
    const { THREE } = window.lab;
    const material = new THREE.MeshBasicMaterial({ color: 0x808080, side: THREE.DoubleSide });
    const plane = new THREE.Mesh(new THREE.PlaneGeometry(20, 20), material);
    plane.position.z = 0.9;
    window.field.mesh.add(plane);
  });
  const before = await shot(page);
  let mixed = 0;
  for (let i = 0; i < grey.data.length; i++) {
    const share = (grey.data[i] - black.data[i]) / 128; // 1 - A
    if (share > 0.1 && share < 0.9) mixed += 1;
    assert.ok(Math.abs(before.data[i] - grey.data[i]) <= 1, `${before.data[i]} is not ${grey.data[i]}`);
  }
  assert.ok(mixed > 1000, `${mixed} numbers that are mixed`);
  await close();
});

test("mean, single eigen textures and the error are shown through the sheets", async () => {
  const { page, close } = await lab.open();
  await load(page, "sheets.glb");
  const [all, none, mean] = [await shot(page), await shot(page, { count: 0 }), await shot(page, { view: "mean" })];
  await page.evaluate(() => (window.field.count = Infinity));
  assert.equal(difference(none, mean).largest, 0);
  assert.ok(difference(all, mean).mean > 1);
  await shot(page, { view: "eigen", eigen: 1 });
  await page.waitForTimeout(500); // its strength is measured when it is first shown
  const eigen = await shot(page, { view: "eigen", eigen: 1 });
  const strong = eigen.data.filter((value) => value < 80 || value > 175).length / eigen.data.length;
  assert.ok(strong > 0.1 && difference(eigen, mean).mean > 10, `an eigen texture must be seen: ${strong}`);
  const seen = await page.evaluate(async () => {
    const { field, lab } = window;
    Object.assign(field, { view: "picture", camera: 12 });
    lab.drawView(field, field.info.cameras[12]);
    const bitmap = await createImageBitmap(lab.renderer.domElement);
    const shifted = new OffscreenCanvas(320, 240);
    const context = shifted.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const data = context.getImageData(0, 0, 160, 240);
    data.data.forEach((value, i) => (data.data[i] = i % 4 === 3 ? 255 : value > 127 ? value - 10 : value + 10));
    context.putImageData(data, 0, 0);
    field.photograph = new lab.THREE.Texture(shifted.transferToImageBitmap());
    field.photograph.needsUpdate = true;
    field.view = "error";
    lab.drawView(field, field.info.cameras[12]);
  });
  assert.equal(seen, undefined);
  const { data } = await canvasPixels(page);
  const at = (x) => Array.from({ length: 120 }, (_, y) => data[3 * ((y + 60) * 320 + x)]);
  const [left, right] = [at(100), at(220)].map((column) => column.reduce((a, b) => a + b) / column.length);
  assert.ok(Math.abs(left - 150) < 12 && right < 12, `error of ten grey levels ${left}, of none ${right}`);
  await close();
});

test("each eye of a stereo camera has its own sheets", async () => {
  const { page, close } = await lab.open();
  await load(page, "sheets.glb");
  const stereo = await page.evaluate(() => {
    window.lab.drawEyes(window.field);
    return window.field.lastWeights.length;
  });
  assert.equal(stereo, 2);
  const both = await canvasPixels(page);
  for (const [x, left] of [[-0.3, 0], [0.3, 160]]) {
    await page.evaluate(([place, from]) => {
      const { field, lab } = window;
      lab.renderer.setViewport(from, 0, 160, 240);
      lab.placeCamera(field, lab.camera, lab.novelCamera(field, place, 0.1), 160 / 240);
      lab.draw();
      lab.renderer.setViewport(0, 0, 320, 240);
    }, [x, left]);
    const alone = await canvasPixels(page);
    const half = ({ data }) => {
      const row = (y) => [...data.subarray(3 * (320 * y + left), 3 * (320 * y + left + 160))];
      return { width: 160, height: 240, data: Uint8Array.from(Array.from({ length: 240 }, (_, y) => row(y)).flat()) };
    };
    const { largest, pixels } = difference(half(alone), half(both));
    assert.ok(largest <= 1 && pixels > 10_000, `eye at ${x}: ${largest} of ${pixels} pixels`);
  }
  await close();
});

test("they are drawn into a target of others, too, and leave three.js' state as it was", async () => {
  const { page, close } = await lab.open();
  await load(page, "sheets.glb");
  const canvas = await shot(page);
  const { data, range, target } = await page.evaluate(() => {
    const { lab } = window;
    const own = new lab.THREE.WebGLRenderTarget(320, 240, { depthBuffer: true });
    lab.renderer.setRenderTarget(own);
    lab.renderer.clear();
    lab.draw();
    const target = lab.renderer.getRenderTarget() === own;
    const data = new Uint8Array(4 * 320 * 240);
    lab.renderer.readRenderTargetPixels(own, 0, 0, 320, 240, data);
    lab.renderer.setRenderTarget(null);
    const gl = lab.renderer.getContext();
    return { data: [...data], range: [...gl.getParameter(gl.DEPTH_RANGE)], target };
  });
  assert.deepEqual([range, target], [[0, 1], true]);
  const flipped = new Uint8Array(3 * 320 * 240);
  for (let y = 0; y < 240; y++) {
    for (let x = 0; x < 320; x++) {
      for (let c = 0; c < 3; c++) flipped[3 * (320 * y + x) + c] = data[4 * (320 * (239 - y) + x) + c];
    }
  }
  assert.ok(difference({ width: 320, height: 240, data: flipped }, canvas).largest <= 1);
  await close();
});

test("opacity is summed once; a still picture is composed once", async () => {
  const { page, close } = await lab.open();
  await load(page, "sheets.glb");
  const calls = await page.evaluate(() => {
    const { field, lab } = window;
    const at = (x, y) => lab.placeCamera(field, lab.camera, lab.novelCamera(field, x, y), 320 / 240);
    const changes = [() => at(0.1, 0.1), () => {}, () => at(0.2, 0.1), () => (field.coarser = 2), () => at(0, 0)];
    return lab.countDraws(changes);
  });
  // mean and eigen textures, each sheet twice, and all of it into the picture; opacity at another size and the atlas's
  assert.deepEqual(calls, [2 + 7, 7, 2 + 7, 2 + 2 + 7, 2 + 7]);
  await close();
});

test("opacity in little memory, in eight bits, and after a lost context", async () => {
  const { page, close } = await lab.open({ allowed: /context (lost|restored)/i });
  await load(page, "sheets.glb", { memory: 600_000 });
  assert.match(await page.evaluate(() => window.field.limitation), /the mean texture has 50 % of its width/);
  assert.ok(difference(await shot(page), expected()).mean < 8);
  await page.evaluate(() => window.field.dispose());
  await load(page, "sheets.glb");
  await page.evaluate(() => window.lab.loseContext(window.field));
  assert.ok(difference(await shot(page), expected()).largest <= 2);
  await page.evaluate(() => {
    window.field.dispose();
    delete window.ImageDecoder;
  });
  await load(page, "sheets-coded.glb");
  const coded = references.find(({ file }) => file === "sheets-coded-bicubic-1.png");
  const { mean, largest } = difference(await shot(page), decodePng(readFileSync(scenePath(coded.file))));
  assert.ok(mean <= 0.6 && largest <= 5, `mean ${mean}, largest ${largest}`);
  await close();
});

const WRONG = {
  "the sheets have 3173 triangles, the mesh has 3174": ({ sheets }) => (sheets.faces[0] -= 1),
  "sheets 0 and 1 share vertex \\d+": ({ sheets }) => ((sheets.faces[0] -= 1), (sheets.faces[1] += 1)),
  "sheets/faces: no sheet": ({ sheets }) => (sheets.faces = []),
  "sheets/faces: missing": ({ sheets }) => delete sheets.faces,
  "sheets/faces: more than 32 entries": ({ sheets }) => (sheets.faces = Array(33).fill(1)),
  "sheets/faces/1: 0 is not in 1..134217728": ({ sheets }) => (sheets.faces[1] = 0),
  "sheets/opacity: missing": ({ sheets }) => delete sheets.opacity,
  "sheets/opacity/size: missing": ({ sheets }) => delete sheets.opacity.size,
  "sheets/opacity/mimeType: an unknown type": ({ sheets }) => (sheets.opacity.mimeType = "image/gif"),
  "sheets/opacity/bits: 10 bits of image/png": ({ sheets }) => (sheets.opacity.bits = 10),
  "sheets/opacity/bufferView: 999 is not in": ({ sheets }) => (sheets.opacity.bufferView = 999),
  "sheets/opacity: a picture of 96 x 80, not of 96 x 81": ({ sheets }) => (sheets.opacity.size = [96, 81]),
};

test("sheets that cannot be are refused by name", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("sheets.glb"));
  const refusal = async (changed, data) => {
    routes["/wrong.glb"] = { body: writeGlb({ json: changed, binary: data }) };
    return page.evaluate(async () => {
      const { loadEigenfield, SceneError } = window.lab;
      const error = await loadEigenfield("wrong.glb").then(() => null, (reason) => reason);
      return error instanceof SceneError ? { code: error.code, message: error.message } : String(error);
    });
  };
  for (const [what, change] of Object.entries(WRONG)) {
    const changed = structuredClone(json);
    change(changed.extensions[EXTENSION]);
    const { code, message } = await refusal(changed, binary);
    assert.equal(code, "damaged", what);
    assert.match(message, new RegExp(`^The file is damaged \\(.*${what}.*\\); make or download it again\\.$`));
  }
  const { byteOffset } = json.bufferViews[json.extensions[EXTENSION].sheets.opacity.bufferView];
  const data = Buffer.from(binary);
  data.fill(0, byteOffset + 60, byteOffset + 200);
  const { code, message } = await refusal(json, data);
  assert.equal(code, "damaged");
  assert.match(message, /sheets\/opacity: it cannot be decoded/);
  await close();
});

test("the viewer draws sheets, says how many, and shows their triangles", async () => {
  const browser = await launch();
  const { page, close } = await openViewer(browser, "sheets.glb", { width: 320, height: 240 });
  await set(page, { background: "#000000" });
  await page.evaluate(([x, y]) => window.eigenfield.goTo(x, y), reference.at);
  await settled(page);
  const drawn = await picture(page);
  const { largest, mean } = difference(drawn, expected());
  assert.ok(largest <= 2 && mean <= 0.5, `${largest} at most, ${mean} in the mean`);
  await set(page, { wireframe: true });
  const lines = difference(await picture(page), drawn).mean;
  assert.ok(lines > 1 && lines < 60, `wireframe: ${lines}`);
  await close();
  const wide = await openViewer(browser, "sheets.glb", { width: 900, height: 700 });
  await settled(wide.page);
  await wide.page.locator("summary", { hasText: "About this file" }).click();
  await wide.page.waitForSelector(".facts table");
  assert.match(await wide.page.locator(".facts").innerText(), /sheets\s+3, one over the other/);
  await wide.close();
  await browser.close();
});
