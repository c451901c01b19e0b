// A field, the source of its textures and its mesh are three things: another source fills the same textures again and
// again, another mesh takes the place of the first. Everything that draws is a fake.

import assert from "node:assert/strict";
import { after, before, beforeEach, test } from "node:test";
import { makeRenderer } from "./fake-renderer.mjs";
import { buildModule } from "./module.mjs";

let built, close;
before(async () => ({ module: built, close } = await buildModule("field")));
after(() => close());

const SIZE = [2, 2];
const OMEGA = [[1, 2], [3, 4], [5, 6]]; // of three cameras
const PLACES = [[-1, -1], [1, -1], [0, 1]]; // on the view plane
const PLANE = { origin: [0, 0, 0], right: [1, 0, 0], up: [0, 1, 0], normal: [0, 0, 1], extent: [1, 1] };
const codec = { bits: 8 };

/** A plane of one channel: a mean, and a basis of two textures in two pictures. */
function makeScene({ sheets = null } = {}) {
  const picture = (scale) => ({ view: 0, codec, textures: 1, pieces: 1, scale: [scale], zero: [0], where: "" });
  const basis = { size: SIZE, grid: SIZE, corner: [0, 0], pictures: [picture(0.5), picture(0.25)], count: 2 };
  const still = () => ({ channels: 1, mean: picture(1), meanSize: SIZE, precision: null });
  const opacity = still();
  return {
    planes: [{ ...still(), bases: [basis] }],
    colours: [[1, 1, 1]],
    sheets: sheets && { faces: sheets, opacity, where: "" },
  };
}

function makeGeometry(shift, triangles = 1) {
  const geometry = new built.BufferGeometry();
  const corners = Array.from({ length: triangles }, () => [[0, 0], [1, 0], [0, 1]]).flat();
  const position = corners.flatMap(([x, y]) => [x + shift, y, -1]);
  geometry.setAttribute("position", new built.BufferAttribute(Float32Array.from(position), 3));
  geometry.setAttribute("uv", new built.BufferAttribute(Float32Array.from(corners.flat()), 2));
  geometry.setIndex([...corners.keys()]);
  return geometry;
}

const picture = (name) => {
  return { name, width: 2, height: 2, close: () => closed.push(name) };
};
const pieceOf = (name) => ({ picture: picture(name), row: 0, rows: 2 });
const meanOf = (name) => ({ pieces: [pieceOf(name)], precision: null });
let closed = [];
beforeEach(() => (closed = []));

/** A source that puts frame 0 at once, and others when it is asked to. */
function makeFilm(scene) {
  const fillings = [];
  const film = {
    fillings,
    ended: false,
    show(frame, { opacity = false } = {}) {
      const filling = fillings.at(-1);
      filling.putMean(0, meanOf(`mean ${frame}`));
      if (opacity) filling.putMean(1, meanOf(`opacity ${frame}`));
      const { pictures } = scene.planes[0].bases[0];
      pictures.forEach((own, rank) => filling.putTextures(0, rank, [pieceOf(`texture ${rank} of ${frame}`)], own));
      filling.announce();
    },
    async fill(filling) {
      fillings.push(filling);
      film.show(0, { opacity: scene.sheets !== null });
    },
    gain: async () => 7,
    dispose: () => (film.ended = true),
  };
  return film;
}

/** A field of a film, what draws it, and `draw` from a place before the view plane. */
function makeField({ sheets = null, geometry = makeGeometry(0), meshes = 1 } = {}) {
  const scene = makeScene({ sheets });
  const source = makeFilm(scene);
  const cameras = PLACES.map(([x, y]) => ({ centre: [x, y, 0], gain: null, offset: null }));
  const heldOut = cameras.map(() => false);
  const info = { cameras, heldOut, reference: null, viewPlane: PLANE, facesPlane: true, size: SIZE, mixedColours: false };
  const weights = new built.ViewWeights(Float64Array.from(PLACES.flat()), Uint32Array.of(0, 1, 2), false);
  const shown = Array.from({ length: meshes }, () => new built.Mesh(geometry));
  const meanSizes = sheets ? [SIZE, SIZE] : [SIZE];
  const parts = { scene, info, meshes: shown, meanSizes, omega: Float32Array.from(OMEGA.flat()), weights };
  const field = new built.EigenField(parts, source, { memory: 1e8 });
  const fake = makeRenderer();
  const camera = new built.PerspectiveCamera();
  const draw = (x, y, z, by = fake) => {
    camera.position.set(x, y, z);
    camera.updateMatrixWorld();
    by.drawn.length = by.puts.length = 0;
    by.renderer.info.render.frame += 1;
    const drawing = field.mesh.children[0] ?? field.mesh; // of sheets a child
    drawing.onBeforeRender(by.renderer, null, camera);
    return by.drawn.flatMap(({ shown }) => shown);
  };
  const heard = [];
  for (const type of ["texture", "complete", "error"]) field.addEventListener(type, () => heard.push(type));
  return { field, source, fake, draw, heard, meshes: shown };
}

