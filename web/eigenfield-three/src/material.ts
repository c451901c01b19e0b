// The material: surface.glsl between a vertex shader of four lines and the viewer's views.

import {
  CustomBlending,
  DoubleSide,
  EqualStencilFunc,
  FrontSide,
  GLSL3,
  IncrementStencilOp,
  Matrix4,
  OneFactor,
  OneMinusSrcAlphaFactor,
  RawShaderMaterial,
  Vector3,
  ZeroStencilOp,
  type IUniform,
  type Texture,
} from "three";
import cubic from "../../../src/eigenfield/rendering/shaders/cubic.glsl?raw";
import surface from "../../../src/eigenfield/rendering/shaders/surface.glsl?raw";
import type { CaptureCamera } from "./info.js";

/** How the finest level is read: BICUBIC of the shader. */
export const FILTERS = { bilinear: 0, bicubic: 1 } as const;
export type Filter = keyof typeof FILTERS;

export const VIEWS = { picture: 0, mean: 1, eigen: 2, error: 3 } as const;

const VERTEX = `
precision highp float;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
in vec3 position;
in vec2 uv;
out vec2 surfaceUv;
out vec3 surfacePlace;
void main() {
  surfaceUv = uv;
  surfacePlace = position;
  gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
}
`;

/** As VERTEX, to the same bits in every program: sheets are drawn twice. */
const SHEET_VERTEX = VERTEX.replace("void main", "invariant gl_Position;\nvoid main");

export const PRECISIONS = `
precision highp float;
precision highp int;
precision highp sampler2D;
uniform int shown;             // 0 the picture, 1 the mean, 2 one eigen texture, 3 the error
`;

export const ERROR = `
uniform sampler2D photograph;  // row 0 on top
uniform mat4 toPhotograph;     // homogeneous texture coordinates of a place, in x, y and w

vec3 heat(float t) {
  return clamp(vec3(3.0 * t, 3.0 * t - 1.0, 3.0 * t - 2.0), 0.0, 1.0);
}

vec3 errorColour(vec3 drawn, vec3 place) {
  vec4 at = toPhotograph * vec4(place, 1.0);
  vec2 uv = at.xy / at.w;
  if (at.w <= 0.0 || any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return vec3(0.2);
  vec3 off = abs(drawn - textureLod(photograph, uv, 0.0).rgb);
  return heat(5.0 * (off.r + off.g + off.b) / 3.0);
}
`;

const SURFACE = `${PRECISIONS}
${cubic}${surface}
uniform float shownGain;       // of the eigen texture around mid grey
in vec2 surfaceUv;
vec3 eigenColour(vec3 value) { return clamp(0.5 + shownGain * value, 0.0, 1.0); }
`;

const FRAGMENT = `${SURFACE}${ERROR}
in vec3 surfacePlace;
out vec4 fragment;
void main() {
  vec3 colour;
  if (shown == 2) colour = eigenColour(surfaceValue(surfaceUv).rgb);
  else colour = surfaceColour(surfaceUv);
  if (shown == 3) colour = errorColour(colour, surfacePlace);
  fragment = vec4(colour, 1.0);
}
`;

// `solid` has the depth of the nearest sheet that is at least half opaque, in three bytes: what is not takes part in it
// with alpha 0, and so leaves it as it is.
const SHEET_FRAGMENT = `${SURFACE}
layout(location = 0) out vec4 fragment;
layout(location = 1) out vec4 solid;
vec3 threeBytes(float depth) {
  uint code = uint(clamp(depth, 0.0, 1.0) * 16777215.0);
  return vec3(uvec3(code >> 16, code >> 8, code) & 255u) / 255.0;
}
void main() {
  vec4 colour = sheetColour(surfaceUv);
  if (shown == 2) colour.rgb = eigenColour(surfaceValue(surfaceUv).rgb) * colour.a;
  fragment = colour;
  float depth = (gl_FragCoord.z - gl_DepthRange.near) / gl_DepthRange.diff;
  solid = colour.a < 0.5 ? vec4(0.0) : vec4(threeBytes(depth), 1.0);
}
`;

