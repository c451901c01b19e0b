// The timeline of a clip, the heads of its groups, and its player with decoders of every manner. Needs no browser.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, beforeEach, test } from "node:test";
import { deflateRawSync, inflateRawSync } from "node:zlib";
import { python } from "./command.mjs";
import { FakeFrame, installClock, installFakes } from "./fake-video.mjs";
import { buildModule } from "./module.mjs";

const EXTENSION = "EIGENFIELD_eigen_textures";
let built, close, json, chunk, facts, moving, sheets, mesh;

before(async () => {
  let folder;
  ({ module: built, folder, close } = await buildModule("clip"));
  python("-m", "support.viewer_clips", folder);
  facts = JSON.parse(readFileSync(join(folder, "clip.json"), "utf8"));
  ({ json, chunk, mesh } = await opened(join(folder, "clip.glb")));
  sheets = await opened(join(folder, "clip-sheets.glb"));
  moving = { ...(await opened(join(folder, "moving.glb"))), positions: join(folder, "moving.json") };
});
after(() => close());

/** The document of a clip's file, the data of its groups, and its mesh. */
async function opened(path) {
  const bytes = readFileSync(path);
  const chunks = [];
  for (let at = 12; at < bytes.length; at += 8 + bytes.readUInt32LE(at)) {
    chunks.push(bytes.subarray(at + 8, at + 8 + bytes.readUInt32LE(at)));
  }
  const json = await built.unpacked(JSON.parse(chunks[0]), read(chunks[1]));
  const scene = built.readDocument(json);
  const { offset, length } = scene.views[scene.mesh.view];
  const mesh = scene.mesh.codec.decode(new Uint8Array(await read(chunks[1])(offset, length)), scene.mesh.where);
  return { json, chunk: chunks[2], mesh };
}

/** The document after its extension was changed. */
function changed(change = () => undefined, document = json) {
  const copy = structuredClone(document);
  change(copy.extensions[EXTENSION].timeline, copy.extensions[EXTENSION]);
  return built.readDocument(copy);
}

const read = (data) => (offset, length) => Promise.resolve(new Uint8Array(data.subarray(offset, offset + length)).buffer);
const placed = (data) => ({ offset }, length) => read(data)(offset, length); // of a group
const damaged = (part) => (error) => error.code === "damaged" && error.where.includes(part);

test("a timeline is read, and frames have times and groups", () => {
  const { timeline, planes } = changed();
  const frames = facts.groups.reduce((a, b) => a + b);
  assert.deepEqual([timeline.frames, timeline.rate, timeline.first], [frames, facts.rate[0] / facts.rate[1], 0]);
  assert.deepEqual(timeline.groups.map((group) => group.frames), facts.groups);
  assert.deepEqual(timeline.films.map(({ codec }) => codec.needs), ["film-1", "film-1"]);
  assert.deepEqual(planes[0].bases.map(({ count }) => count), [facts.textures]);
  const groups = facts.groups.flatMap((count, i) => Array(count).fill(i));
  assert.deepEqual(Array.from({ length: frames }, (_, i) => built.groupOf(timeline, i)), groups);
  for (let i = 0; i < frames; i++) {
    for (const off of [-0.49, 0, 0.49]) assert.equal(built.frameAt(timeline, built.timeOf(timeline, i + off)), i);
  }
  assert.deepEqual([-9, 1e9].map((time) => built.frameAt(timeline, time)), [0, frames - 1]);
});

const FAULTS = {
  "no sum of frames": ["timeline/groups", (timeline) => (timeline.frames += 1)],
  "a rate of nothing": ["timeline/rate", (timeline) => (timeline.rate = [1, 0])],
  "a rate beyond bounds": ["timeline/rate", (timeline) => (timeline.rate = [2000, 1])],
  "no films": ["planes", (timeline) => (timeline.films = [])],
  "a side of a film": ["films/0/size", (timeline) => (timeline.films[0].size = [100, 128])],
  "a group over another": ["groups/1/offset", (timeline) => (timeline.groups[1].offset = 4)],
  "a group not aligned": ["groups/1/offset", (timeline) => (timeline.groups[1].offset += 1)],
  "a group nowhere": ["groups/1/offset", (timeline) => delete timeline.groups[1].offset],
  "files or not": ["timeline/groupFiles", (timeline) => (timeline.groupFiles = false)],
  "no digest": ["groups/0/sha256", (timeline) => (timeline.groups[0].sha256 = "00")],
  "a place that leaves the film": ["mean", (_, { planes }) => (planes[0].mean.at = [[4096, 0]])],
  "a place at 8": ["mean", (_, { planes }) => (planes[0].mean.at = [[8, 0]])],
  "two textures at a place": ["bases/0", (_, { planes: [{ bases: [basis] }] }) => (basis.at[1] = basis.at[0])],
  "a film that is not there": ["mean", (_, { planes }) => (planes[0].mean.film = 3)],
  "places for half a texture": ["planes/1/mean", (_, { planes }) => planes[1].mean.at.pop()],
  "no mesh": ["mesh", (_, extension) => delete extension.mesh],
  "films and no timeline": ["mean", (_, extension) => delete extension.timeline],
};

