// Pictures come one at a time; on the GPU four eigen textures, or four channels of a mean, share a texel. Each is drawn
// into its component of its layer, code by code, and what three.js and others have set is put back. Codes of a mean
// with a precision p are stored as (code - zero) / p / FINE, so that who sums them knows nothing of it.

import { bound } from "./gpu.js";
import type { Codes, Piece } from "./pieces.js";

type GL = WebGL2RenderingContext;

/** Codes at p = 1 that a stored 1 stands for: 1023 at the smallest p, 1/256, is still a half-float. */
export const FINE = 4;

const VERTEX = `#version 300 es
void main() {
  gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);
}
`;
const FRAGMENT = `#version 300 es
precision highp float;
uniform highp sampler2D picture;
uniform vec4 factors;
uniform vec2 size; // of what is drawn
uniform highp sampler2D precisions;
uniform ivec2 nodes; // columns and rows of it that are used; 0: codes are stored as they are
uniform float zero;
out vec4 stored;
float nodeAt(ivec2 at) {
  return texelFetch(precisions, clamp(at, ivec2(0), nodes - 1), 0).r;
}
float precisionAt(vec2 uv) {
  vec2 at = uv * vec2(nodes) - 0.5;
  ivec2 low = ivec2(floor(at));
  vec2 part = at - vec2(low);
  float upper = mix(nodeAt(low), nodeAt(low + ivec2(1, 0)), part.x);
  float lower = mix(nodeAt(low + ivec2(0, 1)), nodeAt(low + ivec2(1, 1)), part.x);
  return (255.0 * mix(upper, lower, part.y) + 1.0) / 256.0;
}
void main() {
  float code = dot(texelFetch(picture, ivec2(gl_FragCoord.xy), 0), factors);
  if (nodes.x == 0) stored = vec4(code);
  else stored = vec4(clamp((code - zero) / precisionAt(gl_FragCoord.xy / size) / ${FINE}.0, -65504.0, 65504.0));
}
`;

/** Where a channel of a picture goes: a component of a layer. */
export interface Slot {
  channel: number;
  layer: number;
  component: number;
}

/** Where pictures are put while they are packed. */
export interface Rooms {
  picture: WebGLTexture;
  codes: WebGLTexture | null; // null: all pictures have 8 bits
  precision: WebGLTexture;
}

/** How fine the codes of a channel are. */
export interface Fineness {
  precision: ImageBitmap;
  zero: number;
}

export interface Packer {
  /** `unit`: what is stored of a picture's 1. Codes are stored as they are, without `fine`. */
  put(piece: Piece, array: WebGLTexture, slots: Slot[], unit: number, fine?: Fineness | null): void;
  free(): void;
}

/** Puts pieces of pictures into arrays as compose.glsl reads them, by way of the rooms, which it owns. */
export function makePacker(gl: GL, rooms: Rooms): Packer {
  const program = link(gl);
  const [frame, vertices] = [gl.createFramebuffer(), gl.createVertexArray()];
  const [factors, size, precisions, nodes, zero] = ["factors", "size", "precisions", "nodes", "zero"].map((name) =>
    gl.getUniformLocation(program, name),
  );

  const draw: Packer["put"] = ({ picture, rows }, array, slots, unit, fine) => {
    gl.useProgram(program); // its sampler `picture` reads unit 0
    gl.uniform2f(size ?? null, picture.width, rows);
    gl.uniform1i(precisions ?? null, fine ? 1 : 0); // on unit 1 may be anything
    gl.uniform2i(nodes ?? null, fine?.precision.width ?? 0, fine?.precision.height ?? 0);
    gl.uniform1f(zero ?? null, fine?.zero ?? 0);
    gl.bindVertexArray(vertices);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, frame);
    gl.viewport(0, 0, picture.width, rows);
    for (const { channel, layer, component } of slots) {
      gl.colorMask(component === 0, component === 1, component === 2, component === 3);
      gl.framebufferTextureLayer(gl.DRAW_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, array, 0, layer);
      if (isCodes(picture)) gl.uniform4f(factors ?? null, 255, 255 * 256, 0, 0);
      else gl.uniform4fv(factors ?? null, [0, 1, 2, 3].map((own) => (own === channel ? unit : 0)));
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
  };

  return {
    put(piece, array, slots, unit, fine = null) {
      const { picture, row, rows } = piece;
      const room = isCodes(picture) ? rooms.codes : rooms.picture;
      if (!room) return;
      const pack = (): void =>
        onUnit(gl, 0, room, () => {
          if (isCodes(picture)) putCodes(gl, picture, row, rows);
          else putRows(gl, picture, row, rows);
          untouched(gl, () => draw(piece, array, slots, unit, fine));
        });
      if (!fine) pack();
      else {
        onUnit(gl, 1, rooms.precision, () => {
          putRows(gl, fine.precision, 0, fine.precision.height);
          pack();
        });
      }
    },
    free() {
      gl.deleteTexture(rooms.picture);
      gl.deleteTexture(rooms.codes);
      gl.deleteTexture(rooms.precision);
      gl.deleteVertexArray(vertices);
      gl.deleteFramebuffer(frame);
      gl.deleteProgram(program);
    },
  };
}

function isCodes(picture: ImageBitmap | Codes): picture is Codes {
  return "data" in picture;
}

function putRows(gl: GL, picture: ImageBitmap, row: number, rows: number): void {
  gl.pixelStorei(gl.UNPACK_SKIP_ROWS, row);
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, picture.width, rows, gl.RGBA, gl.UNSIGNED_BYTE, picture);
}

function putCodes(gl: GL, { data, width, stride }: Codes, row: number, rows: number): void {
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.pixelStorei(gl.UNPACK_ROW_LENGTH, stride / 2);
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, rows, gl.RG, gl.UNSIGNED_BYTE, data, row * stride);
}

function link(gl: GL): WebGLProgram {
  const program = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]] as const) {
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

/** Calls `work` with the texture bound to a unit, read by no sampler of others. */
function onUnit(gl: GL, unit: number, texture: WebGLTexture, work: () => void): void {
  const active = gl.getParameter(gl.ACTIVE_TEXTURE) as GLenum;
  gl.activeTexture(gl.TEXTURE0 + unit);
  const sampler = gl.getParameter(gl.SAMPLER_BINDING) as WebGLSampler | null;
  gl.bindSampler(unit, null);
  bound(gl, gl.TEXTURE_2D, texture, work);
  gl.bindSampler(unit, sampler);
  gl.activeTexture(active);
}

/** Calls `work`, which draws, with every test and blending off, and puts back what it sets. */
function untouched(gl: GL, work: () => void): void {
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
  gl.useProgram(program);
  gl.bindVertexArray(vertices);
  gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, frame);
  gl.viewport(x, y, width, height);
  gl.colorMask(red ?? true, green ?? true, blue ?? true, alpha ?? true);
}
