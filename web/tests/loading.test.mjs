// How scenes arrive: the mean first, eigen textures in order, and a clear sentence for every file that is not right.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { canvasPixels, difference, readGlb, sceneBytes, startLab, writeGlb } from "./harness.mjs";

const EXTENSION = "EIGENFIELD_eigen_textures";

/** A server's answer that comes in parts, each when the test says so. */
function slowly(bytes, headers = {}) {
  let release;
  let sent = 0;
  const answer = { wanted: null };
  const open = new Promise((resolve) => (release = resolve));
  answer.route = async (_request, response) => {
    response.writeHead(200, { "Content-Type": "model/gltf-binary", "Content-Length": bytes.length, ...headers });
    release(response);
  };
  answer.sendTo = async (end) => {
    const response = await open;
    await new Promise((resolve) => response.write(bytes.subarray(sent, end), resolve));
    sent = end;
  };
  answer.cut = async () => (await open).destroy();
  answer.finish = async () => {
    const response = await open;
    response.end(bytes.subarray(sent));
  };
  return answer;
}

const find = (json) => json.extensions[EXTENSION];

const routes = {};
let lab;
before(async () => (lab = await startLab(routes)));
after(() => lab?.close());

/** Loads `source` and says what came of it; `later` is the error event after a success. */
function tryLoad(page, source) {
  return page.evaluate(async (url) => {
    const { loadEigenfield, SceneError, show, draw } = window.lab;
    try {
      const { gltf, field } = await loadEigenfield(url);
      show(gltf);
      if (!field) return { plain: true, meshes: gltf.scene.children.length };
      const later = new Promise((resolve) => {
        field.addEventListener("error", ({ error }) => resolve({ code: error.code, message: error.message }));
        field.complete.then(() => resolve(null), () => undefined); // the event reports it
      });
      draw();
      return { later: await later, loaded: field.loaded };
    } catch (error) {
      if (!(error instanceof SceneError)) throw error;
      return { code: error.code, message: error.message, where: error.where };
    }
  }, source);
}

/** Offsets in the file at which each eigen texture ends. */
function textureEnds(bytes) {
  const { json } = readGlb(bytes);
  const start = 28 + Buffer.from(bytes).readUInt32LE(12);
  const [plane] = json.extensions[EXTENSION].planes;
  const end = (view) => start + (json.bufferViews[view].byteOffset ?? 0) + json.bufferViews[view].byteLength;
  return plane.bases[0].textures.map(({ bufferView }) => end(bufferView));
}

test("the mean is drawn first, and the picture improves as textures arrive", async () => {
  const bytes = sceneBytes("scene.glb");
  const ends = textureEnds(bytes);
  const slow = slowly(bytes);
  routes["/slow.glb"] = slow.route;
  const { page, close } = await lab.open();
  const { json } = readGlb(bytes);
  const [strongest] = find(json).planes[0].bases[0].textures;
  const first = 28 + bytes.readUInt32LE(12) + json.bufferViews[strongest.bufferView].byteOffset;
  await page.evaluate(() => {
    window.progress = [];
    window.loading = window.lab.loadEigenfield("slow.glb", { onBytes: (...seen) => window.progress.push(seen) });
  });
  await slow.sendTo(first);
  const start = await page.evaluate(async () => {
    const { gltf, field } = await window.loading;
    window.field = field;
    window.lab.show(gltf);
    window.lab.drawView(field, window.lab.novelCamera(field, 0.3, -0.2));
    return { loaded: field.loaded, total: field.total };
  });
  assert.deepEqual(start, { loaded: 0, total: 6 });
  const pictures = [await canvasPixels(page)];
  for (const [j, end] of ends.entries()) {
    await slow.sendTo(j + 1 < ends.length ? end : bytes.length);
    await page.waitForFunction((count) => window.field.loaded === count, j + 1);
    await page.evaluate(() => window.lab.draw());
    pictures.push(await canvasPixels(page));
  }
  await slow.finish();
  await page.evaluate(() => window.field.complete);
  await page.evaluate(() => window.lab.draw());
  const final = await canvasPixels(page);
  const off = pictures.map((picture) => difference(picture, final).mean);
  assert.ok(off[0] > 1, "the mean is not the whole picture");
  assert.ok(off[6] < 0.2 && off[3] < off[0], `differences from the final picture: ${off}`);
  const progress = await page.evaluate(() => window.progress);
  assert.deepEqual(progress.at(-1), [bytes.length, bytes.length]);
  assert.ok(progress.length > 6);
  await close();
});

