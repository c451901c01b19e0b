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

const lab = { THREE, ...eigenfield, renderer, camera, show, draw, drawView, plainLoad };
declare global {
  interface Window {
    lab: typeof lab;
  }
}
window.lab = lab;
