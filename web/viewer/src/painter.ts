// One frame: which camera sees it, with what weights, and what lies over it.

import { type EigenField, type Frame, placeCamera } from "eigenfield-three";
import type { SecondScene } from "./beside";
import type { Captured } from "./captured";
import { WHOLE } from "./mode";
import type { Detail } from "./pace";
import type { Places } from "./places";
import type { Session } from "./session";
import type { Stage } from "./stage";

const FADED = 0.3; // radians beyond the captured views where the picture is most blurred

export interface Painter {
  draw(detail: Detail): void;
  /** Where the captured picture lies in the canvas. */
  frame(): Frame;
}

export function createPainter(
  session: Session,
  stage: Stage,
  places: Places,
  captured: Captured,
  beside: SecondScene,
): Painter {
  let frame = WHOLE;

  /** 0 among the captured views, 1 where nothing of them is left. */
  const blurred = (): number => {
    const part = Math.min(places.beyond() / FADED, 1);
    return part * part * (3 - 2 * part);
  };
  const place = (): Frame => {
    const field = session.scene?.field;
    const view = session.captured === null ? undefined : field?.info.cameras[session.captured];
    if (field && view) return placeCamera(field, stage.camera, view, stage.aspect());
    return places.mode()?.place(stage.camera, stage.aspect()) ?? WHOLE;
  };
  return {
    frame: () => frame,
    draw: ({ scale, linear }) => {
      stage.setScale(scale);
      frame = place();
      const picture = captured.picture();
      const { scene, options } = session;
      // On the plane both ways mean the same; one set of weights needs no map and is the paper's to the last digit.
      const onPlane = session.mode === "plane" && scene?.plane?.at().dolly === 0;
      const set = (field: EigenField, captured: number | null): void => {
        field.camera = captured;
        field.exposure = captured;
        field.count = options.count;
        field.eigen = options.eigen;
        field.mixing = options.mixing;
        field.filter = linear ? "bilinear" : options.filter;
        field.coarser = scale > 0.7 ? 1 : scale > 0.3 ? 2 : 4;
        field.photograph = picture;
        field.view = options.view === "error" && !picture ? "picture" : options.view;
        field.weightMode = onPlane || !field.info.facesPlane ? "eye" : options.weights;
      };
      if (scene?.field) set(scene.field, session.captured);
      const second = session.beside?.scene;
      if (second?.field) {
        const index = second.field.info.names.indexOf(scene?.field?.info.names[session.captured ?? -1] ?? "");
        set(second.field, index < 0 ? null : index);
      }
      // Beside the frame the surface was seen by few cameras, and ends raggedly.
      if (session.photographShown && picture) stage.compare(frame, picture, options.divider);
      else if (second && options.divider !== null) {
        beside.keepStep();
        stage.split(frame, options.divider, (camera) => beside.place(camera, frame));
      }
      else stage.draw(frame === WHOLE ? null : frame, session.fades ? blurred() : 0);
    },
  };
}
