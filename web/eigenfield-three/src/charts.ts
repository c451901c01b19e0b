// Which texels of a grid lie in charts: the mesh laid out by its texture coordinates.

import type { BufferAttribute, BufferGeometry } from "three";
import { link, makeRoom, untouched } from "./gpu.js";
import type { Size } from "./memory.js";
import { CHARTS } from "./packing-shaders.js";
import type { Surface } from "./surface.js";

type GL = WebGL2RenderingContext;

export interface Charts {
  /** 1 in the texels whose centre lies in a chart; null where there is no memory for it. */
  covered(grid: Size): WebGLTexture | null;
  free(): void;
}

export function makeCharts(gl: GL, surface: Surface): Charts {
  const program = link(gl, ...CHARTS);
  const frame = gl.createFramebuffer();
  let found: { geometry: BufferGeometry; grid: Size; texture: WebGLTexture | null } | null = null; // of the last grid

  const draw = (geometry: BufferGeometry, grid: Size, texture: WebGLTexture): void => {
    const { index } = geometry;
    const uv = geometry.getAttribute("uv") as BufferAttribute;
    const corners = Float32Array.from({ length: 2 * (index?.count ?? 0) }, (_, i) => {
      const vertex = index?.getX(i >> 1) ?? 0;
      return i % 2 ? uv.getY(vertex) : uv.getX(vertex);
    });
    const [vertices, buffer] = [gl.createVertexArray(), gl.createBuffer()];
    const before = gl.getParameter(gl.ARRAY_BUFFER_BINDING) as WebGLBuffer | null;
    untouched(gl, () => {
      gl.useProgram(program);
      gl.bindVertexArray(vertices);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STREAM_DRAW);
      const at = gl.getAttribLocation(program, "uv");
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, 2, gl.FLOAT, false, 0, 0);
      gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, frame);
      gl.framebufferTexture2D(gl.DRAW_FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
      gl.viewport(0, 0, ...grid);
      gl.colorMask(true, true, true, true);
      gl.drawArrays(gl.TRIANGLES, 0, corners.length / 2);
    });
    gl.bindBuffer(gl.ARRAY_BUFFER, before);
    gl.deleteBuffer(buffer);
    gl.deleteVertexArray(vertices);
  };

  return {
    covered(grid) {
      const { geometry } = surface;
      if (found?.grid.join() !== grid.join() || found.geometry !== geometry) {
        gl.deleteTexture(found?.texture ?? null);
        const texture = makeRoom(gl, grid, { components: 1, halves: false });
        if (texture) draw(geometry, grid, texture);
        found = { geometry, grid, texture };
      }
      return found.texture;
    },
    free() {
      gl.deleteTexture(found?.texture ?? null);
      gl.deleteFramebuffer(frame);
      gl.deleteProgram(program);
    },
  };
}