const NEAR = [0, 0, 0.5];
const sumsOf = (shown) => shown.filter(({ scale, visible }) => scale && visible).map(({ scale }) => scale);
const placesOf = (shown) => shown.filter(({ places }) => places).map(({ places }) => places);

test("a mean and weighted textures are summed, of a camera and by the ray", () => {
  const { field, draw } = makeField();
  field.camera = 1;
  // the mean once, the textures by the camera's weights 3 and 4; stored is code / 255, a value 0.5 or 0.25 a code
  assert.deepEqual(sumsOf(draw(...NEAR)), [[255, 0, 0, 0], [255 * 0.5 * 3, 255 * 0.25 * 4, 0, 0]]);
  assert.deepEqual(field.lastWeights.map((weights) => [...weights]), [[3, 4]]);
  assert.deepEqual(draw(1, 1, 1), [], "the same picture from elsewhere: nothing is summed again");
  field.camera = null;
  const shown = draw(...NEAR);
  assert.deepEqual(sumsOf(shown)[1], [255 * 0.5, 255 * 0.25, 0, 0]); // weights come from the maps
  assert.equal(shown.at(-1).rays, true);
});

test("another mesh takes the place of the first, and textures stay", () => {
  const first = makeGeometry(0);
  const { field, source, draw, fake, meshes } = makeField({ geometry: first, meshes: 2 });
  const gone = [];
  first.addEventListener("dispose", () => gone.push("first"));
  assert.deepEqual(placesOf(draw(...NEAR)), [[0, 0, -1, 1, 0, -1, 0, 1, -1]]);
  assert.deepEqual(placesOf(draw(0.1, 0, 0.5)), [], "the eye moves: texels lie where they lay");
  const scenes = new Set(fake.drawn.map(({ scene }) => scene));
  const before = field.gpuBytes;

  const second = makeGeometry(5, 2);
  field.setGeometry(second);
  assert.deepEqual(gone, ["first"]);
  assert.ok(meshes.every(({ geometry }) => geometry === second) && field.mesh === meshes[0]);
  const bytes = 4 * (3 + 2) * 3 + 2 * 3; // of a triangle: three vertices, three indices
  assert.equal(field.gpuBytes - before, bytes);
  const shown = draw(0.1, 0, 0.5); // the same eye: it is drawn again all the same
  assert.deepEqual(placesOf(shown), [[5, 0, -1, 6, 0, -1, 5, 1, -1, 5, 0, -1, 6, 0, -1, 5, 1, -1]]);
  assert.ok(fake.drawn.some(({ scene }) => scenes.has(scene)), "sums are drawn by what drew them before");
  assert.deepEqual([source.fillings.length, fake.puts.length], [1, 0], "no texture comes again");

  second.attributes.position.setX(0, -3); // vertices that move
  field.setGeometry(second);
  assert.deepEqual(placesOf(draw(0.1, 0, 0.5))[0].slice(0, 3), [-3, 0, -1]);
  assert.deepEqual(gone, ["first"]);
  field.weightMode = "eye";
  assert.equal(draw(0.1, 0, 0.5).length > 0, true);
  field.setGeometry(first);
  assert.deepEqual(draw(0.1, 0, 0.5), [], "where one set of weights serves all texels a sum does not know the mesh");
});

test("other sheets take the place of the first", () => {
  const { field, draw } = makeField({ sheets: [1, 1], geometry: makeGeometry(0, 2) });
  draw(...NEAR);
  const [drawing] = field.mesh.children;
  const next = makeGeometry(4, 3);
  field.setGeometry(next, [2, 1]);
  const groups = next.groups.map(({ start, count, materialIndex }) => [start, count, materialIndex]);
  assert.deepEqual(groups, [[0, 6, 0], [0, 6, 1], [6, 3, 2], [6, 3, 3]]); // of each sheet its depth, then its colours
  assert.deepEqual(drawing.geometry.boundingBox.min.toArray(), [4, 0, -1]); // it is left out of view as they would be
  field.setGeometry(next);
  assert.equal(next.groups.length, 4);
  assert.throws(() => field.setGeometry(makeGeometry(0, 4)), /the sheets have 3 triangles, the mesh has 4/);
  assert.throws(() => field.setGeometry(makeGeometry(0, 3).setIndex(null)), TypeError);
  assert.equal(field.mesh.geometry, next);
});

