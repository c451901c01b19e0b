// What a frame costs: the scene with its eigen textures, and the same mesh with its mean as a plain texture.

import * as THREE from "three";
import { loadEigenfield, novelCamera, placeCamera, type Filter } from "eigenfield-three";

interface Figures {
  plain: number; // milliseconds of the median frame, as all that follow
  eye: Record<string, number>; // one set of weights a frame, by filter
  ray: Record<string, number>; // weights looked up by each texel
  renderer: string;
}

const FILTERS: Filter[] = ["bilinear", "bicubic"];
const FEWEST = 5;
const MOST = 120;
const PATIENCE = 2000; // milliseconds: of frames that take longer one is enough

async function measure(url: string, width: number, height: number, seconds: number): Promise<Figures> {
  const renderer = new THREE.WebGLRenderer({ antialias: false });
  renderer.setPixelRatio(1);
  renderer.setSize(width, height);
  document.body.append(renderer.domElement);
  const gl = renderer.getContext();
  const camera = new THREE.PerspectiveCamera();
  const scene = new THREE.Scene();
  const { gltf, field } = await loadEigenfield(url, { renderer, memory: 4e9 });
  if (!field) throw new Error("no eigen textures");
  scene.add(gltf.scene);
  await field.complete;
  scene.updateMatrixWorld(true);
  const pixel = new Uint8Array(4);

  /** The median frame along a circle on the view plane, or `ahead` of it; reading a pixel waits for the GPU. */
  const frames = (ahead: number): number => {
    const taken: number[] = [];
    let spent = 0;
    let fewest = FEWEST;
    for (let i = -1; i < fewest || (spent < 1000 * seconds && i < MOST); i++) {
      const began = performance.now();
      const turn = (2 * Math.PI * i) / 60;
      const view = novelCamera(field, 0.7 * Math.cos(turn), 0.7 * Math.sin(turn));
      view.t = [view.t[0] ?? 0, view.t[1] ?? 0, (view.t[2] ?? 0) - ahead];
      placeCamera(field, camera, view, width / height);
      renderer.render(scene, camera);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      const took = performance.now() - began;
      if (i >= 0) taken.push(took);
      else if (took > PATIENCE) fewest = 1; // the first, which compiles the shader, never counts
      if (i >= 0 || fewest === 1) spent += took;
    }
    return taken.sort((a, b) => a - b)[taken.length >> 1] ?? NaN;
  };

  const figures: Figures = { plain: 0, eye: {}, ray: {}, renderer: describe(gl) };
  for (const filter of FILTERS) {
    field.filter = filter;
    figures.eye[filter] = frames(0);
    figures.ray[filter] = frames(0.05);
  }
  const image = await (await fetch("mean.png")).blob();
  const mean = new THREE.Texture(await createImageBitmap(image));
  mean.flipY = false;
  mean.generateMipmaps = true;
  mean.minFilter = THREE.LinearMipmapLinearFilter;
  mean.needsUpdate = true;
  field.mesh.material = new THREE.MeshBasicMaterial({ map: mean, side: THREE.DoubleSide });
  field.mesh.onBeforeRender = () => undefined; // nothing is to be composed
  field.mesh.clear(); // nor sheets to be drawn
  figures.plain = frames(0);
  return figures;
}

function describe(gl: WebGLRenderingContext | WebGL2RenderingContext): string {
  const extension = gl.getExtension("WEBGL_debug_renderer_info");
  return String(gl.getParameter(extension ? extension.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

declare global {
  interface Window {
    measure: typeof measure;
  }
}
window.measure = measure;