export interface SurfaceUniforms {
  [name: string]: IUniform;
  composed: IUniform<Texture | null>;
  finest: IUniform<number>;
  exposureScale: IUniform<Vector3>;
  exposureBias: IUniform<Vector3>;
  shown: IUniform<number>;
  shownGain: IUniform<number>;
  photograph: IUniform<Texture | null>;
  toPhotograph: IUniform<Matrix4>;
}

export interface SurfaceMaterial extends RawShaderMaterial {
  uniforms: SurfaceUniforms;
  defines: { BICUBIC: 0 | 1 };
}

const DEPTH_FRAGMENT = `
precision highp float;
layout(location = 0) out vec4 fragment;
layout(location = 1) out vec4 solid;
void main() { fragment = solid = vec4(0.0); }
`;

/** Colours times coverage, over what is there. */
export const OVER = { blending: CustomBlending, blendSrc: OneFactor, blendDst: OneMinusSrcAlphaFactor } as const;

// A sheet's depth comes before it. Where it is folded two triangles may have the same: its depth leaves a stencil of 0,
// which the first of them counts up.
const ONCE = {
  depthWrite: false,
  stencilWrite: true,
  stencilFunc: EqualStencilFunc,
  stencilZPass: IncrementStencilOp,
} as const;

/** The material of a surface, or of the sheets of one, before anything is composed. */
export function makeMaterial(doubleSided: boolean, sheets: boolean): SurfaceMaterial {
  const uniforms: SurfaceUniforms = {
    composed: { value: null },
    finest: { value: 1 },
    exposureScale: { value: new Vector3(1, 1, 1) },
    exposureBias: { value: new Vector3() },
    shown: { value: VIEWS.picture },
    shownGain: { value: 1 },
    photograph: { value: null },
    toPhotograph: { value: new Matrix4() },
  };
  const material = new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: sheets ? SHEET_VERTEX : VERTEX,
    fragmentShader: sheets ? SHEET_FRAGMENT : FRAGMENT,
    uniforms,
    defines: { BICUBIC: FILTERS.bicubic },
    side: doubleSided ? DoubleSide : FrontSide,
    ...(sheets ? { ...OVER, ...ONCE } : {}),
  });
  material.name = "eigen textures";
  return material as SurfaceMaterial;
}

/** The material that gives a sheet its depth before `sheets`, its own, shows it. */
export function makeDepthMaterial(sheets: SurfaceMaterial): RawShaderMaterial {
  const { side } = sheets;
  return new RawShaderMaterial({
    name: "depth of sheets",
    glslVersion: GLSL3,
    vertexShader: SHEET_VERTEX,
    fragmentShader: DEPTH_FRAGMENT,
    colorWrite: false,
    side,
    stencilWrite: true,
    stencilZPass: ZeroStencilOp,
  });
}

/** Shows the error against a photograph that a camera took. */
export function compareWith(uniforms: SurfaceUniforms, camera: CaptureCamera, photograph: Texture): void {
  const { K, R, t, width, height } = camera;
  const pose = new Matrix4().set(...R[0], t[0], ...R[1], t[1], ...R[2], t[2], 0, 0, 0, 1);
  const lens = new Matrix4().set(...K[0], 0, ...K[1], 0, 0, 0, 0, 0, ...K[2], 0);
  const flipped = photograph.flipY && !isBitmap(photograph.image);
  const toTexture = new Matrix4().makeScale(1 / width, (flipped ? -1 : 1) / height, 1);
  if (flipped) toTexture.elements[13] = 1; // v = 1 - v: the entry that w is multiplied with
  uniforms.toPhotograph.value.multiplyMatrices(toTexture, lens.multiply(pose));
  uniforms.photograph.value = photograph;
}

function isBitmap(image: unknown): boolean {
  return typeof ImageBitmap !== "undefined" && image instanceof ImageBitmap;
}