test("a timeline that cannot be is refused with its place", () => {
  for (const [name, [part, change]] of Object.entries(FAULTS)) assert.throws(() => changed(change), damaged(part), name);
});

test("groups and sound of a folder are files, whose names the document does not say", () => {
  const audio = { mimeType: "audio/ogg", length: 99 };
  const { timeline } = changed((timeline) => Object.assign(timeline, { groupFiles: true, audio }));
  const names = timeline.groups.map((_, i) => `groups/0000${i}.eftg`);
  assert.deepEqual(timeline.groups.map(({ file, offset }) => [file, offset]), names.map((name) => [name, 0]));
  assert.deepEqual(timeline.sound, { ...audio, first: 0, offset: 0, file: "sound.opus" });
  assert.deepEqual(changed().timeline.groups.map(({ file }) => file), names.map(() => null));
});

const SHEET_FAULTS = {
  "two places": ["opacity/at", ({ opacity }) => opacity.at.push([64, 0])],
  "no place": ["opacity/at", ({ opacity }) => (opacity.at = [])],
  "a place at 8": ["opacity", ({ opacity }) => (opacity.at = [[8, 0]])],
  "a film of others": ["opacity", ({ opacity }) => (opacity.film = 0)],
  "a film that is not there": ["opacity", ({ opacity }) => (opacity.film = 3)],
  "a side beyond the film": ["opacity", ({ opacity }) => (opacity.size = [129, 64])],
  "no faces": ["sheets/faces", (own) => (own.faces = [])],
  "a picture in a clip": ["opacity", (own) => (own.opacity = { bufferView: 0, mimeType: "image/png", size: [8, 8] })],
  "a film in a scene": ["mean", (_, extension) => delete extension.timeline],
};

test("the opacity of sheets lies in a film of its own; where that cannot be it is refused with its place", () => {
  const { sheets: own, timeline } = changed(undefined, sheets.json);
  assert.deepEqual([own.faces.length, own.opacity.mean.part.film, own.opacity.meanSize], [2, 2, [128, 64]]);
  assert.ok(Math.abs(1023 * own.opacity.mean.scale[0] - 1) < 1e-12 && own.opacity.mean.zero[0] === 0);
  assert.deepEqual(timeline.films.map(({ opacity }) => opacity), [false, false, true]);
  for (const [name, [part, change]] of Object.entries(SHEET_FAULTS)) {
    const wrong = (_, extension) => change(extension.sheets, extension);
    assert.throws(() => changed(wrong, sheets.json), damaged(part), name);
  }
});

test("groups are opened with weights, scales and units; what is damaged says where", async () => {
  const scene = changed();
  const groups = new built.Groups(scene, scene.timeline, mesh, placed(chunk));
  for (const [index, { first, frames }] of scene.timeline.groups.entries()) {
    const group = await groups.open(index);
    assert.deepEqual([group.index, group.first, group.frames, group.units.length], [index, first, frames, frames]);
    assert.equal(group.omega.length, scene.heldOut.length * facts.textures);
    assert.deepEqual([group.means.length, group.bases.length], [2, 1]);
    assert.equal(group.bases[0].scale.length, facts.textures);
  }
  const wrong = Buffer.from(chunk);
  wrong[scene.timeline.groups[1].offset + 60] ^= 1;
  await assert.rejects(new built.Groups(scene, scene.timeline, mesh, placed(wrong)).open(1), damaged("groups/1"));
});

test("a mesh that moves is in each frame where Python puts it, also a group's own, in whatever order frames are asked for", async () => {
  const expected = JSON.parse(readFileSync(moving.positions, "utf8"));
  const scene = built.readDocument(moving.json);
  const groups = new built.Groups(scene, scene.timeline, moving.mesh, placed(moving.chunk));
  for (const [index, { first, frames }] of scene.timeline.groups.entries()) {
    const { mesh, motion } = await groups.open(index);
    assert.equal(motion === null, index === 2);
    assert.equal(mesh === moving.mesh, index !== 1);
    const positions = Float32Array.from(mesh.positions);
    for (const frame of [0, frames - 1, 1 % frames, frames >> 1]) {
      motion?.read(frame);
      motion?.place(frame, positions);
      assert.deepEqual([...positions], expected[first + (motion ? frame : 0)], `frame ${first + frame}`);
    }
  }
});

