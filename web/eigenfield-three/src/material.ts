// The material: surface.glsl between a vertex shader of four lines and the viewer's views.

import { DoubleSide, FrontSide, GLSL3, Matrix4, RawShaderMaterial, Vector3 } from "three";
import type { IUniform, Texture } from "three";
import cubic from "../../../src/eigenfield/rendering/shaders/cubic.glsl?raw";
import surface from "../../../src/eigenfield/rendering/shaders/surface.glsl?raw";

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

const FRAGMENT = `
precision highp float;
precision highp int;
precision highp sampler2D;
${cubic}${surface}
uniform int shown;             // 0 the picture, 1 the mean, 2 one eigen texture, 3 the error
uniform float shownGain;       // of the eigen texture around mid grey
uniform sampler2D photograph;  // row 0 on top
uniform mat4 toPhotograph;     // homogeneous texture coordinates of a place, in x, y and w

in vec2 surfaceUv;
in vec3 surfacePlace;
out vec4 fragment;

vec3 heat(float t) {
  return clamp(vec3(3.0 * t, 3.0 * t - 1.0, 3.0 * t - 2.0), 0.0, 1.0);
}

vec3 errorColour(vec3 drawn) {
  vec4 at = toPhotograph * vec4(surfacePlace, 1.0);
  vec2 uv = at.xy / at.w;
  if (at.w <= 0.0 || any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)))) return vec3(0.2);
  vec3 off = abs(drawn - textureLod(photograph, uv, 0.0).rgb);
  return heat(5.0 * (off.r + off.g + off.b) / 3.0);
}

void main() {
  vec3 colour;
  if (shown == 2) colour = clamp(0.5 + shownGain * surfaceValue(surfaceUv).rgb, 0.0, 1.0);
  else colour = surfaceColour(surfaceUv);
  if (shown == 3) colour = errorColour(colour);
  fragment = vec4(colour, 1.0);
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

/** The material, before anything is composed. */
export function makeMaterial(doubleSided: boolean): SurfaceMaterial {
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
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms,
    defines: { BICUBIC: FILTERS.bicubic },
    side: doubleSided ? DoubleSide : FrontSide,
  });
  material.name = "eigen textures";
  return material as SurfaceMaterial;
}