test("each damaged file has its sentence", async () => {
  const { page, close } = await lab.open();
  const cases = [
    ["newer.glb", "version", /format version 2\.0 .* newer viewer\.$/],
    ["needs.glb", "needs", /"holograms".* newer viewer\.$/],
    ["no-json.glb", "damaged", /JSON.*again\.$/],
    ["not-ours.bin", "not-glb", /no GLB; take a \.glb file/],
  ];
  for (const [name, code, message] of cases) {
    const found = await tryLoad(page, name);
    assert.equal(found.code, code, `${name}: ${JSON.stringify(found)}`);
    assert.match(found.message, message, name);
  }
  assert.deepEqual(await tryLoad(page, "plain.glb"), { plain: true, meshes: 2 });
  await close();
});

test("what is cut off or damaged after the mean is drawn is an event, and the rest stays", async () => {
  const { page, close } = await lab.open();
  const cut = await tryLoad(page, "truncated.glb");
  assert.equal(cut.later.code, "truncated");
  assert.match(cut.later.message, /cut off after \d+ of \d+ bytes.* drawn with [0-5] of 6 eigen textures\.$/);
  const damaged = await tryLoad(page, "damaged.glb");
  assert.equal(damaged.later.code, "damaged");
  assert.match(damaged.later.message, /textures\/\d: it cannot be decoded.* drawn with \d of 6/);
  await page.evaluate(() => window.lab.draw());
  await close();
});

test("files cut off anywhere are reported", async () => {
  const { page, close } = await lab.open();
  const bytes = sceneBytes("scene.glb");
  const part = { length: 0 };
  routes["/part.glb"] = (_request, response) => response.end(bytes.subarray(0, part.length));
  const [json, ends] = [bytes.readUInt32LE(12), textureEnds(bytes)];
  for (const length of [0, 3, 8, 19, 40, 20 + json, 28 + json, 3000 + json, ends[0] - 1, ends[5] - 1]) {
    part.length = length;
    const code = length < 4 ? "not-glb" : "truncated";
    const found = await tryLoad(page, "part.glb");
    assert.equal(found.code ?? found.later.code, code, `${length}: ${JSON.stringify(found)}`);
  }
  await close();
});

test("a connection that breaks, a wrong address and an abort are told apart", async () => {
  const { page, close } = await lab.open({ allowed: /404|ERR_|Failed to load/ });
  const missing = await tryLoad(page, "nowhere.glb");
  assert.equal(missing.code, "network");
  assert.equal(missing.message, "The server answered 404 for the scene; check its address.");
  const nobody = await tryLoad(page, "http://127.0.0.1:9/scene.glb");
  assert.equal(nobody.code, "network");
  const bytes = sceneBytes("scene.glb");
  const slow = slowly(bytes);
  routes["/broken.glb"] = slow.route;
  const loading = tryLoad(page, "broken.glb");
  await slow.sendTo(9000);
  await slow.cut();
  assert.match((await loading).message, /^The connection broke after \d+ bytes/);
  const hanging = slowly(bytes);
  routes["/hanging.glb"] = hanging.route;
  const aborting = page.evaluate(async () => {
    const stop = new AbortController();
    setTimeout(() => stop.abort(), 100);
    return window.lab.loadEigenfield("hanging.glb", { signal: stop.signal }).catch((error) => error.name);
  });
  await hanging.sendTo(500);
  assert.equal(await aborting, "AbortError");
  const left = await page.evaluate(async () => {
    const { renderer, loadEigenfield } = window.lab;
    const [gl, live, stop, decode] = [renderer.getContext(), new Set(), new AbortController(), createImageBitmap];
    const { createTexture, deleteTexture } = gl;
    gl.createTexture = () => {
      const made = createTexture.call(gl);
      live.add(made);
      return made;
    };
    gl.deleteTexture = (one) => live.delete(one) && deleteTexture.call(gl, one);
    window.createImageBitmap = (...given) => {
      stop.abort(); // while it is decoded: all of the file is there
      return decode(...given);
    };
    const bytes = await (await fetch("scene.glb")).arrayBuffer();
    const { name } = await loadEigenfield(bytes, { renderer, signal: stop.signal }).catch((error) => error);
    return [name, live.size];
  });
  assert.deepEqual(left, ["AbortError", 0], "nothing stays on the GPU");
  await close();
});