test("the first frame is there before the others of its group are", async () => {
  const scene = changed();
  let last = 0;
  const counted = (place, length) => {
    last = Math.max(last, place.offset + length);
    return placed(chunk)(place, length);
  };
  const groups = new built.Groups(scene, scene.timeline, mesh, counted);
  const [first, whole] = [await groups.begin(), await new built.Groups(scene, scene.timeline, mesh, placed(chunk)).open(0)];
  assert.deepEqual(first.units, whole.units.slice(0, 1));
  assert.deepEqual([first.omega, first.means, first.bases], [whole.omega, whole.means, whole.bases]);
  const rest = whole.units.slice(1).flat().reduce((sum, unit) => sum + unit.length, 0);
  assert.equal(last, scene.timeline.groups[0].length - rest);
  const none = new built.Groups(scene, scene.timeline, mesh, () => Promise.resolve(new ArrayBuffer(2)));
  await assert.rejects(none.begin(), { code: "damaged" });
});

test("heads of groups that cannot be are refused", async () => {
  const scene = changed();
  const [place] = scene.timeline.groups;
  const own = chunk.subarray(0, place.length);
  const size = own.readUInt32LE(0);
  const head = JSON.parse(inflateRawSync(own.subarray(4, 4 + size)));
  const openWith = (change) => {
    const copy = structuredClone(head);
    change(copy);
    const text = deflateRawSync(JSON.stringify(copy));
    const length = Buffer.alloc(4);
    length.writeUInt32LE(text.length);
    const made = Buffer.concat([length, text, own.subarray(4 + size)]);
    Object.assign(place, { length: made.length, sha256: createHash("sha256").update(made).digest("hex") });
    return new built.Groups(scene, scene.timeline, mesh, placed(made)).open(0);
  };
  assert.equal((await openWith(() => undefined)).frames, place.frames);
  const faults = {
    "a frame less": (copy) => copy.frames.pop(),
    "a unit less": (copy) => copy.frames[1].pop(),
    "a unit of nothing": (copy) => (copy.frames[1][0] = 0),
    "a unit beyond the end": (copy) => (copy.frames.at(-1)[1] += 1),
    "weights of another number": (copy) => copy.weights.pop(),
    "scales of another number": (copy) => copy.bases[0].pop(),
  };
  for (const [name, change] of Object.entries(faults)) {
    await assert.rejects(openWith(change), { code: "damaged" }, name);
  }
  const cut = new built.Groups(scene, scene.timeline, mesh, placed(Buffer.from([255, 255, 255, 255])));
  await assert.rejects(cut.open(0), { code: "damaged" });
});

// ---- the player, with decoders that only count

const clock = installClock();
const manner = {};
beforeEach(() => Object.keys(manner).forEach((key) => delete manner[key]));

/** A player of the clip. `shown`: of each frame its number, and the timestamps and widths that its films hold. */
function makePlayer() {
  installFakes(manner);
  const scene = changed();
  const groups = new built.Groups(scene, scene.timeline, mesh, placed(chunk));
  const [shown, failed] = [[], []];
  const numbers = (codes) => codes && [...new Uint32Array(codes.data.slice(0, 8).buffer)];
  const player = new built.Player(scene.timeline, (user) => new built.FrameRing(scene.timeline, groups, user), {
    show: ({ position, number, group, films }) => shown.push({ position, number, group, films: films.map(numbers) }),
    failed: (reason) => failed.push(reason),
  });
  return { player, shown, failed, timeline: scene.timeline };
}

function assertWhole(shown, timeline) {
  for (const { position, number, group, films } of shown) {
    assert.equal(number, position % timeline.frames);
    assert.equal(group.index, built.groupOf(timeline, number));
    assert.deepEqual(films, timeline.films.map(({ size }) => [position, size[0]]), `frame ${number}`);
  }
}

async function until(check) {
  for (let i = 0; i < 4000 && !check(); i++) await new Promise((resolve) => setTimeout(resolve, 2));
  assert.ok(check(), check.toString());
}

