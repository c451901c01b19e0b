// Pictures come one at a time; on the GPU four eigen textures, or four channels of a mean, share a texel. Each is drawn
// into its component of its layer, code by code, and what three.js and others have set is put back.

import type { Piece } from "./decode.js";
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
uniform int channel;
out vec4 code;
void main() {
  code = vec4(texelFetch(picture, ivec2(gl_FragCoord.xy), 0)[channel]);
}
`;

/** Where a channel of a picture goes: a component of a layer. */
export interface Slot {
  channel: number;
  layer: number;
  component: number;
}

export interface Packer {
  put(piece: Piece, array: WebGLTexture, slots: Slot[]): void;
  free(): void;
}

/** Puts pieces of pictures into arrays as compose.glsl reads them, by way of the texture `picture`, which it owns. */
export function makePacker(gl: GL, picture: WebGLTexture): Packer {
  const program = link(gl);
  const [frame, vertices] = [gl.createFramebuffer(), gl.createVertexArray()];
  const channelAt = gl.getUniformLocation(program, "channel");

  const draw = ({ bitmap, rows }: Piece, array: WebGLTexture, slots: Slot[]): void => {
    gl.useProgram(program); // its sampler reads unit 0
    gl.bindVertexArray(vertices);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, frame);
    gl.viewport(0, 0, bitmap.width, rows);
    for (const { channel, layer, component } of slots) {
      gl.colorMask(component === 0, component === 1, component === 2, component === 3);
      gl.framebufferTextureLayer(gl.DRAW_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, array, 0, layer);
      gl.uniform1i(channelAt, channel);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    }
  };

  return {
    put(piece, array, slots) {
      const { bitmap, row, rows } = piece;
      onFirstUnit(gl, () =>
        bound(gl, gl.TEXTURE_2D, picture, () => {
          gl.pixelStorei(gl.UNPACK_SKIP_ROWS, row);
          gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, bitmap.width, rows, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
          untouched(gl, () => draw(piece, array, slots));
        }),
      );
    },
    free() {
      gl.deleteTexture(picture);
      gl.deleteVertexArray(vertices);
      gl.deleteFramebuffer(frame);
      gl.deleteProgram(program);
    },
  };
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
