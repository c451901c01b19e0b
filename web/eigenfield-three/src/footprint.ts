import type { BufferGeometry } from "three";
import type { CaptureCamera } from "./info.js";

const TRIANGLES = 256; // from which the median is taken

/**
 * Texels of a `size` atlas along a side of a captured camera's pixel: the median over picture area of (some of) the
 * triangles in view, 0 if there are none. As `median_footprint` of eigenfield/rendering/software/drawing.py.
 */
export function medianFootprint(geometry: BufferGeometry, camera: CaptureCamera, size: [number, number]): number {
  const { index } = geometry;
  const position = geometry.getAttribute("position");
  const uv = geometry.getAttribute("uv");
  if (!index || !position || !uv) return 0;
  const faces = index.count / 3;
  const step = Math.max(1, Math.floor(faces / TRIANGLES));
  const found: { footprint: number; area: number }[] = [];
  for (let face = 0; face < faces; face += step) {
    const corners = [0, 1, 2].map((i) => index.getX(3 * face + i));
    const projected = corners.map((v) => project(camera, position.getX(v), position.getY(v), position.getZ(v)));
    const screen = area(projected);
    const middle = [0, 1].map((axis) => projected.reduce((sum, corner) => sum + (corner[axis] ?? NaN) / 3, 0));
    const [x = NaN, y = NaN] = middle;
    if (!(screen > 0 && x >= 0 && y >= 0 && x < camera.width && y < camera.height)) continue;
    const atlas = area(corners.map((v) => [uv.getX(v) * size[0], uv.getY(v) * size[1]]));
    found.push({ footprint: Math.sqrt(atlas / screen), area: screen });
  }
  found.sort((a, b) => a.footprint - b.footprint);
  const half = found.reduce((sum, { area }) => sum + area, 0) / 2;
  let total = 0;
  return found.find(({ area }) => (total += area) >= half)?.footprint ?? 0;
}

/** A place in the camera's picture, in pixels; NaN behind it. */
function project({ K, R, t }: CaptureCamera, x: number, y: number, z: number): [number, number] {
  const along = (i: 0 | 1 | 2): number => R[i][0] * x + R[i][1] * y + R[i][2] * z + t[i];
  const [a, b, depth] = [along(0), along(1), along(2)];
  if (!(depth > 0)) return [NaN, NaN];
  return [(K[0][0] * a + K[0][1] * b) / depth + K[0][2], (K[1][1] * b) / depth + K[1][2]];
}

function area(corners: number[][]): number {
  const [[ax = 0, ay = 0] = [], [bx = 0, by = 0] = [], [cx = 0, cy = 0] = []] = corners;
  return Math.abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2;
}
