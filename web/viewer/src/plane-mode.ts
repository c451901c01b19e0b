// The eye on the view plane, where the paper's weights are right: sideways and up within the array, with a soft stop at
// its edge, closer by cropping, and off the plane by a part of the scene's distance.

import type { PerspectiveCamera } from "three";
import { novelCamera, placeCamera } from "eigenfield-three";
import type { CaptureCamera, EigenField, Frame, Vector } from "eigenfield-three";
import { add, dot, scaled, turned } from "./geometry";
import { approach, clamp, fillsHeight, type Mode, type Push } from "./mode";

const SPAN = 2.6; // view-plane units that a drag across the smaller side of the canvas moves
const GIVE = 0.14; // how far beyond the edge a hand can pull
const SPEED = 1.1; // view-plane units a second, keys and sticks
const LARGEST = 8;
const SMOOTH = 0.07; // seconds
const BACK = -0.6; // how far back, in parts of the scene's distance
const NEAREST = 0.6; // how far forward, in parts of the distance of the nearest surface

export interface PlaneMode extends Mode {
  at(): { x: number; y: number; zoom: number; dolly: number };
  /** Where the eye is on the way to. */
  goal(): { x: number; y: number };
  goTo(x: number, y: number, jump?: boolean): void;
  setZoom(zoom: number): void;
  setDolly(dolly: number): void;
}

/** aspect: of the canvas. */
export function createPlaneMode(field: EigenField, aspect: number): PlaneMode {
  const { viewPlane } = field.info;
  const line = viewPlane.extent[1] === 0;
  const place = { x: 0, y: 0, zoom: 1, dolly: 0 }; // what is drawn
  const goal = { x: 0, y: 0, zoom: 1, dolly: 0 };
  const depth = depths(field);
  const furthest = (NEAREST * depth.nearest) / depth.middle;
  let held = false;
  let pushed = false;

  const setGoal = (x: number, y: number, reach: number): void => {
    goal.x = clamp(x, -reach, reach);
    goal.y = line ? 0 : clamp(y, -reach, reach);
  };
  const setDolly = (dolly: number): void => void (goal.dolly = clamp(dolly, BACK, furthest));
  let cover = coverOf(novelCamera(field, 0, 0), aspect); // how much larger than whole the picture is at zoom 1
  const setZoom = (zoom: number): void => void (goal.zoom = clamp(zoom, 1 / cover, LARGEST));

  const view = (): CaptureCamera => {
    const x = clamp(place.x, -1, 1);
    const y = clamp(place.y, -1, 1);
    const camera = novelCamera(field, x, y);
    const off = add(
      add(
        scaled(viewPlane.right, (place.x - x) * viewPlane.extent[0]),
        scaled(viewPlane.up, (place.y - y) * viewPlane.extent[1]),
      ),
      scaled(depth.forward, place.dolly * depth.middle),
    );
    const centre = add(camera.centre, off);
    return { ...camera, centre, t: [...scaled(turned(camera.R, centre), -1)] };
  };

  return {
    at: () => ({ ...place }),
    goal: () => ({ x: goal.x, y: goal.y }),
    goTo: (x, y, jump = false) => {
      setGoal(x, y, 1);
      if (jump) Object.assign(place, goal);
    },
    setZoom,
    setDolly,
    grab: () => void (held = true),
    drag: (dx, dy) => setGoal(goal.x - dx * SPAN, goal.y + dy * SPAN, 3),
    release: () => {
      held = false;
      setGoal(goal.x, goal.y, 1);
    },
    push: (wish: Push, seconds: number) => {
      const pace = SPEED * seconds;
      setGoal(goal.x + wish.x * pace, goal.y + wish.y * pace, 1 + 2 * GIVE);
      setZoom(goal.zoom * Math.exp(wish.closer * seconds));
      setDolly(goal.dolly + 0.4 * wish.forward * seconds);
      pushed = wish.x !== 0 || wish.y !== 0;
    },
    closer: (factor) => setZoom(goal.zoom * factor),
    forward: (amount) => setDolly(goal.dolly + amount),
    step: (seconds) => {
      setZoom(goal.zoom); // a device that was turned has another limit
      if (!held && !pushed) setGoal(goal.x, goal.y, 1);
      pushed = false;
      place.x = approach(place.x, soft(goal.x), seconds, SMOOTH, 2e-4);
      place.y = approach(place.y, soft(goal.y), seconds, SMOOTH, 2e-4);
      place.zoom = approach(place.zoom, goal.zoom, seconds, SMOOTH, 1e-3);
      place.dolly = approach(place.dolly, goal.dolly, seconds, SMOOTH, 2e-4);
      return (
        place.x !== soft(goal.x) || place.y !== soft(goal.y) || place.zoom !== goal.zoom || place.dolly !== goal.dolly
      );
    },
    place: (camera: PerspectiveCamera, aspect: number): Frame => {
      const seen = view();
      cover = coverOf(seen, aspect);
      return placeCamera(field, camera, seen, aspect, cover * place.zoom);
    },
    beyond: () => 0,
  };
}

const coverOf = ({ width, height }: CaptureCamera, aspect: number): number =>
  fillsHeight(aspect) ? Math.max(1, width / height / aspect) : 1;

/** A rubber band: as it is within the array, and never more than GIVE beyond its edge. */
export function soft(value: number): number {
  const over = Math.abs(value) - 1;
  return over <= 0 ? value : Math.sign(value) * (1 + GIVE * (1 - Math.exp(-over / (2 * GIVE))));
}

/** How far the surface lies in front of the view plane, and which way that is. */
function depths(field: EigenField): { forward: Vector; nearest: number; middle: number } {
  const { normal, origin } = field.info.viewPlane;
  const forward = scaled(normal, -1);
  const position = field.mesh.geometry.getAttribute("position");
  const step = Math.max(1, Math.floor(position.count / 20000));
  const found: number[] = [];
  for (let i = 0; i < position.count; i += step) {
    const vertex: Vector = [position.getX(i), position.getY(i), position.getZ(i)];
    found.push(dot(add(vertex, scaled(origin, -1)), forward));
  }
  const before = found.filter((value) => value > 0).sort((a, b) => a - b);
  const quantile = (part: number): number => before[Math.floor(part * (before.length - 1))] ?? 1;
  return { forward, nearest: quantile(0.01), middle: quantile(0.5) };
}
