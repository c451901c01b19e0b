// Where the eye is: in space, on the view plane or dropped onto it, among the captured cameras, and outside them all.

import { type PerspectiveCamera, Vector3 } from "three";
import { placeCamera } from "eigenfield-three";
import { add, dot, scaled } from "./geometry";
import type { Mode } from "./mode";
import type { Session } from "./session";
import type { Stage } from "./stage";

export interface Coordinates {
  x: number;
  y: number;
}

export interface Places {
  /** The way of moving that is on. */
  mode(): Mode | null;
  /** X, Y of the eye on the view plane, or dropped onto it. */
  coordinates(): Coordinates;
  /** The same of a point of the capture's world. */
  dropped(point: readonly [number, number, number]): Coordinates;
  /** The captured camera nearest to the eye. */
  nearest(): number | null;
  /** The captured camera nearest to a place of the view plane. */
  nearestTo(at: Coordinates): number | null;
  /** Puts the stage's camera where a captured one stood. */
  stand(index: number): PerspectiveCamera;
  /** How far the eye is from the captured views, in radians; 0 among them. */
  beyond(): number;
}

export function createPlaces(session: Session, stage: Stage): Places {
  const cameras = () => session.scene?.field?.info.cameras ?? [];
  const mode = (): Mode | null => {
    const { scene } = session;
    return session.mode === "plane" && scene?.plane ? scene.plane : (scene?.orbit ?? null);
  };
  const eye = (): Vector3 | null => {
    const field = session.scene?.field;
    return field ? field.mesh.worldToLocal(new Vector3().setFromMatrixPosition(stage.camera.matrixWorld)) : null;
  };
  const dropped = (point: readonly [number, number, number]): Coordinates => {
    const plane = session.scene?.field?.info.viewPlane;
    if (!plane) return { x: 0, y: 0 };
    const offset = add(point, scaled(plane.origin, -1));
    const [width, height] = plane.extent;
    return {
      x: width > 0 ? dot(offset, plane.right) / width : 0,
      y: height > 0 ? dot(offset, plane.up) / height : 0,
    };
  };

  return {
    mode,
    dropped,
    coordinates: () => {
      const { scene, captured } = session;
      if (captured === null && session.mode === "plane" && scene?.plane) {
        const { x, y } = scene.plane.at();
        return { x, y };
      }
      const at = eye();
      return at ? dropped([at.x, at.y, at.z]) : { x: 0, y: 0 };
    },
    nearest: () => {
      const at = eye();
      return at && least(cameras().map(({ centre }) => at.distanceToSquared(new Vector3(...centre))));
    },
    nearestTo: ({ x, y }) =>
      least(cameras().map(({ centre }) => {
        const at = dropped(centre);
        return Math.hypot(at.x - x, at.y - y);
      })),
    stand: (index) => {
      const field = session.scene?.field;
      const view = cameras()[index];
      if (field && view) placeCamera(field, stage.camera, view, stage.aspect());
      return stage.camera;
    },
    beyond: () =>
      session.status === "ready" && session.scene?.field && session.captured === null ? (mode()?.beyond() ?? 0) : 0,
  };
}

/** Index of the smallest number, or null where there is none. */
function least(numbers: readonly number[]): number | null {
  return numbers.length === 0 ? null : numbers.indexOf(Math.min(...numbers));
}