test("a source fills the same textures again, frame by frame", async () => {
  const { field, source, fake, draw, heard } = makeField();
  field.camera = 0;
  const first = sumsOf(draw(...NEAR));
  const arrays = new Set(fake.puts.map(({ texture }) => texture));
  const putsOf = () => fake.puts.map(({ picture, layer, component }) => [picture, layer, component]);
  const frame = (n) => [[`mean ${n}`, 0, 0], [`texture 0 of ${n}`, 0, 0], [`texture 1 of ${n}`, 0, 1]];
  assert.deepEqual(putsOf(), frame(0));
  assert.deepEqual([first.length, arrays.size, field.loaded], [2, 2, 2]);
  await field.complete;
  assert.deepEqual(heard, ["texture", "complete"]);
  const [{ scene }] = fake.drawn;
  for (const n of [1, 2]) {
    assert.deepEqual(draw(...NEAR), [], "no frame, and nothing is summed");
    source.show(n);
    assert.deepEqual(putsOf(), frame(n));
    assert.ok(fake.puts.every(({ texture }) => arrays.has(texture)));
    assert.deepEqual(sumsOf(draw(...NEAR)), first);
    assert.equal(fake.drawn[0].scene, scene, "by what summed the frame before");
  }
  assert.deepEqual(heard, ["texture", "complete", "texture", "texture"]);
});

test("textures of films stay in words where a draw sums them and the device has the layers", () => {
  const size = [64, 64];
  const plan = (channels, films, layers = 256, count = 12) => {
    const means = [{ size, channels, pieces: channels, tenBits: true }];
    const bases = [{ size, grid: size, channels, count, tenBits: true }];
    const { words, usable } = built.makePlan(
      { atlas: size, means, bases, films, rays: true, geometry: 0 },
      { side: 4096, layers, memory: 1e9 },
    );
    return [words, usable];
  };
  assert.deepEqual(plan(2, true), [true, 12]);
  assert.deepEqual(plan(2, false), [false, 12]);
  assert.deepEqual(plan(2, true, 23), [false, 12]);
  assert.deepEqual(plan(16, true, 256), [true, 12]);
  assert.deepEqual(plan(17, true, 256), [false, 12], "a file may have so many, and no draw would sum four textures of them");
});

test("opacity is drawn when it comes, and not with each frame", () => {
  const { source, fake, draw } = makeField({ sheets: [1] });
  draw(...NEAR);
  const finer = () => fake.drawn.filter(({ shown }) => shown.some((one) => one.finer)).length;
  assert.equal(finer(), 1);
  source.show(1);
  draw(...NEAR);
  assert.deepEqual([fake.drawn.length > 0, finer()], [true, 0]);
  const targets = [];
  for (const frame of [2, 3]) {
    source.show(frame, { opacity: true });
    draw(...NEAR);
    assert.equal(finer(), 1);
    targets.push(new Set(fake.drawn.map(({ target }) => target)));
  }
  assert.ok([...targets[1]].every((target) => targets[0].has(target)), "into what the frame before was drawn");
});

test("textures that are gone are filled no more, and those in their place from the start", async () => {
  const { field, source, fake, draw, heard } = makeField();
  draw(...NEAR);
  const [lost] = source.fillings;
  fake.renderer.domElement.dispatchEvent(new Event("webglcontextlost"));
  assert.deepEqual([lost.signal.aborted, field.loaded], [true, 0]);
  fake.renderer.domElement.dispatchEvent(new Event("webglcontextrestored"));
  assert.deepEqual([source.fillings.length, field.loaded], [2, 2]);
  fake.puts.length = heard.length = 0;
  lost.putMean(0, meanOf("late"));
  lost.putTextures(0, 0, [pieceOf("late")], makeScene().planes[0].bases[0].pictures[0]);
  lost.announce();
  lost.end();
  assert.deepEqual([fake.puts, heard], [[], []]);
  source.fillings[1].end();
  source.show(1);
  assert.deepEqual(fake.puts.map(({ picture }) => picture), ["mean 1"]); // an array as large as it needs nothing else
  field.dispose();
  assert.ok(source.ended && source.fillings[1].signal.aborted);
});

