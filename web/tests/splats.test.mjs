// A scene as Gaussians, opened and drawn by three.js' own loader of KHR_gaussian_splatting.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { WEB, canvasPixels, decodePng, launch, openPage, scenePath, serve } from "./harness.mjs";

const PAGE = `<!doctype html>
<link rel="icon" href="data:,"><style>body { margin: 0; background: #000 }</style>
<script type="importmap">{"imports": {
  "three": "/build/three.webgpu.js", "three/webgpu": "/build/three.webgpu.js", "three/tsl": "/build/three.tsl.js",
  "three/addons/": "/examples/jsm/"}}</script>
<script type="module">
  import * as THREE from "three/webgpu";
  import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
  import { GLTFGaussianSplatLoaderExtension } from "three/addons/loaders/GLTFGaussianSplatLoaderExtension.js";
  const { K, R, t, width, height } = await (await fetch("/splats.json")).json();
  const renderer = new THREE.WebGPURenderer({ forceWebGL: true });
  await renderer.init();
  renderer.setSize(width, height);
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // colours are those of the display already
  document.body.append(renderer.domElement);
  const loader = new GLTFLoader().register((parser) => new GLTFGaussianSplatLoaderExtension(parser));
  const { scene } = await loader.loadAsync("/splats.glb");
  const camera = new THREE.PerspectiveCamera();
  camera.matrixAutoUpdate = false;
  const rows = R.map((row, i) => [...row, t[i]].map((value) => (i ? -value : value))); // y up, z towards the eye
  camera.matrix.set(...rows.flat(), 0, 0, 0, 1).invert();
  camera.updateMatrixWorld(true);
  const [near, far] = [0.1, 100];
  camera.projectionMatrix.set(
    (2 * K[0][0]) / width, 0, 1 - (2 * K[0][2]) / width, 0,
    0, (2 * K[1][1]) / height, (2 * K[1][2]) / height - 1, 0,
    0, 0, -(far + near) / (far - near), (-2 * far * near) / (far - near),
    0, 0, -1, 0,
  );
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  const found = [];
  scene.traverse((object) => object.isGaussianSplat && found.push(object));
  for (let turn = 0; turn < 3; turn++) renderer.render(scene, camera);
  window.splats = found.map((object) => object.splatGeometry.getAttribute("position").count);
</script>`;

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

test("three.js opens the Gaussians of a scene and draws them as the extension says", async () => {
  const view = JSON.parse(readFileSync(scenePath("splats.json"), "utf8"));
  const folders = [join(WEB, "node_modules/three"), scenePath("")];
  const server = await serve({ routes: { "/page.html": PAGE }, folders });
  const { page, close } = await openPage(browser, `${server.url}/page.html`, view);
  await page.waitForFunction(() => window.splats);
  assert.equal((await page.evaluate(() => window.splats)).length, 1);
  const drawn = await canvasPixels(page);
  const wanted = decodePng(readFileSync(scenePath("splats.png")));
  assert.deepEqual([drawn.width, drawn.height], [wanted.width, wanted.height]);
  let error = 0;
  for (let i = 0; i < drawn.data.length; i++) error += (drawn.data[i] - wanted.data[i]) ** 2;
  const decibels = 10 * Math.log10((255 ** 2 * drawn.data.length) / error);
  assert.ok(decibels > 28, `${decibels.toFixed(2)} dB`);
  await close();
  await server.close();
});
