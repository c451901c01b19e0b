// Textures made by WebGL itself: pictures go to the GPU one at a time, without a copy that stays in memory. What
// three.js believes to be bound is put back after each call.

import type { WebGLRenderer } from "three";
import { SceneError } from "./errors.js";
import type { DeviceLimits, Format } from "./memory.js";
import type { Codes } from "./pieces.js";

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

function formatOf(gl: GL, { components, halves }: Format): GLenum {
  if (components > 2) return halves ? gl.RGBA16F : gl.RGBA8;
  if (components > 1) return halves ? gl.RG16F : gl.RG8;
  return halves ? gl.R16F : gl.R8;
}

/** Layers of zeros; null if there is no memory. Texels are read one by one, or if `between` linearly. */
export function makeArray(
  gl: GL,
  [width, height]: [number, number],
  layers: number,
  between: boolean,
  format: Format,
): WebGLTexture | null {
  return allocated(gl, gl.TEXTURE_2D_ARRAY, () => {
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, formatOf(gl, format), width, height, layers);
    for (const edge of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) {
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, edge, gl.CLAMP_TO_EDGE);
    }
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, filter, between ? gl.LINEAR : gl.NEAREST);
    }
  });
}

/** A picture of so many channels into the first layer of an array of its size. */
export function putPicture(gl: GL, array: WebGLTexture, picture: ImageBitmap, channels: number): void {
  const { width, height } = picture;
  const format = channels > 2 ? gl.RGBA : channels > 1 ? gl.RG : gl.RED;
  bound(gl, gl.TEXTURE_2D_ARRAY, array, () =>
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, 0, width, height, 1, format, gl.UNSIGNED_BYTE, picture),
  );
}

/** Codes of an array's size into its layers from `first` on, their two bytes as R and G. */
export function putWords(gl: GL, array: WebGLTexture, first: number, pictures: Codes[]): void {
  bound(gl, gl.TEXTURE_2D_ARRAY, array, () => {
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    pictures.forEach(({ data, width, height, stride }, i) => {
      gl.pixelStorei(gl.UNPACK_ROW_LENGTH, stride / 2);
      gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, first + i, width, height, 1, gl.RG, gl.UNSIGNED_BYTE, data);
    });
  });
}

/** A texture to be read texel by texel; null if there is no memory. */
export function makeRoom(gl: GL, [width, height]: [number, number], format: Format): WebGLTexture | null {
  return allocated(gl, gl.TEXTURE_2D, () => {
    gl.texStorage2D(gl.TEXTURE_2D, 1, formatOf(gl, format), width, height);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    }
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

/** A program of two shaders. */
export function link(gl: GL, vertex: string, fragment: string): WebGLProgram {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
    const shader = gl.createShader(type);
    if (!shader) continue; // the context is lost: nothing is drawn
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    gl.deleteShader(shader); // with the program
  }
  gl.linkProgram(program);
  return program;
}

/** Calls `work` with the texture bound to a unit, read by no sampler of others; null: nothing is. */
export function onUnit(gl: GL, unit: number, texture: WebGLTexture | null, work: () => void): void {
  if (!texture) {
    work();
    return;
  }
  const active = gl.getParameter(gl.ACTIVE_TEXTURE) as GLenum;
  gl.activeTexture(gl.TEXTURE0 + unit);
  const sampler = gl.getParameter(gl.SAMPLER_BINDING) as WebGLSampler | null;
  gl.bindSampler(unit, null);
  bound(gl, gl.TEXTURE_2D, texture, work);
  gl.bindSampler(unit, sampler);
  gl.activeTexture(active);
}

/** Calls `work`, which draws, with every test and blending off, and puts back what it sets. */
export function untouched(gl: GL, work: () => void): void {
  const switches = [
    gl.BLEND,
    gl.CULL_FACE,
    gl.DEPTH_TEST,
    gl.DITHER,
    gl.RASTERIZER_DISCARD,
    gl.SAMPLE_ALPHA_TO_COVERAGE,
    gl.SAMPLE_COVERAGE,
    gl.SCISSOR_TEST,
    gl.STENCIL_TEST,
  ].filter((name) => gl.isEnabled(name));
  const program = gl.getParameter(gl.CURRENT_PROGRAM) as WebGLProgram | null;
  const vertices = gl.getParameter(gl.VERTEX_ARRAY_BINDING) as WebGLVertexArrayObject | null;
  const frame = gl.getParameter(gl.DRAW_FRAMEBUFFER_BINDING) as WebGLFramebuffer | null;
  const [x = 0, y = 0, width = 0, height = 0] = gl.getParameter(gl.VIEWPORT) as Int32Array;
  const [red, green, blue, alpha] = gl.getParameter(gl.COLOR_WRITEMASK) as boolean[];
  switches.forEach((name) => gl.disable(name));
  work();
  switches.forEach((name) => gl.enable(name));
  gl.useProgram(program && gl.isProgram(program) ? program : null); // not if it was deleted meanwhile
  gl.bindVertexArray(vertices);
  gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, frame);
  gl.viewport(x, y, width, height);
  gl.colorMask(red ?? true, green ?? true, blue ?? true, alpha ?? true);
}