test("a file that announces gigabytes takes no memory for them", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("avif.glb"));
  const huge = structuredClone(json);
  huge.buffers[0].byteLength = 4_000_000_000;
  Object.assign(huge.bufferViews[find(huge).planes[0].mean.bufferView], { byteOffset: 0, byteLength: 3_900_000_000 });
  const bytes = writeGlb({ json: huge, binary });
  bytes.writeUInt32LE(4_100_000_000, 8);
  bytes.writeUInt32LE(4_000_000_000, 20 + bytes.readUInt32LE(12));
  routes["/huge.glb"] = { body: bytes };
  const before = await page.evaluate(() => performance.memory.usedJSHeapSize);
  const found = await tryLoad(page, "huge.glb");
  assert.equal(found.code, "truncated");
  const grown = (await page.evaluate(() => performance.memory.usedJSHeapSize)) - before;
  assert.ok(grown < 100e6, `${grown} bytes`);
  await close();
});

const CHANGES = {
  "no eigen textures' weights": (e) => delete e.planes[0].bases[0].weights,
  "too few weights": (_e, json) => (json.accessors[find(json).planes[0].bases[0].weights].count -= 1),
  "an accessor outside its view": (_e, json) => (json.accessors[0].byteOffset = 2 ** 20),
  "a view outside the buffer": (_e, json) => (json.bufferViews[2].byteLength = 2 ** 31),
  "a view of another buffer": (_e, json) => (json.bufferViews[2].buffer = 1),
  "a mean of another size": (e) => (e.planes[0].mean.size = [64, 64]),
  "a mean of an impossible size": (e) => (e.planes[0].mean.size = [1e9, 1e9]),
  "a size that is no number": (e) => (e.planes[0].bases[0].size = ["x", null]),
  "no planes": (e) => (e.planes = []),
  "a reference that is no camera": (e) => (e.reference = 25),
  "a doubled name": (e) => (e.cameras.names[1] = e.cameras.names[0]),
  "all held out": (e) => (e.cameras.heldOut = e.cameras.names.map((_, i) => i)),
  "axes that are not": (e) => (e.viewPlane.right = [2, 0, 0]),
  "an extent below zero": (e) => (e.viewPlane.extent = [-1, 1]),
  "no version": (e) => delete e.version,
  "an unknown picture": (e) => (e.planes[0].bases[0].textures[0].mimeType = "text/html"),
  "a scale of two numbers": (e) => (e.planes[0].bases[0].textures[0].scale = [1, 1]),
  "lines": (_e, json) => (json.meshes[0].primitives[0].mode = 1),
  "no mesh": (_e, json) => delete json.meshes,
  "no buffer views": (_e, json) => (json.bufferViews = 7),
  "an accessor of another type": (_e, json) => (json.accessors[0].type = "VEC2"),
  "no node": (_e, json) => json.nodes.forEach((node) => delete node.mesh),
  "nodes in a circle": (_e, json) => (json.nodes[0].children = [0]),
  "scenes in a circle": (_e, json) => {
    json.nodes.push({ children: [3] }, { children: [2] });
    json.scenes[0].nodes.push(2);
  },
  "names that are a prototype": (e) => (e.cameras.names = { __proto__: [] }),
};

const LAYERED_CHANGES = {
  "colours of too few channels": (e) => e.toRGB.pop(),
  "colours of no number": (e) => (e.toRGB[4] = "1"),
  "textures beyond their grid": (e) => (e.planes[0].bases[0].corner = [40, 8]),
  "a corner of no whole number": (e) => (e.planes[0].bases[0].corner = [0.5, 8]),
  "a corner before the grid": (e) => (e.planes[0].bases[0].corner = [-1, 8]),
  "a grid smaller than its textures": (e) => (e.planes[0].bases[0].grid = [16, 16]),
  "no textures in a picture": (e) => (e.planes[0].bases[0].textures[1].count = 0),
  "textures without number": (e) => (e.planes[0].bases[0].textures[1].count = "5"),
  "more textures than scales": (e) => (e.planes[0].bases[0].textures[1].count = 6),
  "fewer textures than weights": (e) => e.planes[0].bases[0].textures.pop(),
  "more rows than a picture may have": (e) => {
    const [, stack] = e.planes[0].bases[0].textures;
    const numbers = Array(4000).fill(1);
    Object.assign(stack, { count: 4000, scale: numbers, zero: numbers });
  },
  "a plane too many": (e) => (e.planes = Array(17).fill(e.planes[0])),
  "a plane of no channels": (e) => (e.planes[1].channels = 0),
  "a second plane without a mean": (e) => delete e.planes[1].mean,
};

