// Looking through the captured cameras, and at the photographs that they took.

import type { Texture } from "three";
import { type CameraOrder, inOrder } from "./camera-order";
import type { Photographs } from "./photographs";
import type { Places } from "./places";
import type { Scene, Session } from "./session";

export interface Captured {
  to(index: number): void;
  /** Back to a free view: what is shown of a captured camera ends with it. */
  leave(): void;
  /** From a free view to the nearest camera; from a camera to the next one, in the order of the list. */
  next(step: number): void;
  nearest(): void;
  /** Name of the camera that is looked through, else of the nearest. */
  nearestName(): string | null;
  order(): CameraOrder;
  /** Of the camera that is looked through, else of the nearest. */
  hasPhotograph(): boolean;
  showPhotograph(shown: boolean): void;
  /** Goes where there is a photograph to compare with, or gives the view "error" up. */
  findError(): void;
  /** The photograph that this frame needs, if it is here. */
  picture(): Texture | null;
}

export function createCaptured(
  session: Session,
  places: Places,
  photographs: Photographs,
  changed: () => void,
): Captured {
  let known: { scene: Scene; order: CameraOrder } | null = null;

  const nameOf = (index: number | null): string | null =>
    index === null ? null : (session.scene?.field?.info.names[index] ?? null);
  const has = (index: number | null): boolean => {
    const name = nameOf(index);
    return name !== null && session.scene?.source.own === true && photographs.has(name);
  };
  const hasPhotograph = (): boolean => has(session.captured ?? places.nearest());
  const to = (index: number): void => {
    const { scene } = session;
    const view = scene?.field?.info.cameras[index];
    if (!scene || !view) return;
    session.captured = index;
    const { x, y } = places.dropped(view.centre);
    scene.plane?.goTo(x, y, true);
    scene.plane?.setDolly(0);
    scene.plane?.setZoom(1);
    scene.plane?.step(10);
    if (!has(index)) {
      session.photographShown = false;
      if (session.options.view === "error") session.options.view = "picture";
    }
    changed();
  };
  const nearest = (): void => {
    const index = places.nearest();
    if (index !== null) to(index);
  };
  const order = (): CameraOrder => {
    const { scene } = session;
    if (!scene?.field) return [];
    if (known?.scene !== scene) known = { scene, order: inOrder(scene.field.info) };
    return known.order;
  };

  return {
    to,
    nearest,
    nearestName: () => nameOf(session.captured ?? places.nearest()),
    order,
    hasPhotograph,
    leave: () => {
      session.photographShown = false;
      session.captured = null;
      if (session.options.view === "error") session.options.view = "picture";
    },
    next: (step) => {
      if (session.captured === null) return nearest();
      const indices = order().flatMap((group) => group.indices);
      const index = indices[(indices.indexOf(session.captured) + step + indices.length) % indices.length];
      if (index !== undefined) to(index);
    },
    showPhotograph: (shown) => {
      if (shown && session.captured === null && has(places.nearest())) nearest();
      session.photographShown = shown && session.captured !== null && hasPhotograph();
      if (session.photographShown && session.options.view === "error") session.options.view = "picture";
      changed();
    },
    findError: () => {
      session.photographShown = false;
      if (session.captured === null && has(places.nearest())) nearest();
      if (!hasPhotograph()) session.options.view = "picture";
    },
    picture: () => {
      const name = nameOf(session.captured);
      const wanted = session.photographShown || session.options.view === "error";
      return name !== null && wanted && hasPhotograph() ? photographs.get(name) : null;
    },
  };
}
