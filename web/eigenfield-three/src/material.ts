// The material: surface.glsl between a vertex shader of four lines and the viewer's views.

import { DoubleSide, FrontSide, GLSL3, Matrix3, Matrix4, RawShaderMaterial, Vector3 } from "three";
import type { IUniform, Texture } from "three";
import surface from "../../../src/eigenfield/rendering/shaders/surface.glsl?raw";
import type { Picture, SceneDocument } from "./document.js";
import { layersOf } from "./memory.js";

/** How the finest level is read: BICUBIC of the shader. */
export const FILTERS = { bilinear: 0, mixed: 1, bicubic: 2 } as const;
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
precision highp sampler2DArray;
${surface}
uniform int shown;             // 0 the picture, 1 the mean, 2 one eigen texture, 3 the error
uniform int shownEigen;
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
  if (shown == 1) colour = clamp(meanColour(surfaceUv) * exposureScale + exposureBias, 0.0, 1.0);
  else if (shown == 2) colour = clamp(0.5 + shownGain * eigenColour(surfaceUv, shownEigen), 0.0, 1.0);
  else colour = surfaceColour(surfaceUv, surfacePlace);
  if (shown == 3) colour = errorColour(colour);
  fragment = vec4(colour, 1.0);
}
`;

export interface SurfaceUniforms {
  [name: string]: IUniform;
  meanTexture: IUniform<Texture>;
  meanScale: IUniform<Vector3>;
  meanBias: IUniform<Vector3>;
  count: IUniform<number>;
  eigenTextures: IUniform<Texture>;
  eigenScale: IUniform<Float32Array>;
  eigenBias: IUniform<Float32Array>;
  rayWeights: IUniform<boolean>;
  viewWeights: IUniform<Float32Array>;
  weightMaps: IUniform<Texture | null>;
  finest: IUniform<number>;
  finestEigen: IUniform<number>;
  eye: IUniform<Vector3>;
  planeOrigin: IUniform<Vector3>;
  planeNormal: IUniform<Vector3>;
  planeX: IUniform<Vector3>;
  planeY: IUniform<Vector3>;
  toRGB: IUniform<Matrix3>;
  exposureScale: IUniform<Vector3>;
  exposureBias: IUniform<Vector3>;
  shown: IUniform<number>;
  shownEigen: IUniform<number>;
  shownGain: IUniform<number>;
  photograph: IUniform<Texture | null>;
  toPhotograph: IUniform<Matrix4>;
}

export interface SurfaceMaterial extends RawShaderMaterial {
  uniforms: SurfaceUniforms;
  defines: { COUNT: number; CHANNELS: 1 | 3; BICUBIC: 0 | 1 | 2 };
}

/** The material of a scene before any eigen texture is there. */
export function makeMaterial(
  scene: SceneDocument,
  mean: Texture,
  eigen: Texture,
  doubleSided: boolean,
): SurfaceMaterial {
  const along = (axis: [number, number, number], extent: number): Vector3 =>
    new Vector3(...axis).multiplyScalar(extent > 0 ? 1 / extent : 0);
  const uniforms: SurfaceUniforms = {
    meanTexture: { value: mean },
    meanScale: { value: scaleOf(scene.mean) },
    meanBias: { value: biasOf(scene.mean) },
    count: { value: 0 },
    eigenTextures: { value: eigen },
    eigenScale: { value: new Float32Array(4 * scene.channels) },
    eigenBias: { value: new Float32Array(4 * scene.channels) },
    rayWeights: { value: false },
    viewWeights: { value: new Float32Array(4) },
    weightMaps: { value: null },
    finest: { value: 1 },
    finestEigen: { value: 1 },
    eye: { value: new Vector3() },
    planeOrigin: { value: new Vector3(...scene.origin) },
    planeNormal: { value: new Vector3().crossVectors(new Vector3(...scene.right), new Vector3(...scene.up)) },
    planeX: { value: along(scene.right, scene.extent[0]) },
    planeY: { value: along(scene.up, scene.extent[1]) },
    toRGB: { value: new Matrix3() }, // grey pictures are decoded to three equal channels
    exposureScale: { value: new Vector3(1, 1, 1) },
    exposureBias: { value: new Vector3() },
    shown: { value: VIEWS.picture },
    shownEigen: { value: 0 },
    shownGain: { value: 1 },
    photograph: { value: null },
    toPhotograph: { value: new Matrix4() },
  };
  const material = new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    uniforms,
    defines: { COUNT: 1, CHANNELS: scene.channels, BICUBIC: FILTERS.mixed },
    side: doubleSided ? DoubleSide : FrontSide,
  });
  material.name = "eigen textures";
  return material as SurfaceMaterial;
}

/** Makes room for `count` eigen textures, at least 1; their scales as the shader takes them, four to a layer. */
export function resizeMaterial(material: SurfaceMaterial, textures: Picture[], count: number): void {
  const room = Math.max(1, count);
  const { uniforms, defines } = material;
  const layers = layersOf(room, defines.CHANNELS);
  const scales = (uniforms.eigenScale.value = new Float32Array(4 * layers));
  const biases = (uniforms.eigenBias.value = new Float32Array(4 * layers));
  textures.slice(0, count).forEach((picture, j) => {
    const [scale, bias] = [scaleOf(picture), biasOf(picture)];
    for (let channel = 0; channel < defines.CHANNELS; channel++) {
      const at = 4 * (defines.CHANNELS * Math.floor(j / 4) + channel) + (j % 4);
      scales[at] = scale.getComponent(channel);
      biases[at] = bias.getComponent(channel);
    }
  });
  uniforms.viewWeights.value = new Float32Array(4 * Math.ceil(room / 4));
  material.defines.COUNT = room;
  material.needsUpdate = true;
}

function scaleOf(picture: Picture): Vector3 {
  return new Vector3().fromArray(picture.scale).multiplyScalar(255);
}

function biasOf(picture: Picture): Vector3 {
  return new Vector3().fromArray(picture.scale.map((scale, i) => -(picture.zero[i] ?? 0) * scale));
}
