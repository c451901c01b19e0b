// The table of codecs against the schema, and its decoders of meshes, weights, cameras, triangles and names against
// what Python codes and decodes, damaged bytes included.

import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { deflateRawSync } from "node:zlib";
import { fileURLToPath } from "node:url";
import { python } from "./command.mjs";
import { buildModule } from "./module.mjs";

const path = (name) => fileURLToPath(new URL(name, import.meta.url));
let folder, names, built, close;

before(async () => {
  ({ module: built, folder, close } = await buildModule("coding"));
  python("-m", "support.coded_vectors", folder);
  names = (await readdir(folder)).filter((name) => name.endsWith(".bin")).map((name) => name.slice(0, -4));
});

after(() => close());

const decoderOf = (kind, version = 1) => built.CODECS[`${kind}-${version}`].decode;

async function vector(name) {
  const bytes = new Uint8Array(await readFile(join(folder, `${name}.bin`)));
  const expected = JSON.parse(await readFile(join(folder, `${name}.json`), "utf8"));
  const kind = name.split("-")[0];
  const version = kind === "mesh" ? Math.min(Math.max(bytes[0], 1), 2) : 1;
  return { expected, decode: () => decoderOf(kind, version)(bytes, "here") };
}

test("the table has the schema's codecs, and what they need is known", async () => {
  const schema = JSON.parse(await readFile(path("../../docs/schema/EIGENFIELD_eigen_textures.schema.json"), "utf8"));
  const kinds = Object.values(built.CODECS).map(({ kind }) => kind);
  for (const kind of new Set(kinds)) {
    const own = Object.keys(built.CODECS).filter((name) => built.CODECS[name].kind === kind);
    assert.deepEqual(own.sort(), schema.$defs[`${kind}Codec`].enum.toSorted(), kind);
  }
  assert.deepEqual(new Set(kinds).size, Object.keys(schema.$defs).filter((name) => name.endsWith("Codec")).length - 1);
  assert.deepEqual([...built.KNOWN_NEEDS].sort(), schema.$defs.feature.enum.toSorted());
});

test("the table is Python's", () => {
  const listed = "[c.kind, c.needs, sorted(c.limits), getattr(c, 'mime', None), getattr(c, 'bits', None)]";
  const table = `{name: ${listed} for name, c in CODECS.items()}`;
  const text = `import json; from eigenfield.coding.codecs import CODECS; print(json.dumps(${table}))`;
  const expected = JSON.parse(python("-c", text));
  delete expected["video-1"]; // a residual's, which the plug-in does not draw
  const own = Object.entries(built.CODECS).map(([name, { kind, needs, limits, mimeType = null, bits = null }]) => {
    return [name, [kind, needs, limits.toSorted(), mimeType, bits]];
  });
  assert.deepEqual(Object.fromEntries(own), expected);
});

/** The same numbers; floats but for the last digit, which sums in another order may change. */
function assertAlike(found, expected, name) {
  for (const [part, numbers] of Object.entries(expected)) {
    assert.equal(found[part].length, numbers.length, `${name}: ${part}`);
    const scale = numbers.reduce((most, x) => Math.max(most, Math.abs(x)), 1e-30);
    numbers.forEach((x, i) => {
      if (Math.abs(found[part][i] - x) > 1e-6 * scale) assert.fail(`${name}: ${part}[${i}] is ${found[part][i]}, not ${x}`);
    });
  }
}

test("what Python codes decodes to the same numbers", async () => {
  const whole = names.filter((name) => !name.includes("damaged"));
  assert.equal(whole.length, 12);
  for (const name of whole) {
    const { expected, decode } = await vector(name);
    assert.notEqual(expected, null, name);
    assertAlike(decode(), expected, name);
  }
});