const MANNERS = { "in order": {}, "that keep two back": { delayed: 2 }, "that shuffle their frames": { shuffled: true } };
for (const [name, how] of Object.entries(MANNERS)) {
  for (const speed of Object.keys(how).length ? [2] : [0.5, 1, 2, 7]) {
    test(`decoders ${name}: at speed ${speed} each frame is shown with films of its own, and none stays open`, async () => {
      Object.assign(manner, how);
      const { player, shown, failed, timeline } = makePlayer();
      player.speed = speed;
      player.play();
      await until(() => shown.length > 20 && shown.at(-1).position > timeline.frames + 3);
      player.pause();
      assertWhole(shown, timeline);
      const positions = shown.map(({ position }) => position);
      assert.deepEqual(positions, positions.toSorted((a, b) => a - b));
      await until(() => FakeFrame.open === 0);
      assert.deepEqual([player.open, failed], [0, []]);
      player.dispose();
    });
  }

  test(`decoders ${name}: after each of sixty seeks its frame is shown`, async () => {
    Object.assign(manner, how);
    const { player, shown, timeline } = makePlayer();
    for (let i = 0; i < 60; i++) {
      const wanted = (i * i * 7 + 3 * i) % timeline.frames;
      if (i % 3 === 0) player.play();
      await player.toFrame(wanted);
      if (i % 3) assert.equal(player.frame, wanted);
      player.pause();
    }
    const at = player.frame;
    await player.step(-1);
    assert.equal(player.frame, (at + timeline.frames - 1) % timeline.frames);
    assertWhole(shown, timeline);
    player.dispose();
  });
}

test("of many seeks at once the last is shown, and all are answered", async () => {
  const { player, shown, timeline } = makePlayer();
  await Promise.all([20, 3, 11, 24, 0, 16].map((frame) => player.toFrame(frame)));
  assert.equal(player.frame, 16);
  assertWhole(shown, timeline);
  assert.ok(shown.length <= 3, "those between are not decoded");
  for (const act of ["seek", "toFrame", "step"]) assert.throws(() => player[act](NaN), RangeError, act);
  await player.toFrame(3);
  assert.equal(player.frame, 3, "what is no number is not waited for");
  player.dispose();
});

for (const ahead of [0, 30]) test(`the clock goes as fast as the speed says where decoders keep up: ${ahead} ms ahead by others`, async () => {
  const { player, shown, timeline } = makePlayer();
  const other = (now) => { // a loop of the page, whose time is later than the player's own
    player.update(now + ahead);
    if (player.playing) requestAnimationFrame(other);
  };
  player.play();
  if (ahead > 0) requestAnimationFrame(other);
  await until(() => shown.length > 3);
  const [begun, position] = [clock.now, shown.at(-1).position];
  await until(() => clock.now > begun + 3000);
  const frames = ((clock.now - begun) / 1000) * timeline.rate;
  assert.ok(Math.abs(shown.at(-1).position - position - frames) < 6, `${shown.at(-1).position - position} of ${frames}`);
  player.dispose();
});

test("decoders that are too slow bring means alone, until it is paused or sought, or they are quick again", async () => {
  const { player, shown, failed, timeline } = makePlayer();
  assert.deepEqual(timeline.films.map(({ detail }) => detail), [false, true]);
  manner.slow = 80;
  player.play();
  await until(() => player.fallbacks.includes("textures"));
  await until(() => shown.at(-1).position > timeline.frames + 2);
  const plain = shown.filter(({ films }) => films.includes(null));
  assert.ok(plain.length > 4);
  for (const { position, films } of plain) assert.deepEqual(films, [[position, timeline.films[0].size[0]], null]);
  assertWhole(shown.filter(({ films }) => !films.includes(null)), timeline);
  manner.slow = 0;
  const at = player.frame;
  player.pause();
  await until(() => !player.waiting);
  assert.deepEqual([player.frame, player.fallbacks], [at, []]);
  assertWhole(shown.slice(-1), timeline);
  await player.toFrame(20);
  const { length } = shown;
  player.play();
  await until(() => shown.length > length + 12);
  assertWhole(shown.slice(length), timeline);
  assert.deepEqual(failed, []);
  player.dispose();
});

test("a seek that takes long shows frames on the way, and plays on from where it ended", async () => {
  const { player, shown, failed, timeline } = makePlayer();
  manner.slow = 80;
  const late = [];
  for (const [from, wanted] of [[14, 24], [6, 11], [13, 23]]) {
    await player.toFrame(from);
    shown.length = 0;
    await player.toFrame(wanted);
    late.push(shown.length);
    assert.equal(shown.at(-1).number, wanted);
    assertWhole(shown, timeline);
  }
  assert.ok(Math.max(...late) > 1, `${late}`);
  assert.equal(player.late, 0, "what is on the way is not late");
  await player.toFrame(14);
  const [first, last] = [player.toFrame(24), player.toFrame(18)];
  await Promise.all([first, last]);
  assert.equal(player.frame, 18);
  manner.slow = 0;
  shown.length = 0;
  player.play();
  await until(() => shown.length > 3);
  assertWhole(shown, timeline);
  assert.ok(shown[0].number > 18 && shown[0].number < 24, `${shown[0].number}`);
  assert.deepEqual(failed, []);
  player.dispose();
});