const CODED_CHANGES = {
  "codes of 9 bits": (e) => (e.planes[0].mean.bits = 9),
  "10 bits of a type that has 8": (e) => (e.planes[0].mean.mimeType = "image/png"),
  "a mean of 10 bits without scale": (e) => delete e.planes[0].mean.scale,
  "a mean of 10 bits without both": (e) => ["scale", "zero"].forEach((key) => delete e.planes[0].mean[key]),
  "scales for some textures": (e) => (e.planes[0].bases[0].textures[0].scale = [1, 1, 1, 1]),
  "pictures of 8 bits, three times as high": (e) => delete e.planes[0].mean.bits,
  "a size of no whole number": (e) => (e.cameras.size = [320, 240.5]),
  "a size of no pixels": (e) => (e.cameras.size = [0, 240]),
  "a size of three numbers": (e) => (e.cameras.size = [320, 240, 1]),
  "photographs of 4 thousand million pixels": (e) => (e.cameras.size = [65535, 65535]),
  "cameras in a view that is not there": (e) => (e.cameras.coded = 999),
  "a camera more": (e) => (e.cameras.pattern.counts = [5, 6]),
  "a pattern without columns": (e) => e.cameras.pattern.counts.pop(),
  "a pattern of millions": (e) => Object.assign(e.cameras.pattern, { counts: [100000, 2] }),
  "names twice": (e) => Object.assign(e.cameras.pattern, { parts: ["one"] }),
  "a part that is none": (e) => e.cameras.pattern.parts.push(7),
  "too few texts": (e) => e.cameras.pattern.parts.push({ axis: 1, texts: [] }),
  "control characters": (e) => e.cameras.pattern.parts.push("\u0007"),
  "no shared picture": (e) => Object.assign(e.planes[0].bases[0], { picture: 1 }),
  "a camera less": (e) => (e.cameras.pattern.counts = [4, 5]) && (e.reference = 0),
  "a texture less": (e) => (e.planes[0].bases[0].textures[0].count = 5),
  "weights in no view": (e) => (e.planes[0].bases[0].codedWeights = "4"),
  "a camera without weights": (e) => (e.cameras.heldOut = [3]),
  "a mesh that is a number": (e) => (e.mesh = 4),
  "a mesh's view by itself": (e) => (e.mesh = e.mesh.bufferView),
  "a mesh without a view": (e) => (e.mesh = {}),
  "a mesh that is none": (e) => (e.mesh.bufferView = e.planes[0].mean.bufferView),
  "no coarse mesh": (_e, json) => delete json.meshes[0].primitives[0].attributes.POSITION,
};

const PRECISE_CHANGES = {
  "a precision in no view": (e) => delete e.planes[0].mean.precision.bufferView,
  "a precision in a view that is not there": (e) => (e.planes[0].mean.precision.bufferView = 999),
  "a precision of no picture": (e, json) => (e.planes[1].mean.precision.bufferView = json.accessors[0].bufferView),
  "a precision that is no PNG": (e) => (e.planes[0].mean.precision.bufferView = e.planes[0].mean.bufferView),
  "a precision of another size": (e) => (e.planes[1].mean.precision.size = [3, 5]),
  "a precision without size": (e) => delete e.planes[0].mean.precision.size,
  "a precision of no columns": (e) => (e.planes[0].mean.precision.size = [0, 3]),
  "a precision of too many columns": (e) => (e.planes[0].mean.precision.size = [1025, 3]),
  "a precision of 8 bits' codes": (_e, json) => {
    const { mean } = find(json).planes[0];
    Object.assign(mean, { bits: 8, bufferView: mean.precision.bufferView, mimeType: "image/png" });
  },
};

/** First byte and length of each coded part within the binary chunk. */
function streamsOf(json) {
  const { mesh, cameras, planes } = find(json);
  const views = { mesh: mesh.bufferView, coded: cameras.coded.bufferView, codedWeights: planes[0].bases[0].codedWeights };
  return Object.entries(views).map(([name, view]) => {
    const { byteOffset, byteLength } = json.bufferViews[view];
    return { name, view, start: byteOffset, length: byteLength };
  });
}

