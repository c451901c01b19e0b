// The captured views as the free eye sees them: which way is up, where the thing is, and whether any camera was near.

import { Box3, type Object3D, Sphere, Vector2, Vector3 } from "three";
import type { EigenField } from "eigenfield-three";
import { row } from "./geometry";
import type { Surroundings } from "./orbit-mode";

const EDGE = 1.03; // view-plane units: a little beyond the array is no lie yet
const LEAST_ANGLE = 0.15; // radians between the eye and the nearest camera that are always fine

export function surroundingsOf(field: EigenField): Surroundings {
  const { cameras, reference, viewPlane, facesPlane } = field.info;
  field.mesh.updateWorldMatrix(true, false);
  const world = field.mesh.matrixWorld;
  const outwards = (v: readonly number[]): Vector3 => new Vector3(v[0], v[1], v[2]).transformDirection(world);
  const placed = (v: readonly number[]): Vector3 => new Vector3(v[0], v[1], v[2]).applyMatrix4(world);

  const up = new Vector3();
  for (const camera of cameras) up.sub(outwards(row(camera.R, 1)));
  if (up.length() < 0.2 * cameras.length) up.copy(outwards(viewPlane.up));
  const { centre, radius } = extentOf(field.mesh);

  const [right, upwards] = [outwards(viewPlane.right), outwards(viewPlane.up)];
  const normal = new Vector3().crossVectors(right, upwards);
  const origin = placed(viewPlane.origin);
  const [halfWidth, halfHeight] = viewPlane.extent;
  const beyondPlane = (eye: Vector3, target: Vector3): boolean => {
    const ray = eye.clone().sub(target);
    const along = ray.dot(normal);
    const height = origin.clone().sub(target).dot(normal);
    if (along * height <= 0 || Math.abs(along) < 1e-5 * ray.length()) return true;
    const met = target.clone().addScaledVector(ray, height / along).sub(origin);
    const slack = (EDGE - 1) * Math.max(halfWidth, halfHeight);
    return Math.abs(met.dot(right)) > halfWidth + slack || Math.abs(met.dot(upwards)) > halfHeight + slack;
  };

  const centres = cameras.map((camera) => placed(camera.centre));
  const widest = Math.max(LEAST_ANGLE, gap(centres, centre));
  const farFromAll = (eye: Vector3, target: Vector3): boolean => {
    const ray = eye.clone().sub(target);
    return centres.every((place) => place.clone().sub(target).angleTo(ray) > widest);
  };

  const view = cameras[reference];
  const tangents = view
    ? new Vector2(view.width / (2 * row(view.K, 0)[0]), view.height / (2 * row(view.K, 1)[1]))
    : new Vector2(0.5, 0.5);
  return { up: up.normalize(), centre, radius, tangents, outside: facesPlane ? beyondPlane : farFromAll };
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
