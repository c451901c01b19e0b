// A free eye around a point of the surface. Angles are about the cameras' own mean "up", so that captures all around a
// thing turn as it stands; a camera's roll is kept on the way in and let go with the first movement.

import { MathUtils, type Object3D, type PerspectiveCamera, Quaternion, Raycaster, Vector2, Vector3 } from "three";
import { approach, clamp, fillsHeight, type Mode, type Push, WHOLE } from "./mode";

const TURN = 2.4; // radians that a drag across the smaller side of the canvas turns
const STEEPEST = 1.45; // radians above or below
const SMOOTH = 0.07; // seconds
const GIVE = 0.1; // radians beyond the captured views over which a step outwards loses nearly two thirds of its length
const HALVINGS = 12; // when looking for the part of a step that is left

/** Where captured views are, in the world of three.js: what `outside` and the resistance beyond them need to know. */
export interface Surroundings {
  up: Vector3;
  centre: Vector3; // of the surface
  radius: number;
  tangents: Vector2; // half the reference camera's picture over its focal length, across and down
  focus: Vector3 | null; // what cameras that stand around look at: a free eye turns about it, and stays among them
  framed: boolean; // photographs show a view that goes on beside them, not a thing in their middle
  /** Radians from the direction of an eye, as the target sees it, to the nearest one that was captured; 0 among them. */
  beyond(eye: Vector3, target: Vector3): number;
}

export interface OrbitMode extends Mode {
  /** Take over from wherever a camera stands, about the point of the surface that it looks at or one near `focus`. */
  enter(camera: PerspectiveCamera, look: Vector2): void;
  /** Make the point of the surface at canvas coordinates (-1..1, up) the one to turn about. */
  aim(camera: PerspectiveCamera, at: Vector2): void;
  set(eye: Vector3, target: Vector3): void;
  pose(): { eye: Vector3; target: Vector3 };
}

interface Place {
  yaw: number;
  pitch: number;
  roll: number;
  distance: number;
  target: Vector3;
}