/** Every stream of a coded scene as an object that names `codec`, or its own where that is null. */
function named(e, codec = null) {
  const [plane] = e.planes;
  const [basis] = plane.bases;
  e.mesh.codec = codec ?? "mesh-2";
  e.cameras.coded.codec = codec ?? "cameras-2";
  e.viewPlane.codedTriangles = { bufferView: e.viewPlane.codedTriangles, codec: codec ?? "triangles-1" };
  basis.codedWeights = { bufferView: basis.codedWeights, codec: codec ?? "weights-1" };
  plane.mean.codec = basis.textures[0].codec = codec ?? "av1-10bit-2";
}

const STREAMS = {
  mesh: (e) => e.mesh,
  cameras: (e) => e.cameras.coded,
  triangles: (e) => e.viewPlane.codedTriangles,
  weights: (e) => e.planes[0].bases[0].codedWeights,
  picture: (e) => e.planes[0].bases[0].textures[0],
  names: (e) => (e.cameras.codedNames = { bufferView: 0, count: 25 }),
};

test("streams may name their codecs; an unknown one is refused by name, and so is one of another kind", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("coded.glb"));
  const own = structuredClone(json);
  named(find(own));
  routes["/named.glb"] = { body: writeGlb({ json: own, binary }) };
  assert.deepEqual(await tryLoad(page, "named.glb"), { later: null, loaded: 6 });
  for (const [kind, stream] of Object.entries(STREAMS)) {
    for (const codec of ["soup-9", kind === "mesh" ? "png" : "mesh-2", "toString"]) {
      const other = structuredClone(own);
      stream(find(other)).codec = codec;
      routes["/named.glb"] = { body: writeGlb({ json: other, binary }) };
      const found = await tryLoad(page, "named.glb");
      const message = `A ${kind} stream has the codec "${codec}", which this viewer does not know`;
      assert.deepEqual([found.code, found.message], ["codec-unknown", `${message}; take a newer viewer.`]);
      assert.match(found.where, /^\/extensions\/EIGENFIELD_eigen_textures\/.+\/codec$/);
    }
  }
  for (const codec of ["avif", 7]) {
    const other = structuredClone(own);
    find(other).planes[0].mean.codec = codec;
    routes["/named.glb"] = { body: writeGlb({ json: other, binary }) };
    assert.equal((await tryLoad(page, "named.glb")).code, "damaged", `a picture of 10 bits as ${codec}`);
  }
  await close();
});

test("damaged coded parts are refused by name", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("coded.glb"));
  for (const { name, view, start, length } of streamsOf(json)) {
    for (const [byte, value] of [[0, 3], [1, 255]]) {
      const data = Buffer.from(binary);
      data[start + byte] = value;
      routes["/stream.glb"] = { body: writeGlb({ json, binary: data }) };
      const found = await tryLoad(page, "stream.glb");
      assert.equal(found.code, "damaged", `${name}, byte ${byte}: ${JSON.stringify(found)}`);
      assert.match(found.where, new RegExp(`/${name}$`));
      assert.match(found.message, /^The file is damaged \(.+\); make or download it again\.$/);
    }
    for (const kept of [8, Math.floor(length / 2)]) {
      const short = structuredClone(json);
      short.bufferViews[view].byteLength = kept;
      routes["/stream.glb"] = { body: writeGlb({ json: short, binary }) };
      const { code, message } = await tryLoad(page, "stream.glb");
      assert.ok(code === "truncated" || code === "damaged", `${name} of ${kept} bytes: ${code}`);
      assert.match(message, new RegExp(`^The file is (damaged|cut off) \\(.+/${name}.*\\); `), name);
    }
  }
  await close();
});

test("coded parts with any byte changed load or are refused, and nothing else", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("coded.glb"));
  for (const { name, start, length } of streamsOf(json)) {
    for (let k = 0; k < 8; k++) {
      const data = Buffer.from(binary);
      data[start + Math.floor((k * length) / 8) + (k % 3)] ^= 1 << k;
      routes["/stream.glb"] = { body: writeGlb({ json, binary: data }) };
      const { code = "loaded" } = await tryLoad(page, "stream.glb");
      assert.match(code, /^(loaded|damaged|truncated)$/, name);
    }
  }
  await close();
});

