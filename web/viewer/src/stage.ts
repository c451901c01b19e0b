// The canvas and what three.js draws on it: the scene's surface, and over it a photograph where one is shown.

import {
  Color, DirectionalLight, GLSL3, Group, HemisphereLight, LinearSRGBColorSpace, Mesh, type Object3D,
  PerspectiveCamera, PlaneGeometry, Scene, ShaderMaterial, SRGBColorSpace, type Texture, Vector4, WebGLRenderer,
} from "three";
import type { Frame } from "eigenfield-three";
import { createBlur } from "./blur";

const FINEST = 2; // device pixels a CSS pixel, at most

export interface Stage {
  readonly canvas: HTMLCanvasElement;
  readonly renderer: WebGLRenderer;
  readonly camera: PerspectiveCamera;
  readonly root: Group; // holds the scene; a headset moves it
  /** coded: the object writes the photographs' own numbers; otherwise it is lit and managed as glTF says. */
  put(object: Object3D, coded: boolean): void;
  clear(): void;
  setBackground(colour: string): void;
  /** only: nothing is drawn outside it. blurred: how much, 0 to 1. */
  draw(only: Frame | null, blurred: number): void;
  /** A picture that fills `frame`; left of `divider`, in parts of the frame's width, the scene. */
  compare(frame: Frame, picture: Texture, divider: number | null): void;
  /** A second scene, which `split` alone draws; null: none. */
  setBeside(object: Object3D | null): void;
  /** Left of `divider`, in parts of the frame's width, the scene; right of it the second one, as `place` puts a camera. */
  split(frame: Frame, divider: number, place: (camera: PerspectiveCamera) => Frame): void;
  resize(width: number, height: number): void;
  /** Device pixels a CSS pixel of the full picture. */
  ratio(): number;
  /** Draws with so much of the full resolution; the browser makes it as large as ever. */
  setScale(scale: number): void;
  aspect(): number;
  /** What was just drawn: call it in the same task as `draw`. Rows from the top, R, G, B, A. */
  pixels(): { width: number; height: number; data: Uint8Array };
}

