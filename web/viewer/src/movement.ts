// Ways from one place to another: the hand's, the address's, the first view, between the modes, and back inside.

import { Vector2, Vector3 } from "three";
import type { Captured } from "./captured";
import type { Mode } from "./mode";
import type { Coordinates, Places } from "./places";
import type { ModeName, Session } from "./session";
import type { Stage } from "./stage";

export interface Movement {
  /** The mode that is to be moved; looking through a captured camera ends with it. */
  moving(): Mode | null;
  home(): void;
  setMode(next: ModeName): void;
  goTo(x: number, y: number): void;
  comeBack(): void;
}

const MIDDLE = new Vector2(); // of the canvas

/** start: the first view of the page's own scene, on the view plane; null: the reference camera's. */
export function createMovement(
  session: Session,
  stage: Stage,
  places: Places,
  captured: Captured,
  start: Coordinates | null,
  changed: () => void,
): Movement {
  const setMode = (next: ModeName): void => {
    const { scene } = session;
    if (!scene || (next === "plane" && !scene.plane)) return;
    if (next === session.mode && session.captured === null) return;
    const { x, y } = places.coordinates();
    if (next === "orbit") {
      if (session.captured !== null) places.stand(session.captured);
      scene.orbit.enter(stage.camera, MIDDLE);
    } else if (session.mode === "orbit") {
      scene.plane?.goTo(x, y, true);
      scene.plane?.setDolly(0);
    }
    captured.leave();
    session.mode = next;
    changed();
  };

  return {
    setMode,
    moving: () => {
      const { scene } = session;
      if (scene && session.captured !== null) {
        const index = session.captured;
        captured.leave();
        if (places.mode() === scene.orbit) scene.orbit.enter(places.stand(index), MIDDLE);
        changed();
      }
      return places.mode();
    },
    home: () => {
      const { scene } = session;
      if (!scene) return;
      captured.leave();
      const { field, plane, orbit, around } = scene;
      const first = scene.source.own ? start : null;
      if (!field) {
        const away = new Vector3(0.35, 0.25, 1).setLength(around.radius / Math.sin(Math.atan(around.tangents.y)));
        orbit.set(around.centre.clone().add(away), around.centre);
      } else if (plane) {
        session.mode = "plane";
        const { cameras, reference, viewPlane } = field.info;
        const { x, y } = first ?? places.dropped(cameras[reference]?.centre ?? viewPlane.origin);
        plane.goTo(x, y);
        plane.setDolly(0);
        plane.setZoom(1);
      } else {
        orbit.enter(places.stand((first && places.nearestTo(first)) ?? field.info.reference), MIDDLE);
        const { eye, target } = orbit.pose();
        orbit.set(eye, target); // upright, however the camera was held
      }
      changed();
    },
    goTo: (x, y) => {
      const { scene } = session;
      if (!scene?.field) return;
      captured.leave();
      if (scene.plane) {
        session.mode = "plane";
        scene.plane.goTo(x, y);
      } else {
        const nearest = places.nearestTo({ x, y });
        if (nearest !== null) captured.to(nearest);
      }
      changed();
    },
    comeBack: () => {
      const { scene } = session;
      if (scene?.plane) return setMode("plane");
      const nearest = places.nearest();
      if (scene?.field && nearest !== null) scene.orbit.enter(places.stand(nearest), MIDDLE);
      changed();
    },
  };
}