test("a damaged packed extension is refused by name, and any byte of it changed loads or is refused", async () => {
  const { page, close } = await lab.open();
  const data = sceneBytes("coded.glb");
  const length = data.readUInt32LE(12);
  const json = JSON.parse(data.toString("utf8", 20, 20 + length));
  const { byteOffset } = json.bufferViews[find(json).packed];
  const start = 28 + length + byteOffset; // the length of the JSON, then the JSON
  const size = data.readUInt32LE(start);
  for (const value of [0, size - 2, size + 1, 2 ** 31]) {
    const other = Buffer.from(data);
    other.writeUInt32LE(value, start);
    routes["/packed.glb"] = { body: other };
    const { code, where } = await tryLoad(page, "packed.glb");
    assert.deepEqual([code, where], ["damaged", `/extensions/${EXTENSION}/packed`], `${value} bytes`);
  }
  for (let k = 0; k < 24; k++) {
    const other = Buffer.from(data);
    other[start + 4 + Math.floor((k * size) / 24)] ^= 1 << k % 8;
    routes["/packed.glb"] = { body: other };
    const { code = "loaded" } = await tryLoad(page, "packed.glb");
    assert.match(code, /^(loaded|damaged|truncated|needs|version|unsupported|codec-unknown)$/);
  }
  find(json).needs.push("repacked");
  routes["/packed.glb"] = { body: writeGlb({ json, binary: readGlb(data).binary }) };
  assert.equal((await tryLoad(page, "packed.glb")).code, "needs");
  await close();
});

test("a damaged precision is refused by name", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("precise.glb"));
  const { byteOffset } = json.bufferViews[find(json).planes[0].mean.precision.bufferView];
  const cases = [["no picture", 0, 0], ["a picture of 261 x 3, not of 5 x 3", 18, 1], ["it cannot be decoded", 24, 3]];
  for (const [what, byte, value] of cases) {
    const data = Buffer.from(binary);
    data[byteOffset + byte] = value;
    routes["/precision.glb"] = { body: writeGlb({ json, binary: data }) };
    const { code, where, message } = await tryLoad(page, "precision.glb");
    assert.equal(code, "damaged", what);
    assert.match(where, /\/planes\/[01]\/mean\/precision$/);
    assert.ok(message.includes(what), message);
  }
  await close();
});

test("8 bits that are said to be 10 are refused", async () => {
  const { page, close } = await lab.open();
  const { code, message } = await tryLoad(page, "shallow.glb");
  assert.equal(code, "damaged");
  assert.match(message, /planes\/0\/mean: no picture of 10 bits/);
  await close();
});

test("a document that cannot be is refused by name", async () => {
  const { page, close } = await lab.open();
  const all = { "avif.glb": CHANGES, "layered.glb": LAYERED_CHANGES, "coded.glb": CODED_CHANGES };
  all["precise.glb"] = PRECISE_CHANGES;
  for (const [scene, changes] of Object.entries(all)) {
    const { json, binary } = readGlb(sceneBytes(scene));
    for (const [what, change] of Object.entries(changes)) {
      const changed = structuredClone(json);
      change(find(changed), changed);
      routes["/changed.glb"] = { body: writeGlb({ json: changed, binary }) };
      const found = await tryLoad(page, "changed.glb");
      assert.equal(found.code, "damaged", `${what}: ${JSON.stringify(found)}`);
      assert.match(found.message, /^The file is damaged \(.+\); make or download it again\.$/, what);
    }
  }
  await close();
});

test("a picture of several textures has their size", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("layered.glb"));
  const [, { bases }] = find(json).planes;
  Object.assign(bases[1], { size: [11, 19] });
  routes["/sizes.glb"] = { body: writeGlb({ json, binary }) };
  const { later } = await tryLoad(page, "sizes.glb");
  assert.equal(later.code, "damaged");
  assert.match(later.message, /a picture of 11 x 40, not of 11 x 38/);
  await close();
});

test("numbers in the binary chunk are checked too", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("scene.glb"));
  const { planes, cameras, viewPlane } = find(json);
  const primitive = json.meshes[0].primitives[0];
  const write = (accessor, value, kind) => (data) => {
    const { bufferView, byteOffset = 0 } = json.accessors[accessor];
    data[`write${kind}LE`](value, (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset);
  };
  const cases = {
    "a weight that is no number": write(planes[0].bases[0].weights, NaN, "Float"),
    "a focal length of 0": write(cameras.intrinsics, 0, "Float"),
    "a pose that is no rotation": write(cameras.poses, 3, "Float"),
    "a photograph of no pixels": write(cameras.sizes, 0, "UInt32"),
    "a triangle of no camera": write(viewPlane.triangles, 99, "UInt32"),
    "a vertex at infinity": write(primitive.attributes.POSITION, Infinity, "Float"),
    "an unknown vertex": write(primitive.indices, 65000, "UInt16"),
  };
  for (const [what, change] of Object.entries(cases)) {
    const data = Buffer.from(binary);
    change(data);
    routes["/numbers.glb"] = { body: writeGlb({ json, binary: data }) };
    const found = await tryLoad(page, "numbers.glb");
    assert.equal(found.code, "damaged", `${what}: ${JSON.stringify(found)}`);
  }
  await close();
});

