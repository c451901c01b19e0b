// Pictures come one at a time; on the GPU four eigen textures, or four channels of a mean, share a texel. Each is drawn
// into its component of its layer, code by code, and what three.js and others have set is put back.

import type { Piece } from "./decode.js";
import type { Codes } from "./deep.js";
import { bound } from "./gpu.js";

type GL = WebGL2RenderingContext;

const VERTEX = `#version 300 es
void main() {
  gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);
}
`;
const FRAGMENT = `#version 300 es
precision highp float;
uniform highp sampler2D picture;
uniform vec4 factors;
out vec4 code;
void main() {
  code = vec4(dot(texelFetch(picture, ivec2(gl_FragCoord.xy), 0), factors));
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
}

export interface Packer {
  /** `unit`: what is stored of a picture's 1. Codes are stored as they are. */
  put(piece: Piece, array: WebGLTexture, slots: Slot[], unit: number): void;
  free(): void;
}

/** Puts pieces of pictures into arrays as compose.glsl reads them, by way of the rooms, which it owns. */
export function makePacker(gl: GL, rooms: Rooms): Packer {
  const program = link(gl);
  const [frame, vertices] = [gl.createFramebuffer(), gl.createVertexArray()];
  const factors = gl.getUniformLocation(program, "factors");

  const draw = ({ picture, rows }: Piece, array: WebGLTexture, slots: Slot[], unit: number): void => {
    gl.useProgram(program); // its sampler reads unit 0
    gl.bindVertexArray(vertices);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, frame);
    gl.viewport(0, 0, picture.width, rows);
    for (const { channel, layer, component } of slots) {
      gl.colorMask(component === 0, component === 1, component === 2, component === 3);
      gl.framebufferTextureLayer(gl.DRAW_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, array, 0, layer);
      if (isCodes(picture)) gl.uniform4f(factors, 255, 255 * 256, 0, 0);
      else gl.uniform4fv(factors, [0, 1, 2, 3].map((own) => (own === channel ? unit : 0)));
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
  };

  return {
    put(piece, array, slots, unit) {
      const { picture, row, rows } = piece;
      const room = isCodes(picture) ? rooms.codes : rooms.picture;
      if (!room) return;
      onFirstUnit(gl, () =>
        bound(gl, gl.TEXTURE_2D, room, () => {
          if (isCodes(picture)) putCodes(gl, picture, row, rows);
          else {
            gl.pixelStorei(gl.UNPACK_SKIP_ROWS, row);
            gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, picture.width, rows, gl.RGBA, gl.UNSIGNED_BYTE, picture);
          }
          untouched(gl, () => draw(piece, array, slots, unit));
        }),
      );
    },
    free() {
      gl.deleteTexture(rooms.picture);
      gl.deleteTexture(rooms.codes);
      gl.deleteVertexArray(vertices);
      gl.deleteFramebuffer(frame);
      gl.deleteProgram(program);
    },
  };
}

function isCodes(picture: ImageBitmap | Codes): picture is Codes {
  return "data" in picture;
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

function onFirstUnit(gl: GL, work: () => void): void {
  const unit = gl.getParameter(gl.ACTIVE_TEXTURE) as GLenum;
  gl.activeTexture(gl.TEXTURE0);
  const sampler = gl.getParameter(gl.SAMPLER_BINDING) as WebGLSampler | null;
  gl.bindSampler(0, null);
  work();
  gl.bindSampler(0, sampler);
  gl.activeTexture(unit);
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
