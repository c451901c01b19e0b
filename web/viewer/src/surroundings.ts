// The captured views as the free eye sees them: which way is up, where the thing is, and whether any camera was near.

import { Box3, Matrix3, type Object3D, Sphere, Vector2, Vector3 } from "three";
import type { EigenField } from "eigenfield-three";
import { row } from "./geometry";
import { clamp } from "./mode";
import type { Surroundings } from "./orbit-mode";

const EDGE = 1.03; // view-plane units: a little beyond the array is no lie yet
const AGREED = 0.5; // length of the mean of unit vectors that have a direction in common
const LEVEL = 1e-5; // sine of the angle to the view plane under which a ray misses it
const LEAST_ANGLE = 0.15; // radians between the eye and the nearest camera that are always fine

export function surroundingsOf(field: EigenField): Surroundings {
  const { cameras, reference, viewPlane, facesPlane } = field.info;
  field.mesh.updateWorldMatrix(true, false);
  const world = field.mesh.matrixWorld;
  const outwards = (v: readonly number[]): Vector3 => new Vector3(v[0], v[1], v[2]).transformDirection(world);
  const placed = (v: readonly number[]): Vector3 => new Vector3(v[0], v[1], v[2]).applyMatrix4(world);

  // What the cameras agree on; if they were held sideways and stand around, the axis of the ring that they stand on.
  const agreed = new Vector3();
  for (const camera of cameras) agreed.sub(outwards(row(camera.R, 1)));
  const axis = outwards(facesPlane ? viewPlane.up : viewPlane.normal);
  const up = agreed.length() > AGREED * cameras.length ? agreed : axis.multiplyScalar(agreed.dot(axis) < 0 ? -1 : 1);
  const { centre, radius } = extentOf(field.mesh);

  const [right, upwards] = [outwards(viewPlane.right), outwards(viewPlane.up)];
  const normal = new Vector3().crossVectors(right, upwards);
  const origin = placed(viewPlane.origin);
  const [halfWidth, halfHeight] = viewPlane.extent;
  const slack = (EDGE - 1) * Math.max(halfWidth, halfHeight);
  const beyondPlane = (eye: Vector3, target: Vector3): number => {
    const ray = eye.clone().sub(target).normalize();
    const height = origin.clone().sub(target).dot(normal);
    const along = Math.max(ray.dot(normal) * Math.sign(height), LEVEL); // a ray that misses the plane meets it far off
    const met = target.clone().addScaledVector(ray, Math.abs(height) / along).sub(origin);
    const [x, y] = [met.dot(right), met.dot(upwards)];
    const [width, high] = [halfWidth + slack, halfHeight + slack];
    if (along > LEVEL && Math.abs(x) <= width && Math.abs(y) <= high) return 0;
    const nearest = origin.clone().addScaledVector(right, clamp(x, -width, width));
    nearest.addScaledVector(upwards, clamp(y, -high, high));
    return ray.angleTo(nearest.sub(target));
  };

  const centres = cameras.map((camera) => placed(camera.centre));
  const widest = Math.max(LEAST_ANGLE, gap(centres, centre));
  const beyondAll = (eye: Vector3, target: Vector3): number => {
    const ray = eye.clone().sub(target);
    return Math.max(0, Math.min(...centres.map((place) => place.clone().sub(target).angleTo(ray))) - widest);
  };

  const view = cameras[reference];
  const tangents = view
    ? new Vector2(view.width / (2 * row(view.K, 0)[0]), view.height / (2 * row(view.K, 1)[1]))
    : new Vector2(0.5, 0.5);
  const focus = facesPlane ? null : focusOf(centres, cameras.map((camera) => outwards(row(camera.R, 2))));
  const beyond = facesPlane ? beyondPlane : beyondAll;
  return { up: up.normalize(), centre, radius, tangents, focus, framed: facesPlane, beyond };
}

/** The point nearest to all optical axes, least squares: sum of (1 - f fT) (p - c) = 0. Null if they are parallel. */
function focusOf(centres: Vector3[], forwards: Vector3[]): Vector3 | null {
  const sum = new Array<number>(9).fill(0);
  const target = new Vector3();
  centres.forEach((centre, i) => {
    const f = forwards[i];
    if (!f) return;
    target.add(centre).addScaledVector(f, -centre.dot(f));
    const axis = f.toArray();
    for (let k = 0; k < 9; k++) {
      const [r, c] = [Math.floor(k / 3), k % 3];
      sum[k] = (sum[k] ?? 0) + (r === c ? 1 : 0) - (axis[r] ?? 0) * (axis[c] ?? 0);
    }
  });
  const normal = new Matrix3().fromArray(sum); // symmetric: the order of its elements does not matter
  return Math.abs(normal.determinant()) < 1e-6 * centres.length ** 3 ? null : target.applyMatrix3(normal.invert());
}

/** The sphere around an object's box. */
export function extentOf(object: Object3D): { centre: Vector3; radius: number } {
  const sphere = new Box3().setFromObject(object).getBoundingSphere(new Sphere());
  return { centre: sphere.center, radius: Math.max(sphere.radius, 1e-6) };
}

/** One and a half times the median angle between neighbouring cameras, seen from the middle. */
function gap(centres: Vector3[], middle: Vector3): number {
  const rays = centres.slice(0, 200).map((centre) => centre.clone().sub(middle));
  const nearest = rays.map((ray, i) =>
    rays.reduce((least, other, j) => (i === j ? least : Math.min(least, ray.angleTo(other))), Infinity),
  );
  const sorted = nearest.filter(Number.isFinite).sort((a, b) => a - b);
  return 1.5 * (sorted[sorted.length >> 1] ?? 0);
}
