// Textures made by WebGL itself: pictures go to the GPU one at a time, without a copy that stays in memory. What
// three.js believes to be bound is put back after each call.

import type { WebGLRenderer } from "three";
import { SceneError } from "./errors.js";
import type { DeviceLimits } from "./memory.js";

type GL = WebGL2RenderingContext;

/** The context of a renderer that can draw eigen textures; a SceneError says what another lacks. */
export function contextOf(renderer: WebGLRenderer): GL {
  const gl = renderer.getContext();
  if (!(gl instanceof WebGL2RenderingContext)) {
    throw new SceneError("unsupported", "Eigen textures need WebGL 2; use a newer browser.");
  }
  const halves = gl.getExtension("EXT_color_buffer_float") ?? gl.getExtension("EXT_color_buffer_half_float");
  if (halves || gl.isContextLost()) return gl; // a lost context has no extensions
  const remedy = "use a newer device or browser, or switch graphics acceleration on.";
  throw new SceneError("unsupported", `The graphics of this device draw no half-floats; ${remedy}`);
}

export function deviceLimits(gl: GL, memory: number): DeviceLimits {
  return {
    side: gl.getParameter(gl.MAX_TEXTURE_SIZE) as number,
    layers: gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS) as number,
    memory,
  };
}

/** Layers of zeros of 8 bits, or of half-floats if `halves`; null if there is no memory. Texels are read one by one, or
 * if `between` linearly. */
export function makeArray(
  gl: GL,
  [width, height]: [number, number],
  layers: number,
  between: boolean,
  halves: boolean,
): WebGLTexture | null {
  return allocated(gl, gl.TEXTURE_2D_ARRAY, () => {
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, halves ? gl.RGBA16F : gl.RGBA8, width, height, layers);
    for (const edge of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) {
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, edge, gl.CLAMP_TO_EDGE);
    }
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, filter, between ? gl.LINEAR : gl.NEAREST);
    }
  });
}

/** A picture into the first layer of an array of its size. */
export function putPicture(gl: GL, array: WebGLTexture, picture: ImageBitmap): void {
  const { width, height } = picture;
  bound(gl, gl.TEXTURE_2D_ARRAY, array, () =>
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, 0, width, height, 1, gl.RGBA, gl.UNSIGNED_BYTE, picture),
  );
}

/** Room for a picture of R, G, B and A, or for codes of two bytes, to be read texel by texel; or null. */
export function makeRoom(gl: GL, [width, height]: [number, number], codes = false): WebGLTexture | null {
  return allocated(gl, gl.TEXTURE_2D, () => {
    gl.texStorage2D(gl.TEXTURE_2D, 1, codes ? gl.RG8 : gl.RGBA8, width, height);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  });
}

function allocated(gl: GL, target: GLenum, store: () => void): WebGLTexture | null {
  while (gl.getError() !== gl.NO_ERROR && !gl.isContextLost()); // errors of others
  const texture = gl.createTexture();
  bound(gl, target, texture, store);
  if (gl.getError() !== gl.OUT_OF_MEMORY) return texture;
  gl.deleteTexture(texture);
  return null;
}

/** Calls `work` with the texture bound and pictures taken as they are, then puts everything back. */
export function bound(gl: GL, target: GLenum, texture: WebGLTexture, work: () => void): void {
  const array = target === gl.TEXTURE_2D_ARRAY;
  const before = gl.getParameter(array ? gl.TEXTURE_BINDING_2D_ARRAY : gl.TEXTURE_BINDING_2D) as WebGLTexture | null;
  const wanted: [GLenum, number | boolean][] = [
    [gl.UNPACK_FLIP_Y_WEBGL, false],
    [gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false],
    [gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE],
    [gl.UNPACK_ALIGNMENT, 4],
    [gl.UNPACK_ROW_LENGTH, 0],
    [gl.UNPACK_IMAGE_HEIGHT, 0],
    [gl.UNPACK_SKIP_PIXELS, 0],
    [gl.UNPACK_SKIP_ROWS, 0],
    [gl.UNPACK_SKIP_IMAGES, 0],
  ];
  const saved = wanted.map(([name]): [GLenum, number | boolean] => [name, gl.getParameter(name) as number | boolean]);
  const buffer = gl.getParameter(gl.PIXEL_UNPACK_BUFFER_BINDING) as WebGLBuffer | null;
  if (buffer) gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, null);
  wanted.forEach(([name, value]) => gl.pixelStorei(name, value));
  gl.bindTexture(target, texture);
  work();
  gl.bindTexture(target, before);
  saved.forEach(([name, value]) => gl.pixelStorei(name, value));
  if (buffer) gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, buffer);
}
