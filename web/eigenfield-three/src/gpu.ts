// Textures made by WebGL itself: pictures go to the GPU one at a time, without a copy that stays in memory. What
// three.js believes to be bound is put back after each call.

import type { DeviceLimits } from "./memory.js";

type GL = WebGL2RenderingContext;

export function deviceLimits(gl: GL, memory: number): DeviceLimits {
  return {
    side: gl.getParameter(gl.MAX_TEXTURE_SIZE) as number,
    layers: gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS) as number,
    vectors: gl.getParameter(gl.MAX_FRAGMENT_UNIFORM_VECTORS) as number,
    memory,
  };
}

/** A picture as a texture with mips. */
export function makeTexture(gl: GL, picture: ImageBitmap): WebGLTexture {
  const texture = gl.createTexture();
  bound(gl, gl.TEXTURE_2D, texture, () => {
    gl.texStorage2D(gl.TEXTURE_2D, levels(picture.width, picture.height), gl.RGBA8, picture.width, picture.height);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.generateMipmap(gl.TEXTURE_2D);
    clampEdges(gl, gl.TEXTURE_2D);
    useMips(gl, gl.TEXTURE_2D);
  });
  return texture;
}

/** Layers of zeros, or null if there is no memory. Filters linearly until `finishArray`. */
export function makeArray(gl: GL, width: number, height: number, layers: number): WebGLTexture | null {
  return allocated(gl, gl.TEXTURE_2D_ARRAY, () => {
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, levels(width, height), gl.RGBA8, width, height, layers);
    clampEdges(gl, gl.TEXTURE_2D_ARRAY);
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
  });
}

/** Room for a picture to be read texel by texel, or null. */
export function makeRoom(gl: GL, width: number, height: number): WebGLTexture | null {
  return allocated(gl, gl.TEXTURE_2D, () => {
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
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

/** Makes the mips of an array whose layers are all there, and filters with them from now on. */
export function finishArray(gl: GL, texture: WebGLTexture): void {
  bound(gl, gl.TEXTURE_2D_ARRAY, texture, () => {
    gl.generateMipmap(gl.TEXTURE_2D_ARRAY);
    useMips(gl, gl.TEXTURE_2D_ARRAY);
  });
}

function levels(width: number, height: number): number {
  return 1 + Math.floor(Math.log2(Math.max(width, height)));
}

function clampEdges(gl: GL, target: GLenum): void {
  gl.texParameteri(target, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(target, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
}

function useMips(gl: GL, target: GLenum): void {
  gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
  gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
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
  const kept = wanted.map(([name]): [GLenum, number | boolean] => [name, gl.getParameter(name) as number | boolean]);
  const buffer = gl.getParameter(gl.PIXEL_UNPACK_BUFFER_BINDING) as WebGLBuffer | null;
  if (buffer) gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, null);
  wanted.forEach(([name, value]) => gl.pixelStorei(name, value));
  gl.bindTexture(target, texture);
  work();
  gl.bindTexture(target, before);
  kept.forEach(([name, value]) => gl.pixelStorei(name, value));
  if (buffer) gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, buffer);
}