export function createOrbitMode(object: Object3D, around: Surroundings): OrbitMode {
  const upright = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), around.up);
  const level = upright.clone().invert();
  const place: Place = { yaw: 0, pitch: 0, roll: 0, distance: around.radius, target: around.centre.clone() };
  const goal: Place = { ...place, target: place.target.clone() };
  const ray = new Raycaster();
  let aspect = 1;

  const direction = (at: Place): Vector3 =>
    new Vector3(Math.sin(at.yaw) * Math.cos(at.pitch), Math.sin(at.pitch), Math.cos(at.yaw) * Math.cos(at.pitch))
      .applyQuaternion(upright);
  const eyeOf = (at: Place): Vector3 => direction(at).multiplyScalar(at.distance).add(at.target);
  const settle = (): void => {
    Object.assign(place, goal, { target: goal.target.clone() });
  };
  const aimed = (eye: Vector3, target: Vector3): void => {
    const offset = eye.clone().sub(target);
    goal.distance = Math.max(offset.length(), around.radius * 1e-3);
    offset.divideScalar(goal.distance).applyQuaternion(level);
    goal.pitch = Math.asin(clamp(offset.y, -1, 1));
    goal.yaw = Math.atan2(offset.x, offset.z);
    goal.target.copy(target);
    goal.roll = 0;
  };
  const setDistance = (distance: number): void => {
    goal.distance = clamp(distance, around.radius * 0.02, around.radius * 12);
  };
  /** The camera's own sideways and up, for panning. */
  const sideways = (): [Vector3, Vector3] => {
    const back = direction(goal);
    const right = new Vector3().crossVectors(around.up, back).normalize();
    return [right, new Vector3().crossVectors(back, right)];
  };
  const pan = (right: number, up: number): void => {
    const [across, upwards] = sideways();
    goal.target.addScaledVector(across, right).addScaledVector(upwards, up);
    const away = goal.target.clone().sub(around.centre);
    if (away.length() > 2 * around.radius) goal.target.copy(around.centre).add(away.setLength(2 * around.radius));
  };
  const tangent = (): number => {
    const { x, y } = around.tangents;
    return around.framed && fillsHeight(aspect) ? Math.min(y, x / aspect) : Math.max(y, x / aspect);
  };
  /** Moves by the part of a step that is left of it: beyond the captured views each step outwards is worth less. */
  const resisted = (move: (part: number) => void): void => {
    const before = { ...goal, target: goal.target.clone() };
    const reached = (part: number): number => {
      Object.assign(goal, before, { target: before.target.clone() });
      move(part);
      return around.beyond(eyeOf(goal), goal.target);
    };
    const from = around.beyond(eyeOf(goal), goal.target);
    const to = reached(1);
    if (to <= from) return;
    const allowed = GIVE * Math.log(Math.exp(from / GIVE) + (to - from) / GIVE);
    let [low, high] = [0, 1];
    for (let i = 0; i < HALVINGS; i++) {
      const part = (low + high) / 2;
      if (reached(part) < allowed) low = part;
      else high = part;
    }
    reached(low);
  };
  const turn = (right: number, up: number): void => {
    goal.yaw += right;
    goal.pitch = clamp(goal.pitch + up, -STEEPEST, STEEPEST);
  };
  const surface = (camera: PerspectiveCamera, at: Vector2): Vector3 | null => {
    ray.setFromCamera(at, camera);
    return ray.intersectObject(object, true)[0]?.point ?? null;
  };

  return {
    enter: (camera, look) => {
      const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld);
      ray.setFromCamera(look, camera);
      const along = ray.ray.direction.clone();
      const depth = around.focus ? around.focus.clone().sub(eye).dot(along) : 0;
      const hit = depth > 0 ? eye.clone().addScaledVector(along, depth) : surface(camera, look);
      aimed(eye, hit ?? eye.clone().addScaledVector(along, Math.max(eye.distanceTo(around.centre), 1e-3)));
      settle();
      const [, upwards] = sideways();
      const own = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1).projectOnPlane(along).normalize();
      const turned = new Vector3().crossVectors(upwards, own).dot(direction(place));
      place.roll = upwards.angleTo(own) * Math.sign(turned);
    },
    aim: (camera, at) => {
      const hit = surface(camera, at);
      if (hit) aimed(eyeOf(goal), hit);
    },
    set: (eye, target) => {
      aimed(eye, target);
      settle();
    },
    pose: () => ({ eye: eyeOf(place), target: place.target.clone() }),
    grab: () => {},
    drag: (dx, dy, panning) => {
      if (panning) {
        const size = 2 * goal.distance * Math.min(tangent(), tangent() * aspect);
        resisted((part) => pan(-dx * size * part, dy * size * part));
      } else {
        resisted((part) => turn(-dx * TURN * part, dy * TURN * part));
      }
    },
    release: () => {},
    push: (wish: Push, seconds: number) => {
      resisted((part) => turn(wish.x * seconds * part, wish.y * seconds * part));
      setDistance(goal.distance * Math.exp(-(wish.closer + wish.forward) * seconds));
    },
    closer: (factor) => setDistance(goal.distance / factor),
    forward: (amount) => setDistance(goal.distance * (1 - amount)),
    step: (seconds) => {
      const near = 1e-4;
      place.yaw = approach(place.yaw, goal.yaw, seconds, SMOOTH, near);
      place.pitch = approach(place.pitch, goal.pitch, seconds, SMOOTH, near);
      place.roll = approach(place.roll, goal.roll, seconds, 2 * SMOOTH, near);
      place.distance = approach(place.distance, goal.distance, seconds, SMOOTH, near * goal.distance);
      const part = approach(1, 0, seconds, SMOOTH, 0);
      const left = place.target.distanceTo(goal.target) * part;
      if (left < near * around.radius) place.target.copy(goal.target);
      else place.target.lerp(goal.target, 1 - part);
      return (
        place.yaw !== goal.yaw || place.pitch !== goal.pitch || place.roll !== goal.roll ||
        place.distance !== goal.distance || !place.target.equals(goal.target)
      );
    },
    place: (camera, ratio) => {
      aspect = ratio;
      camera.position.copy(eyeOf(place));
      camera.up.copy(around.up);
      camera.lookAt(place.target);
      camera.rotateZ(place.roll);
      camera.near = Math.max(place.distance - 3 * around.radius, place.distance * 0.01);
      camera.far = place.distance + 20 * around.radius;
      camera.fov = 2 * MathUtils.radToDeg(Math.atan(tangent()));
      camera.aspect = ratio;
      camera.zoom = 1;
      camera.view = null;
      camera.updateProjectionMatrix();
      camera.updateMatrixWorld(true);
      return WHOLE;
    },
    beyond: () => around.beyond(eyeOf(place), place.target),
  };
}
