// Cameras that nobody held, and three.js cameras that see what a captured one saw.

import { Matrix4, Vector3, type PerspectiveCamera } from "three";
import type { EigenField } from "./field.js";
import { cross, dot, type CaptureCamera, type Matrix3rows, type Vector } from "./info.js";

/** Where a photograph's frame lies in the canvas: 0 to 1 from its left and top. */
export interface Frame {
  left: number;
  top: number;
  width: number;
  height: number;
}

/**
 * The camera at view-plane coordinates X, Y in -1..1, as large as the reference camera. Its centre is the point of the
 * view plane; K and R are the captured ones', with Delaunay weights: K linearly, R made a rotation again.
 */
export function novelCamera(field: EigenField, x: number, y: number): CaptureCamera {
  const { info } = field;
  const encoded = info.cameras.filter((_, i) => !info.heldOut[i]);
  const reference = info.cameras[info.reference];
  if (!reference) throw new RangeError(`no camera ${info.reference}`);
  const { width, height } = reference;
  const K: Matrix3rows = [[0, 0, 0], [0, 0, 0], [0, 0, 1]];
  const blend: Matrix3rows = [[0, 0, 0], [0, 0, 0], [0, 0, 0]];
  field.viewWeights(x, y, "delaunay").forEach((weight, row) => {
    const camera = encoded[row];
    if (!weight || !camera) return;
    const own = resized(camera, width, height);
    for (const r of [0, 1, 2] as const) {
      for (const c of [0, 1, 2] as const) {
        if (r < 2) K[r][c] += weight * own[r][c];
        blend[r][c] += weight * camera.R[r][c];
      }
    }
  });
  const R = nearestRotation(blend);
  const { origin, right, up, extent } = info.viewPlane;
  const [X, Y] = [clamp(x) * extent[0], clamp(y) * extent[1]];
  const centre: Vector = [0, 1, 2].map((i) => origin[i as 0] + X * right[i as 0] + Y * up[i as 0]) as Vector;
  const t = R.map((axis) => -dot(axis, centre)) as Vector;
  return { name: `${x.toFixed(3)}, ${y.toFixed(3)}`, K, R, t, centre, width, height, gain: null, offset: null };
}

/** K of the same view on a raster that it covers entirely: scaled evenly, centred, cropped. */
function resized({ K, width, height }: CaptureCamera, toWidth: number, toHeight: number): Matrix3rows {
  const scale = Math.max(toWidth / width, toHeight / height);
  const [left, top] = [(toWidth - scale * width) / 2, (toHeight - scale * height) / 2];
  return [
    [scale * K[0][0], scale * K[0][1], scale * K[0][2] + left],
    [0, scale * K[1][1], scale * K[1][2] + top],
    [0, 0, 1],
  ];
}

function clamp(value: number): number {
  return Math.min(1, Math.max(-1, value));
}

/** The rotation nearest to a matrix, least squares (its polar factor), by Newton's iteration M <- (M + M^-T) / 2. */
function nearestRotation(matrix: Matrix3rows): Matrix3rows {
  let M = matrix;
  for (let step = 0; step < 50; step++) {
    const cofactors: Matrix3rows = [cross(M[1], M[2]), cross(M[2], M[0]), cross(M[0], M[1])];
    const determinant = dot(M[0], cofactors[0]);
    if (!(determinant > 1e-12)) break; // rotations that cancel: nothing is nearest
    const next = M.map((row, r) => row.map((v, c) => (v + cofactors[r as 0][c as 0] / determinant) / 2)) as Matrix3rows;
    const moved = Math.max(...next.flatMap((row, r) => row.map((v, c) => Math.abs(v - M[r as 0][c as 0]))));
    M = next;
    if (moved < 1e-15) break;
  }
  return M;
}

/**
 * Sets a three.js camera to a captured or novel one of the field's mesh, wherever mesh and camera hang in the scene.
 * The whole frame lies within the canvas of this `aspect` (width over height) at `zoom` 1, its middle in the canvas'
 * middle, and is larger at more. The projection is K's own, off the axis too: three.js' `fov` and `aspect` say only
 * about what it is, and `updateProjectionMatrix` would undo it. Returns where the frame lies.
 */
export function placeCamera(
  field: EigenField,
  camera: PerspectiveCamera,
  view: CaptureCamera,
  aspect: number,
  zoom = 1,
): Frame {
  const own = view.width / view.height;
  const width = zoom * Math.min(1, own / aspect);
  const height = zoom * Math.min(1, aspect / own);
  const frame = { left: (1 - width) / 2, top: (1 - height) / 2, width, height };
  setPose(field, camera, view);
  setProjection(field, camera, view, frame);
  camera.aspect = aspect;
  camera.fov = (2 * Math.atan(view.height / (2 * view.K[1][1] * height)) * 180) / Math.PI;
  return frame;
}

function setPose(field: EigenField, camera: PerspectiveCamera, view: CaptureCamera): void {
  const { R, centre } = view;
  const pose = new Matrix4().set(
    R[0][0], -R[1][0], -R[2][0], centre[0],
    R[0][1], -R[1][1], -R[2][1], centre[1],
    R[0][2], -R[1][2], -R[2][2], centre[2],
    0, 0, 0, 1,
  );
  field.mesh.updateWorldMatrix(true, false);
  pose.premultiply(field.mesh.matrixWorld);
  if (camera.parent) {
    camera.parent.updateWorldMatrix(true, false);
    pose.premultiply(camera.parent.matrixWorld.clone().invert());
  }
  pose.decompose(camera.position, camera.quaternion, new Vector3());
  camera.updateMatrixWorld(true);
}

/** Clip space from K: the frame's pixels fall where `frame` says. */
function setProjection(field: EigenField, camera: PerspectiveCamera, view: CaptureCamera, frame: Frame): void {
  const [[fx, skew, cx], [, fy, cy]] = view.K;
  const [sx, sy] = [(2 * frame.width) / view.width, (2 * frame.height) / view.height];
  const [near, far] = depthRange(field, view);
  camera.near = near;
  camera.far = far;
  camera.projectionMatrix.set(
    sx * fx, -sx * skew, -(2 * frame.left - 1 + sx * cx), 0,
    0, sy * fy, -(1 - 2 * frame.top - sy * cy), 0,
    0, 0, -(far + near) / (far - near), (-2 * far * near) / (far - near),
    0, 0, -1, 0,
  );
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
}

/** Near and far plane around the mesh, in the units of the scene that holds it. */
function depthRange(field: EigenField, view: CaptureCamera): [number, number] {
  const { geometry, matrixWorld } = field.mesh;
  if (!geometry.boundingSphere) geometry.computeBoundingSphere();
  const { center, radius } = geometry.boundingSphere ?? { center: new Vector3(), radius: 1 };
  const scale = matrixWorld.getMaxScaleOnAxis();
  const distance = center.distanceTo(new Vector3(...view.centre)) * scale;
  const far = 1.01 * (distance + radius * scale);
  return [Math.max(0.5 * (distance - radius * scale), far * 2e-4), far];
}
