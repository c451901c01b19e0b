// A page without any interface: the tests reach three.js and the plug-in through `window.lab`.

import * as THREE from "three";
import { GLTFLoader, type GLTF } from "three/addons/loaders/GLTFLoader.js";
import * as eigenfield from "eigenfield-three";

const WIDTH = 320;
const HEIGHT = 240;

const renderer = new THREE.WebGLRenderer({ antialias: false, preserveDrawingBuffer: true });
renderer.setPixelRatio(1);
renderer.setSize(WIDTH, HEIGHT);
document.body.append(renderer.domElement);
const camera = new THREE.PerspectiveCamera();
let scene = new THREE.Scene();

/** Puts a loaded file, or none, into an empty scene. */
function show(gltf: GLTF | null): void {
  scene = new THREE.Scene();
  scene.add(camera);
  if (gltf) scene.add(gltf.scene);
}

function draw(): void {
  renderer.render(scene, camera);
}

/** Sets the camera to a view of the field and draws it. */
function drawView(field: eigenfield.EigenField, view: eigenfield.CaptureCamera): eigenfield.Frame {
  const frame = eigenfield.placeCamera(field, camera, view, WIDTH / HEIGHT);
  draw();
  return frame;
}

/** Loads by the plain way: GLTFLoader, with or without the plug-in. */
function plainLoad(url: string, plugin: boolean, options: eigenfield.EigenfieldOptions = {}): Promise<GLTF> {
  const loader = new GLTFLoader();
  if (plugin) loader.register((parser) => new eigenfield.EigenfieldPlugin(parser, options));
  return loader.loadAsync(url);
}

/** Draws the eyes at -0.3 and 0.3 of the view plane, side by side. */
function drawEyes(field: eigenfield.EigenField): void {
  const eye = (x: number, left: number): THREE.PerspectiveCamera => {
    const own = new THREE.PerspectiveCamera();
    eigenfield.placeCamera(field, own, eigenfield.novelCamera(field, x, 0.1), WIDTH / 2 / HEIGHT);
    return Object.assign(own, { viewport: new THREE.Vector4(left, 0, WIDTH / 2, HEIGHT) });
  };
  const both = new THREE.ArrayCamera([eye(-0.3, 0), eye(0.3, WIDTH / 2)]);
  both.projectionMatrix.copy(both.cameras[0]!.projectionMatrix);
  both.matrixAutoUpdate = false;
  renderer.render(scene, both);
}

/** How often WebGL draws in the frame after each change. */
function countDraws(changes: (() => void)[]): number[] {
  const gl = renderer.getContext();
  let count = 0;
  for (const name of ["drawElements", "drawArrays"] as const) {
    const draw = gl[name].bind(gl) as (...given: unknown[]) => void;
    gl[name] = (...given: unknown[]) => (count++, draw(...given));
  }
  return changes.map((change) => {
    change();
    count = 0;
    draw();
    return count;
  });
}

/** Loses the graphics context, and waits until it is back with all textures. Returns how many were there meanwhile. */
async function loseContext(field: eigenfield.EigenField): Promise<number> {
  const extension = renderer.getContext().getExtension("WEBGL_lose_context")!;
  const lost = new Promise((resolve) => renderer.domElement.addEventListener("webglcontextlost", resolve, { once: true }));
  extension.loseContext();
  await lost;
  const { loaded } = field;
  const complete = new Promise<void>((resolve) => field.addEventListener("complete", () => resolve()));
  await new Promise((resolve) => setTimeout(resolve, 50));
  extension.restoreContext();
  await complete;
  return loaded;
}

/** Where points of an atlas are on the canvas, from below: in the first triangle that has each. */
function pixelsOf({ mesh }: eigenfield.EigenField, uvs: [number, number][]): [number, number][] {
  const { attributes, index } = mesh.geometry;
  const { position, uv } = attributes as Record<"position" | "uv", THREE.BufferAttribute>;
  const flat = (i: number): THREE.Vector3 => new THREE.Vector3(uv.getX(i), uv.getY(i), 0);
  const [share, place] = [new THREE.Vector3(), new THREE.Vector3()];
  return uvs.map(([u, v]) => {
    for (let at = 0; at < index!.count; at += 3) {
      const corners = [0, 1, 2].map((i) => index!.getX(at + i)) as [number, number, number];
      const triangle = new THREE.Triangle(...(corners.map(flat) as [THREE.Vector3, THREE.Vector3, THREE.Vector3]));
      if (!triangle.getBarycoord(new THREE.Vector3(u, v, 0), share) || Math.min(...share.toArray()) < 0) continue;
      place.set(0, 0, 0);
      corners.forEach((corner, i) => {
        place.addScaledVector(new THREE.Vector3().fromBufferAttribute(position, corner), share.getComponent(i));
      });
      mesh.localToWorld(place).project(camera);
      return [Math.floor(((place.x + 1) / 2) * WIDTH), Math.floor(((place.y + 1) / 2) * HEIGHT)];
    }
    throw new Error(`no triangle at ${u}, ${v}`);
  });
}

/** Green at points of the canvas, from below. */
function greens(points: [number, number][]): number[] {
  const gl = renderer.getContext();
  const all = new Uint8Array(4 * WIDTH * HEIGHT);
  gl.readPixels(0, 0, WIDTH, HEIGHT, gl.RGBA, gl.UNSIGNED_BYTE, all);
  return points.map(([x, y]) => all[4 * (y * WIDTH + x) + 1]!);
}

const lab = {
  pixelsOf, greens, THREE, ...eigenfield, renderer, camera, show, draw, drawView, plainLoad, drawEyes, countDraws, loseContext,
};
declare global {
  interface Window {
    lab: typeof lab;
  }
}
window.lab = lab;