/** Throws where there is no WebGL 2. */
export function createStage(canvas: HTMLCanvasElement): Stage {
  const renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
  renderer.autoClear = false;
  renderer.outputColorSpace = LinearSRGBColorSpace;
  const scene = new Scene();
  const root = new Group();
  const lights = new Group();
  lights.add(new HemisphereLight(0xffffff, 0x50535a, 2.2));
  const lamp = new DirectionalLight(0xffffff, 1.6);
  lamp.position.set(0.5, 1, 0.8);
  lights.add(lamp);
  const other = new Group();
  other.visible = false;
  scene.add(root, other, lights);
  const camera = new PerspectiveCamera();
  const aside = new PerspectiveCamera();
  const photograph = createPhotographQuad();
  const blur = createBlur();
  const background = { colour: "#000000", coded: true };
  const size = { width: 1, height: 1 };
  const ratio = (): number => Math.min(devicePixelRatio, FINEST);
  let scale = 1;

  /** Lets `draw` change nothing outside a part of the canvas. */
  const within = (only: Frame | null, draw: () => void): void => {
    if (only) {
      const { left, top, width, height } = only;
      renderer.setScissor(
        left * size.width, (1 - top - height) * size.height, width * size.width, height * size.height,
      );
    }
    renderer.setScissorTest(only !== null);
    draw();
    renderer.setScissorTest(false);
  };
  const clearColour = (): void => {
    // Coded numbers go out as they are: the colour must not be taken for sRGB that has to be made linear first.
    const space = background.coded ? LinearSRGBColorSpace : SRGBColorSpace;
    renderer.setClearColor(new Color().setStyle(background.colour, space), 1);
  };

  return {
    canvas,
    renderer,
    camera,
    root,
    put: (object, coded) => {
      root.add(object);
      lights.visible = !coded;
      background.coded = coded;
      renderer.outputColorSpace = coded ? LinearSRGBColorSpace : SRGBColorSpace;
      clearColour();
    },
    clear: () => {
      for (const object of [...root.children]) discard(object);
      root.clear();
    },
    setBackground: (colour) => {
      background.colour = colour;
      clearColour();
    },
    draw: (only, blurred) => {
      renderer.clear();
      if (blurred > 0) blur.draw(renderer, scene, camera, blurred);
      else within(only, () => renderer.render(scene, camera));
    },
    compare: (frame, picture, divider) => {
      renderer.clear();
      const part = divider ?? 0;
      if (part > 0) within(frame, () => renderer.render(scene, camera));
      const right = { ...frame, left: frame.left + part * frame.width, width: (1 - part) * frame.width };
      within(right, () => photograph.draw(renderer, picture, frame));
    },
    setBeside: (object) => {
      for (const one of [...other.children]) discard(one);
      other.clear();
      if (object) other.add(object);
    },
    split: (frame, divider, place) => {
      renderer.clear();
      const at = frame.left + divider * frame.width;
      const left = between(frame, 0, at);
      if (left.width > 0) within(left, () => renderer.render(scene, camera));
      const right = between(place(aside), at, 1);
      [root.visible, other.visible] = [false, true];
      if (right.width > 0) within(right, () => renderer.render(scene, aside));
      [root.visible, other.visible] = [true, false];
    },
    resize: (width, height) => {
      Object.assign(size, { width: Math.max(width, 1), height: Math.max(height, 1) });
      renderer.setPixelRatio(ratio() * scale);
      renderer.setSize(size.width, size.height, false);
    },
    ratio,
    setScale: (next) => {
      if (next === scale) return;
      scale = next;
      renderer.setPixelRatio(ratio() * scale); // it makes the buffer anew, empty: draw in the same task
    },
    aspect: () => size.width / size.height,
    pixels: () => {
      const gl = renderer.getContext();
      const { drawingBufferWidth: width, drawingBufferHeight: height } = gl;
      const upsideDown = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, upsideDown);
      const data = new Uint8Array(upsideDown.length);
      for (let y = 0; y < height; y++)
        data.set(upsideDown.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)), 4 * width * y);
      return { width, height, data };
    },
  };
}

/** The part of a frame from one column of the canvas to another. */
function between(frame: Frame, from: number, to: number): Frame {
  const left = Math.max(frame.left, from);
  return { ...frame, left, width: Math.max(Math.min(frame.left + frame.width, to) - left, 0) };
}

/** A picture over a part of the canvas, its numbers as they are. */
function createPhotographQuad(): { draw(renderer: WebGLRenderer, picture: Texture, frame: Frame): void } {
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    depthTest: false,
    depthWrite: false,
    uniforms: { picture: { value: null }, corners: { value: new Vector4() } },
    vertexShader: `
      uniform vec4 corners;
      out vec2 at;
      void main() {
        at = vec2(uv.x, 1.0 - uv.y);
        gl_Position = vec4(mix(corners.xy, corners.zw, uv), 0.0, 1.0);
      }`,
    fragmentShader: `
      uniform sampler2D picture;
      in vec2 at;
      out vec4 colour;
      void main() { colour = vec4(texture(picture, at).rgb, 1.0); }`,
  });
  const quad = new Mesh(new PlaneGeometry(2, 2), material);
  quad.frustumCulled = false;
  const scene = new Scene().add(quad);
  const camera = new PerspectiveCamera();
  return {
    draw: (renderer, picture, { left, top, width, height }) => {
      material.uniforms["picture"] = { value: picture };
      const [right, bottom] = [left + width, top + height];
      material.uniforms["corners"] = {
        value: new Vector4(2 * left - 1, 1 - 2 * bottom, 2 * right - 1, 1 - 2 * top),
      };
      renderer.render(scene, camera);
    },
  };
}

function discard(object: Object3D): void {
  object.traverse((part) => {
    if (!(part instanceof Mesh)) return;
    part.geometry.dispose();
    for (const material of [part.material].flat()) {
      for (const value of Object.values(material))
        if (typeof value === "object" && value !== null && "isTexture" in value) (value as Texture).dispose();
      material.dispose();
    }
  });
}