test("a mesh decodes to the same bits", async () => {
  const meshes = ["mesh-relief", "mesh-coarse", "mesh-fine", "mesh-ball", "mesh-soup", "mesh-before", "mesh-sheets"];
  for (const name of meshes) {
    const { expected, decode } = await vector(name);
    const found = decode();
    for (const part of ["positions", "uv", "indices"]) assert.deepEqual([...found[part]], expected[part], name);
  }
});

test("damaged bytes give what Python makes of them, or an error of ours", async () => {
  let [read, refused] = [0, 0];
  for (const name of names.filter((name) => name.includes("damaged"))) {
    const { expected, decode } = await vector(name);
    if (expected === null) {
      assert.throws(decode, (error) => error.name === "SceneError", name);
      refused += 1;
    } else {
      assertAlike(decode(), expected, name);
      read += 1;
    }
  }
  assert.ok(read > 20 && refused > 20, `${read} read, ${refused} refused`);
});

test("names decode to the same names, damaged ones too or to an error of ours", async () => {
  let [read, refused] = [0, 0];
  for (const [text, count, expected] of JSON.parse(await readFile(join(folder, "names.json"), "utf8"))) {
    const found = decoderOf("names")(Uint8Array.from(Buffer.from(text, "base64")), count, "here");
    if (expected === null) {
      await assert.rejects(found, (error) => error.name === "SceneError", `${count} names of ${text.slice(0, 80)}`);
      refused += 1;
    } else {
      assert.deepEqual(await found, expected);
      read += 1;
    }
  }
  assert.ok(read >= 3 && refused > 20, `${read} read, ${refused} refused`);
});

test("places of a mesh over time decode to the same bits, damaged ones too or to an error of ours", async () => {
  let [read, refused] = [0, 0];
  const bytes = (text) => Uint8Array.from(Buffer.from(text, "base64"));
  for (const [stream, data, expected] of JSON.parse(await readFile(join(folder, "motion.json"), "utf8"))) {
    const mesh = decoderOf("mesh", 2)(bytes(stream), "here");
    const decode = () => {
      const motion = decoderOf("motion")(bytes(data), mesh, "here");
      motion.read(Infinity);
      return Array.from({ length: motion.frames }, (_, frame) => {
        const positions = new Float32Array(mesh.positions.length);
        motion.place(frame, positions);
        return [...positions];
      });
    };
    if (expected === null) {
      assert.throws(decode, (error) => error.name === "SceneError");
      refused += 1;
    } else {
      assert.deepEqual(decode(), expected);
      read += 1;
    }
  }
  assert.ok(read > 20 && refused > 10, `${read} read, ${refused} refused`);
});

test("deflated cameras are the same cameras, and damaged ones an error of ours", async () => {
  const { decode } = built.CODECS["cameras-2"];
  for (const name of ["cameras-line", "cameras-grid"]) {
    const { expected } = await vector(name);
    const plain = await readFile(join(folder, `${name}.bin`));
    const bytes = Buffer.concat([Buffer.from([2]), deflateRawSync(plain.subarray(1))]);
    assertAlike(await decode(new Uint8Array(bytes), "here"), expected, name);
    const huge = Buffer.concat([Buffer.from([2]), deflateRawSync(Buffer.alloc(2 ** 23))]);
    for (const wrong of [plain, bytes.subarray(0, -9), Buffer.from([2]), huge]) {
      await assert.rejects(decode(new Uint8Array(wrong), "here"), { name: "SceneError" });
    }
  }
});

test("large numbers in few bytes allocate nothing", async () => {
  const counts = [["mesh-ball", 4], ["mesh-ball", 12], ["weights-grid", 6], ["cameras-line", 6], ["triangles-grid", 1]];
  for (const [name, at] of counts) {
    const bytes = new Uint8Array(await readFile(join(folder, `${name}.bin`)));
    new DataView(bytes.buffer).setUint32(at, 2 ** 26, true);
    const kind = name.split("-")[0];
    assert.throws(() => decoderOf(kind, kind === "mesh" ? 2 : 1)(bytes, "here"), { name: "SceneError" });
  }
});
