// The sources as a graph: no circle of imports, no exported type twice; and types that follow the schema. Needs Node.js
// alone.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join, relative, resolve } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const WEB = fileURLToPath(new URL("..", import.meta.url));
const FOLDERS = ["eigenfield-three/src", "viewer/src", "example", "benchmarks", "scripts", "tests"];
const PACKAGES = { "eigenfield-three": "eigenfield-three/src/index.ts" };
const IMPORT = /^(?:import|export)\b[^"';]*?(?:\bfrom\s*)?["']([^"']+)["']|\bimport\(\s*["']([^"']+)["']\s*\)/gm;
const EXPORTED_TYPE = /^export (?:declare |abstract )*(?:class|interface|type|enum) (\w+)/gm;

const sources = new Map(
  FOLDERS.map((folder) => join(WEB, folder))
    .flatMap((folder) => readdirSync(folder, { recursive: true }).map((name) => join(folder, name)))
    .filter((path) => /\.(ts|mjs)$/.test(path))
    .map((path) => [path, readFileSync(path, "utf8")]),
);

/** The file of ours that an import names, if it names one: `./x.js` and `./x` are both `x.ts`. */
function target(from, name) {
  const packaged = PACKAGES[name];
  const path = packaged ? join(WEB, packaged) : resolve(dirname(from), name);
  if (!packaged && !name.startsWith(".")) return null;
  return [path, path.replace(/\.js$/, ".ts"), `${path}.ts`].find((tried) => sources.has(tried)) ?? null;
}

/** Groups of files that reach each other, by Tarjan's algorithm. */
function circles(graph) {
  const [index, low, stack, found] = [new Map(), new Map(), [], []];
  const visit = (node) => {
    index.set(node, index.size);
    low.set(node, index.get(node));
    stack.push(node);
    for (const next of graph.get(node)) {
      if (!index.has(next)) visit(next);
      if (stack.includes(next)) low.set(node, Math.min(low.get(node), low.get(next)));
    }
    if (low.get(node) !== index.get(node)) return;
    const group = stack.splice(stack.indexOf(node));
    if (group.length > 1 || graph.get(node).includes(node)) found.push(group);
  };
  for (const node of graph.keys()) if (!index.has(node)) visit(node);
  return found;
}

const short = (path) => relative(WEB, path);

test("a circle is found", () => {
  const graph = new Map([["a", ["b"]], ["b", ["c"]], ["c", ["b"]], ["d", ["d"]], ["e", ["a", "d"]]]);
  assert.deepEqual(circles(graph).map((group) => group.sort()), [["b", "c"], ["d"]]);
});

test("imports make no circle", () => {
  const graph = new Map();
  for (const [path, text] of sources) {
    const names = [...text.matchAll(IMPORT)].map(([, plain, dynamic]) => plain ?? dynamic);
    graph.set(path, names.map((name) => target(path, name)).filter((found) => found !== null));
  }
  const edges = [...graph.values()].flat().length;
  assert.ok(sources.size > 90 && edges > 250, `${sources.size} files, ${edges} imports`);
  const found = circles(graph).map((group) => group.map(short).sort().join(" <-> "));
  assert.deepEqual(found, [], "files that import each other");
});

test("no class and no type is exported by two files", () => {
  const owners = new Map();
  for (const [path, text] of sources) {
    if (!/\/src\//.test(path)) continue;
    for (const [, name] of text.matchAll(EXPORTED_TYPE)) owners.set(name, [...(owners.get(name) ?? []), short(path)]);
  }
  const twice = [...owners].filter(([, paths]) => paths.length > 1).map(([name, paths]) => [name, ...paths].join(" "));
  assert.ok(owners.size > 80, `${owners.size} types`);
  assert.deepEqual(twice, []);
});

test("the types of the scene's JSON are those of its schema", () => {
  const done = spawnSync(process.execPath, [join(WEB, "scripts/schema-types.mjs"), "--check"], { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
});