test("a decoder that fails once has its group again", async () => {
  const { player, shown, failed, timeline } = makePlayer();
  let times = 0;
  manner.fails = (timestamp) => timestamp === 8 && times++ === 0;
  player.play();
  await until(() => shown.at(-1)?.position > timeline.frames);
  assertWhole(shown, timeline);
  assert.deepEqual([failed, times > 0], [[], true]);
  assert.ok(shown.some(({ number }) => number > 8 && number < 12), "frames behind it");
  player.dispose();
});

test("a group that is damaged is left out with a line, and the rest plays on", async () => {
  const { player, shown, failed, timeline } = makePlayer();
  const bad = timeline.groups[1];
  manner.fails = (timestamp) => timestamp % timeline.frames === bad.first + 2;
  player.play();
  await until(() => shown.at(-1)?.position > timeline.frames + bad.first + bad.frames);
  assertWhole(shown, timeline);
  assert.deepEqual(failed.map(({ code }) => code), ["damaged"]);
  const seen = new Set(shown.map(({ number }) => number));
  assert.ok(seen.has(bad.first - 1) && seen.has(bad.first + bad.frames), "all up to it, and all behind it");
  const { frame } = player;
  player.pause();
  await player.toFrame(bad.first);
  assert.deepEqual([player.frame, player.waiting], [frame, false]);
  await player.toFrame(20);
  assert.equal(player.frame, 20);
  player.dispose();
  await until(() => FakeFrame.open === 0);
});

test("without a decoder nothing is shown, and it is said each time", async () => {
  const { player, shown, failed } = makePlayer();
  delete globalThis.VideoDecoder;
  for (const times of [1, 2]) {
    player.play();
    await until(() => failed.length === times);
    assert.deepEqual([player.playing, shown.length, failed.at(-1).code], [false, 0, "codec"]);
  }
  installFakes(manner);
  player.play();
  await until(() => shown.length > 3);
  player.dispose();
});

test("decoders that the browser takes back are made anew, while it plays and after a rest", async () => {
  const { player, shown, failed, timeline } = makePlayer();
  const takeBack = () => globalThis.VideoDecoder.made.filter(({ state }) => state !== "closed").forEach((one) => one.takeBack());
  player.play();
  for (const count of [4, 8]) {
    await until(() => shown.length > count);
    takeBack();
  }
  await until(() => shown.length > 12);
  player.pause();
  takeBack();
  const at = player.frame;
  await player.step(1);
  assert.equal(player.frame, (at + 1) % timeline.frames);
  assertWhole(shown, timeline);
  assert.deepEqual(failed, []);
  player.dispose();
});

test("frames of eight bits, and those of colours, become codes of ten", async () => {
  const frame = (format, bytes, stride) => ({
    format,
    visibleRect: { width: 2, height: 2 },
    allocationSize: () => bytes.length,
    copyTo: async (data) => (data.set(bytes), [{ offset: 1, stride }]),
  });
  const codes = ({ data }) => [...new Uint16Array(data.slice(0, 8).buffer)];
  const luma = await built.codesOf(frame("NV12", [9, 0, 85, 7, 255, 128, 7], 3), null);
  assert.deepEqual(codes(luma), [0, 341, 1023, 514]);
  const colours = Array.from({ length: 17 }, (_, i) => (i % 4 === 2 ? 85 : 1));
  assert.deepEqual(codes(await built.codesOf(frame("BGRX", colours, 8), null)), [341, 341, 341, 341]);
  const greys = Array.from({ length: 17 }, (_, i) => (i % 4 === 2 ? [80, 0, 130, 255][(i - 2) / 4] : 1));
  const stretched = { ...frame("BGRX", greys, 8), colorSpace: { fullRange: false } };
  assert.deepEqual(codes(await built.codesOf(stretched, null)), [341, 64, 514, 943]); // made of 85, 16, 128 and 235
  assert.deepEqual(codes(await built.codesOf(stretched, null, true)), [341, 0, 514, 1023]); // of an opacity: none and all
  await assert.rejects(built.codesOf(frame(null, [], 0), null), { code: "unsupported" });
});
