// Pictures come one at a time; on the GPU four eigen textures, or four channels of a mean, share a texel. Each is drawn
// into its component of its layer, code by code, and what three.js and others have set is put back. Codes of a mean
// with a precision p are stored as (code - zero) / p / FINE, so that who sums them knows nothing of it.

import { makeCharts } from "./charts.js";
import { link, onUnit, untouched } from "./gpu.js";
import type { Size } from "./memory.js";
import type { Codes, Piece } from "./pieces.js";
import { COPY, PACK, SPREAD, TRIANGLE } from "./packing-shaders.js";
import type { Surface } from "./surface.js";

type GL = WebGL2RenderingContext;

/** Where a channel of a picture goes: a component of a layer. */
export interface Slot {
  channel: number;
  layer: number;
  component: number;
}

/** What becomes of a piece. */
export interface Aim {
  size: Size; // of what is stored: that of the piece, or less
  grid: Size; // in which the piece lies
  corner: Size; // its first column and row there
  unit: number; // what is stored of a code of 1
  codes: number; // that a picture's 1 stands for
}

/** Where pictures are put while they are packed. */
export interface Rooms {
  picture: WebGLTexture;
  codes: WebGLTexture | null; // null: all pictures have 8 bits
  precision: WebGLTexture;
  smaller: WebGLTexture | null; // values and whether they are of a chart; null: all textures keep their size
}

/** How fine the codes of a channel are. */
export interface Fineness {
  precision: ImageBitmap;
  zero: number;
}

export interface Packer {
  /** Codes are stored as they are, without `fine`. */
  put(piece: Piece, array: WebGLTexture, slots: Slot[], aim: Aim, fine?: Fineness | null): void;
  free(): void;
}

const UNIFORMS = ["precisions", "covered", "factors", "size", "made", "first", "corner", "nodes", "zero"] as const;

/** Of a program, by their names; null: it has none of that name. */
type Places = Record<(typeof UNIFORMS)[number], WebGLUniformLocation | null>;

/** Puts pieces of pictures into arrays as compose.glsl reads them, by way of the rooms, which it owns and in which so
 * many rows fit. `surface` has the charts: where textures become smaller, nothing beside a chart gets into it. */
export function makePacker(gl: GL, rooms: Rooms, fitting: number, surface: Surface): Packer {
  const [copying, packing, spreading] = [link(gl, TRIANGLE, COPY), link(gl, TRIANGLE, PACK), link(gl, TRIANGLE, SPREAD)];
  const [frame, vertices] = [gl.createFramebuffer(), gl.createVertexArray()];
  const charts = rooms.smaller && makeCharts(gl, surface);
  const placesOf = (program: WebGLProgram): Places =>
    Object.fromEntries(UNIFORMS.map((name) => [name, gl.getUniformLocation(program, name)])) as Places;
  const [ofCopying, ofPacking] = [placesOf(copying), placesOf(packing)];

  /** Draws rows of what is stored, from `top`, of a picture whose rows from `first` are in its room. */
  const draw = (at: Places, piece: Piece, channel: number, aim: Aim, first: number, top: number, count: number): void => {
    const { picture, rows } = piece;
    const { size, corner, unit, codes } = aim;
    if (isCodes(picture)) gl.uniform4f(at.factors, 255 * unit, 255 * 256 * unit, 0, 0);
    else gl.uniform4fv(at.factors, [0, 1, 2, 3].map((own) => (own === channel ? codes * unit : 0)));
    gl.uniform2i(at.size, picture.width, rows);
    gl.uniform2i(at.made, ...size);
    gl.uniform2i(at.corner, ...corner);
    gl.uniform1i(at.first, first);
    gl.viewport(0, top, size[0], count);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  };

  const into = (texture: WebGLTexture | null, layer: number | null): void => {
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, frame);
    if (layer !== null) gl.framebufferTextureLayer(gl.DRAW_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, texture, 0, layer);
    else gl.framebufferTexture2D(gl.DRAW_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  };

  const toSlot = (array: WebGLTexture, { layer, component }: Slot): void => {
    into(array, layer);
    gl.colorMask(component === 0, component === 1, component === 2, component === 3);
  };

  /** Puts a channel where it goes, by way of a smaller texture of values if it becomes smaller. */
  const putSlot = (piece: Piece, room: WebGLTexture, array: WebGLTexture, slot: Slot, aim: Aim, fine: Fineness | null): void => {
    const { picture, row, rows } = piece;
    const [width, height] = aim.size;
    const smaller = width < picture.width || height < rows ? rooms.smaller : null;
    const step = Math.max(1, Math.floor(((smaller ? fitting - 2 : fitting) * height) / rows));
    const covered = (smaller && charts?.covered(aim.grid)) ?? null;
    onUnit(gl, 0, room, () => {
      for (let top = 0; top < height; top += step) {
        const count = Math.min(step, height - top);
        const first = Math.floor((top * rows) / height);
        const last = Math.ceil(((top + count) * rows) / height);
        if (isCodes(picture)) putCodes(gl, picture, row + first, last - first);
        else putRows(gl, picture, row + first, last - first);
        onUnit(gl, 2, covered, () => untouched(gl, () => {
          const as = smaller || fine ? ofPacking : ofCopying;
          gl.useProgram(smaller || fine ? packing : copying); // its sampler `picture` reads unit 0
          gl.bindVertexArray(vertices);
          gl.uniform1i(as.precisions, fine ? 1 : 0); // on unit 1 may be anything
          gl.uniform1i(as.covered, smaller ? 2 : 0);
          gl.uniform2i(as.nodes, fine?.precision.width ?? 0, fine?.precision.height ?? 0);
          gl.uniform1f(as.zero, fine?.zero ?? 0);
          if (smaller) {
            into(smaller, null);
            gl.colorMask(true, true, true, true);
          } else toSlot(array, slot);
          draw(as, piece, slot.channel, aim, first, top, count);
        }));
      }
    });
    if (!smaller) return;
    onUnit(gl, 0, smaller, () =>
      untouched(gl, () => {
        gl.useProgram(spreading);
        gl.bindVertexArray(vertices);
        gl.uniform2i(gl.getUniformLocation(spreading, "size"), width, height);
        toSlot(array, slot);
        gl.viewport(0, 0, width, height);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
      }),
    );
  };

  return {
    put(piece, array, slots, aim, fine = null) {
      const room = isCodes(piece.picture) ? rooms.codes : rooms.picture;
      if (!room) return;
      const pack = (): void => slots.forEach((slot) => putSlot(piece, room, array, slot, aim, fine));
      if (!fine) pack();
      else {
        onUnit(gl, 1, rooms.precision, () => {
          putRows(gl, fine.precision, 0, fine.precision.height);
          pack();
        });
      }
    },
    free() {
      for (const texture of Object.values(rooms) as (WebGLTexture | null)[]) gl.deleteTexture(texture);
      charts?.free();
      gl.deleteVertexArray(vertices);
      gl.deleteFramebuffer(frame);
      for (const program of [copying, packing, spreading]) gl.deleteProgram(program);
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