test("JSON that is nested too deep, not UTF-8 or too long is refused", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("scene.glb"));
  const deep = JSON.stringify(json).replace(/}$/, `,"x":${"[".repeat(70)}${"]".repeat(70)}}`);
  routes["/text.glb"] = { body: writeGlb({ binary, text: deep }) };
  assert.match((await tryLoad(page, "text.glb")).message, /nested too deep/);
  const broken = writeGlb({ json, binary });
  broken[30] = 0xff;
  routes["/text.glb"] = { body: broken };
  assert.match((await tryLoad(page, "text.glb")).message, /UTF-8/);
  const long = writeGlb({ json, binary });
  long.writeUInt32LE(2 ** 31, 12);
  long.writeUInt32LE(2 ** 32 - 1, 8);
  routes["/text.glb"] = { body: long };
  assert.match((await tryLoad(page, "text.glb")).message, /bytes of JSON/);
  await close();
});

test("layouts that this viewer does not draw are named", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("layered.glb"));
  delete find(json).toRGB;
  const two = structuredClone(json);
  find(two).planes.shift();
  const channels = structuredClone(json);
  find(channels).planes.pop();
  find(channels).planes[0].bases = [];
  Object.assign(find(channels).planes[0], { channels: 4 });
  Object.assign(find(channels).planes[0].mean, { scale: [1, 1, 1, 1], zero: [0, 0, 0, 0] });
  for (const changed of [json, two, channels]) {
    routes["/layout.glb"] = { body: writeGlb({ json: changed, binary }) };
    const found = await tryLoad(page, "layout.glb");
    assert.equal(found.code, "unsupported", JSON.stringify(found));
    assert.match(found.message, /eigenfield render/);
  }
  await close();
});

test("a Blob, an ArrayBuffer and an address give the same scene", async () => {
  const { page, close } = await lab.open();
  const found = await page.evaluate(async () => {
    const response = await fetch("scene.glb");
    const blob = await response.blob();
    const buffer = await blob.arrayBuffer();
    const frame = document.createElement("iframe"); // which has classes of its own
    document.body.append(frame);
    const { Blob: Theirs, Uint8Array: Bytes } = frame.contentWindow;
    const { buffer: theirs } = new Bytes(new Uint8Array(buffer));
    const within = new Uint8Array([7, ...new Uint8Array(buffer), 7]).subarray(1, -1);
    const made = [];
    for (const source of [blob, buffer, "scene.glb", new URL("scene.glb", location), new Theirs([buffer]), theirs, within]) {
      const { gltf, field } = await window.lab.loadEigenfield(source, { renderer: window.lab.renderer });
      await field.complete;
      window.lab.show(gltf);
      window.lab.drawView(field, window.lab.novelCamera(field, 0.1, 0.2));
      const { total, mesh, mean, weights, other, textures } = field.info.bytes;
      made.push({ total, sum: mesh + mean + weights + other + textures.reduce((a, b) => a + b), size: blob.size });
      field.dispose();
    }
    const { name } = await window.lab.loadEigenfield({ url: "scene.glb" }).catch((error) => error);
    return { made, name };
  });
  assert.deepEqual([found.made.length, found.name], [7, "TypeError"]);
  for (const { total, sum, size } of found.made) assert.deepEqual([total, sum], [size, size]);
  await close();
});

test("a scene without eigen textures is its mean", async () => {
  const { page, close } = await lab.open();
  const { json, binary } = readGlb(sceneBytes("scene.glb"));
  find(json).planes[0].bases = [];
  routes["/bare.glb"] = { body: writeGlb({ json, binary }) };
  assert.deepEqual(await tryLoad(page, "bare.glb"), { later: null, loaded: 0 });
  await page.evaluate(() => window.lab.draw());
  await close();
});
