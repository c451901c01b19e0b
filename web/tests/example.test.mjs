// The example page, and the plug-in as a module of its own in a page without a bundler.

import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { build } from "vite";
import { askers } from "./askers.mjs";
import { WEB, buildPage, canvasPixels, difference, launch, openPage, scenePath, serve } from "./harness.mjs";

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** Share of the pixels that are not black, and how many different colours there are. */
function look({ data }) {
  const colours = new Set();
  let lit = 0;
  for (let i = 0; i < data.length; i += 3) {
    if (data[i] + data[i + 1] + data[i + 2]) lit += 1;
    colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
  }
  return { lit: lit / (data.length / 3), colours: colours.size };
}

test("the example draws a scene with its own renderer and controls", async () => {
  const built = await buildPage("example");
  const server = await serve({ folders: [built.folder, scenePath("")] });
  const { page, close } = await openPage(browser, `${server.url}/?scene=scene.glb`, { width: 400, height: 300 });
  await page.waitForFunction(() => document.querySelector("canvas"));
  await page.waitForTimeout(1500);
  const start = await canvasPixels(page);
  assert.ok(look(start).lit > 0.4 && look(start).colours > 1000, JSON.stringify(look(start)));
  await page.mouse.move(200, 150);
  await page.mouse.down();
  await page.mouse.move(240, 130, { steps: 4 });
  await page.mouse.up();
  await page.waitForTimeout(200);
  const turned = await canvasPixels(page);
  assert.ok(look(turned).lit > 0.3);
  assert.ok(difference(start, turned).mean > 5, "dragging turns the view");
  await close();
  await server.close();
  await built.close();
});

test("the example fetches nothing but the scene, whatever that names", async () => {
  const built = await buildPage("example");
  const elsewhere = await serve();
  const files = askers(elsewhere.url);
  const routes = Object.fromEntries(Object.entries(files).map(([name, body]) => [`/${name}.glb`, { body }]));
  const server = await serve({ folders: [built.folder], routes });
  const { page, close } = await openPage(browser, null, { allowed: /names another one/ });
  for (const name of Object.keys(files)) {
    const refused = page.waitForEvent("pageerror");
    await page.goto(`${server.url}/?scene=${name}.glb`);
    assert.match((await refused).message, /names another one .* is not fetched/);
    assert.equal(server.requests.at(-1), `/${name}.glb`);
  }
  assert.deepEqual(elsewhere.requests, []);
  await close();
  for (const each of [server, elsewhere, built]) await each.close();
});

const PAGE = `<!doctype html>
<link rel="icon" href="data:,">
<style>body { margin: 0 } canvas { display: block }</style>
<script type="importmap">
  { "imports": {
    "three": "/node_modules/three/build/three.module.js",
    "three/addons/": "/node_modules/three/examples/jsm/",
    "eigenfield-three": "/eigenfield-three.js"
  } }
</script>
<script type="module">
  import * as THREE from "three";
  import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
  import { EigenfieldPlugin } from "eigenfield-three";
  const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
  renderer.setSize(300, 300);
  document.body.append(renderer.domElement);
  const loader = new GLTFLoader();
  loader.register((parser) => new EigenfieldPlugin(parser));
  const gltf = await loader.loadAsync("scene.glb");
  const scene = new THREE.Scene();
  scene.add(gltf.scene);
  const [camera] = gltf.cameras;
  renderer.render(scene, camera);
  await gltf.userData.eigenfield.complete;
  renderer.render(scene, camera);
  window.count = gltf.userData.eigenfield.loaded;
</script>`;

test("the plug-in is a module that needs three.js and nothing else", async () => {
  const folder = await mkdtemp(join(tmpdir(), "eigenfield-plugin-"));
  await build({ configFile: join(WEB, "vite.plugin.config.ts"), logLevel: "error", build: { outDir: folder } });
  const routes = { "/": { body: PAGE, type: "text/html" } };
  const server = await serve({ routes, folders: [folder, scenePath(""), WEB] });
  const { page, close } = await openPage(browser, `${server.url}/`, { width: 300, height: 300 });
  await page.waitForFunction(() => window.count !== undefined);
  assert.equal(await page.evaluate(() => window.count), 6);
  assert.ok(look(await canvasPixels(page)).colours > 1000);
  const own = server.requests.filter((path) => path.endsWith(".js") && !path.startsWith("/node_modules/three/"));
  assert.deepEqual(own, ["/eigenfield-three.js"]);
  await close();
  await server.close();
  await rm(folder, { recursive: true });
});