test("another renderer gets the textures of one that is gone, and not of one that is there", async () => {
  const { field, source, fake, draw } = makeField();
  draw(...NEAR);
  const other = makeRenderer();
  draw(...NEAR, other);
  assert.equal(source.fillings.length, 1);
  fake.lose();
  draw(...NEAR, other);
  draw(...NEAR, other);
  assert.deepEqual([source.fillings.length, source.fillings[0].signal.aborted, field.loaded], [2, true, 2]);
  await field.complete;
  const never = makeField();
  never.field.dispose();
  await assert.rejects(never.field.complete, { name: "AbortError" });
});

test("how visible an eigen texture is made is the source's to say", async () => {
  const { field, draw } = makeField();
  field.view = "eigen";
  draw(...NEAR);
  await new Promise((resolve) => field.addEventListener("texture", resolve));
  draw(...NEAR);
  assert.equal(field.mesh.material.uniforms.shownGain.value, 7);
});

/** The pictures of a file: two planes whose textures come in pictures of one and of two. */
function makeStill() {
  const decoding = [];
  const decode = (bytes, { name, textures }) => {
    decoding.push(name);
    return Promise.resolve(Array.from({ length: textures }, (_, i) => pieceOf(`${name}.${i}`)));
  };
  const made = (name, textures = 1) => {
    return { name, textures, pieces: 1, view: 0, codec: { bits: 8, decode }, scale: [1], zero: [0] };
  };
  const plane = (name, pictures) => {
    const bases = [{ size: SIZE, pictures, count: pictures.reduce((sum, { textures }) => sum + textures, 0) }];
    return { channels: 1, mean: made(`${name} mean`), meanSize: SIZE, precision: null, bases };
  };
  const luma = plane("luma", [made("luma 0"), made("luma 1", 2), made("luma 3")]);
  const chroma = plane("chroma", [made("chroma 0", 2), made("chroma 2")]);
  const scene = { planes: [luma, chroma], sheets: null };
  return { decoding, source: built.stillTextures(scene, async () => null, [meanOf("luma"), meanOf("chroma")]) };
}

/** What is put, in order. `each` is called after every picture. */
function makeFilling(usable, each = () => undefined) {
  const [done, stop] = [[], new AbortController()];
  const filling = {
    plan: { usable },
    signal: stop.signal,
    putMean: (index, { pieces }) => done.push(`mean ${index}: ${pieces[0].picture.name}`),
    putTextures: (basis, first, pieces) => done.push(`${basis}, ${first}: ${pieces.map((p) => p.picture.name)}`),
    announce: () => each(stop),
    end: () => done.push("end"),
  };
  return { done, filling };
}

test("the pictures of a file come by rank, the means at once", async () => {
  const { source, decoding } = makeStill();
  const ahead = [];
  const { done, filling } = makeFilling(4, () => ahead.push(decoding.length));
  const filled = source.fill(filling);
  assert.deepEqual(done, ["mean 0: luma", "mean 1: chroma"]);
  assert.deepEqual(closed, ["luma", "chroma"]);
  await filled;
  const textures = ["0, 0: luma 0.0", "1, 0: chroma 0.0,chroma 0.1", "0, 1: luma 1.0,luma 1.1", "1, 2: chroma 2.0"];
  assert.deepEqual(done.slice(2), [...textures, "0, 3: luma 3.0", "end"]);
  assert.deepEqual(ahead, [3, 4, 5, 5, 5]); // pictures whose decoding had begun
  assert.equal(closed.length, 2 + 7);
  const again = makeFilling(1);
  await source.fill(again.filling); // the means are decoded anew; of each basis one texture has room
  const few = ["mean 0: luma mean.0", "mean 1: chroma mean.0", ...textures.slice(0, 2), "end"];
  assert.deepEqual(again.done, few);
});

test("a fill that is stopped decodes no more, and closes what it has", async () => {
  const { source, decoding } = makeStill();
  const { done, filling } = makeFilling(4, (stop) => stop.abort());
  await source.fill(filling);
  assert.equal(done.at(-1), "0, 0: luma 0.0");
  await new Promise((resolve) => setImmediate(resolve));
  assert.deepEqual([decoding.length, closed.length], [3, 2 + 1 + 2 + 2]);
  const other = makeStill();
  other.source.dispose();
  assert.deepEqual(closed.slice(-2), ["luma", "chroma"]); // nobody else would
});
