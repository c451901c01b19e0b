// The passes of compose.glsl as three.js draws them: quads that add to a target, and the mesh laid out in the atlas.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  CustomBlending,
  DoubleSide,
  GLSL3,
  HalfFloatType,
  InstancedBufferGeometry,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  NearestFilter,
  NoBlending,
  OneFactor,
  RawShaderMaterial,
  Sphere,
  Vector2,
  Vector4,
  WebGLRenderTarget,
  type Camera,
  type IUniform,
  type WebGLRenderer,
} from "three";
import compose from "../../../src/eigenfield/rendering/shaders/compose.glsl?raw";
import cubic from "../../../src/eigenfield/rendering/shaders/cubic.glsl?raw";
import { cross, dot, planeCoordinates, type Vector, type ViewPlane } from "./info.js";

export const LAYERS = 64; // that the shader sums in one draw
const REACH = 2; // as in compose.glsl

const HEAD = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArray;
${cubic}${compose}`;
const QUAD = `
precision highp float;
uniform vec4 rectangle; // of the target: left, top, right, bottom in 0..1
in vec3 position;
out vec2 own;
void main() {
  own = position.xy;
  gl_Position = vec4(2.0 * mix(rectangle.xy, rectangle.zw, position.xy) - 1.0, 0.0, 1.0);
}
`;
const SPREAD = `
precision highp float;
uniform vec2 texel;     // of the target, in clip space
uniform vec2 shifts[SHIFTS];
in vec2 position;       // texture coordinates
in vec3 onPlane;
out vec3 point;
flat out vec2 shift;
void main() {
  point = onPlane;
  shift = shifts[gl_InstanceID];
  gl_Position = vec4(2.0 * position - 1.0 + texel * shift, 0.0, 1.0);
}
`;
const PLACE = `${HEAD}
in vec3 point;
flat in vec2 shift;
out vec4 place;
void main() {
  place = placeOf(point);
  place.w += codeOf(shift);
}
`;
export const SUM = "sumTextures";
export const FINER = "finerValue";
export const FINER_OPACITY = "finerOpacity";

/** A quad over a rectangle of what is drawn into; it adds `value`, a function of compose.glsl, of its coordinates. */
export function makeQuad(
  value: typeof SUM | typeof FINER | typeof FINER_OPACITY,
  rectangle: [number, number, number, number],
  uniforms: Record<string, IUniform>,
): Mesh<BufferGeometry, RawShaderMaterial> {
  const material = new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: QUAD,
    fragmentShader: `${HEAD}in vec2 own;\nout vec4 colour;\nvoid main() { colour = ${value}(own); }\n`,
    uniforms: { rectangle: { value: new Vector4(...rectangle) }, ...uniforms },
    side: DoubleSide,
    blending: CustomBlending,
    blendSrc: OneFactor,
    blendDst: OneFactor,
    depthTest: false,
    depthWrite: false,
  });
  const geometry = new BufferGeometry();
  const corners = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0];
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(corners), 3));
  geometry.setIndex([0, 1, 2, 2, 1, 3]);
  geometry.boundingSphere = new Sphere(); // asked for, and not needed
  const quad = new Mesh(geometry, material);
  quad.frustumCulled = false;
  return quad;
}

/** Half-floats to draw into: with mips for what is drawn from, texel by texel else. */
export function makeTarget([width, height]: [number, number], mips: boolean): WebGLRenderTarget {
  return new WebGLRenderTarget(width, height, {
    type: HalfFloatType,
    depthBuffer: false,
    generateMipmaps: mips,
    minFilter: mips ? LinearMipmapLinearFilter : NearestFilter,
    magFilter: mips ? LinearFilter : NearestFilter,
  });
}

/** X, Y and height of a point of the capture's world above the view plane, the height in half widths of the array. */
export function onPlane(plane: ViewPlane, point: Vector): Vector {
  const normal = cross(plane.right, plane.up);
  const from: Vector = [point[0] - plane.origin[0], point[1] - plane.origin[1], point[2] - plane.origin[2]];
  return [...planeCoordinates(plane, point), dot(from, normal) / (Math.max(...plane.extent) || 1)];
}

const STEPS = Array.from({ length: 2 * REACH + 1 }, (_, i) => i - REACH);
const SHIFTS = STEPS.flatMap((y) => STEPS.map((x) => new Vector2(x, y))).sort((a, b) => b.lengthSq() - a.lengthSq());

/** Draws where each texel of a target lies, as the mesh of `makePlacing`. */
export function makePlacingMaterial(target: WebGLRenderTarget): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: SPREAD.replace("SHIFTS", String(SHIFTS.length)),
    fragmentShader: PLACE,
    uniforms: { texel: { value: new Vector2(2 / target.width, 2 / target.height) }, shifts: { value: SHIFTS } },
    side: DoubleSide,
    blending: NoBlending,
    depthTest: false,
    depthWrite: false,
  });
}

/** A shape laid out in the atlas. It is drawn beside itself, too, for the texels beside its charts; the nearest comes
 * last, and stays. */
export function makePlacing(shape: BufferGeometry, plane: ViewPlane, material: RawShaderMaterial): Mesh {
  const { index } = shape;
  const position = shape.getAttribute("position");
  const uv = shape.getAttribute("uv");
  const places = new Float32Array(3 * position.count);
  const coordinates = new Float32Array(2 * position.count);
  for (let i = 0; i < position.count; i++) {
    places.set(onPlane(plane, [position.getX(i), position.getY(i), position.getZ(i)]), 3 * i);
    coordinates.set([uv.getX(i), uv.getY(i)], 2 * i);
  }
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(coordinates, 2));
  geometry.setAttribute("onPlane", new BufferAttribute(places, 3));
  geometry.setIndex(index && new BufferAttribute(index.array, 1));
  geometry.instanceCount = SHIFTS.length;
  geometry.boundingSphere = new Sphere();
  const spread = new Mesh(geometry, material);
  spread.frustumCulled = false;
  return spread;
}

const black = new Color(0);
const clearColour = new Color();

/** Calls `work`, which draws into targets, within a draw of `camera`, and puts back what three.js has set. */
export function within(renderer: WebGLRenderer, camera: Camera, work: () => void): void {
  const target = renderer.getRenderTarget();
  const [face, level] = [renderer.getActiveCubeFace(), renderer.getActiveMipmapLevel()];
  const { autoClear, info } = renderer;
  const [presenting, shadows, alpha] = [renderer.xr.enabled, renderer.shadowMap.autoUpdate, renderer.getClearAlpha()];
  const [frame, autoReset] = [info.render.frame, info.autoReset];
  renderer.getClearColor(clearColour);
  renderer.setClearColor(black, 0);
  renderer.autoClear = renderer.xr.enabled = renderer.shadowMap.autoUpdate = info.autoReset = false;
  work();
  info.render.frame = frame; // it is one frame to whoever counts them
  Object.assign(info, { autoReset });
  Object.assign(renderer, { autoClear });
  renderer.xr.enabled = presenting;
  renderer.shadowMap.autoUpdate = shadows;
  renderer.setClearColor(clearColour, alpha);
  renderer.setRenderTarget(target, face, level);
  const { viewport } = camera as { viewport?: Parameters<WebGLRenderer["state"]["viewport"]>[0] };
  if (viewport) renderer.state.viewport(viewport); // one eye of two
}
