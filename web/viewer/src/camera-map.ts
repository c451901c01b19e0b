// The array from behind: captured cameras, and where the eye is. A click or a drag goes there.

import type { SceneInfo } from "eigenfield-three";
import { element } from "./dom";
import { words } from "./language";
import { clamp } from "./mode";
import type { Viewer } from "./viewer";

const SIDE = 132; // CSS pixels of the longer side
const SMALL_SIDE = 96; // where the window is narrow
const NARROW = "(max-width: 720px)";
const MARGIN = 12;
const SMALLEST = 44;

export interface CameraMap {
  readonly root: HTMLElement;
  update(): void;
}

export function createCameraMap(viewer: Viewer): CameraMap {
  const canvas = element("canvas");
  const root = element(
    "div",
    { class: "map", role: "img", "aria-label": words("map") },
    canvas,
  );
  const size = { width: SIDE, height: SIDE };
  let shown: SceneInfo | null = null;
  let drawn = ""; // what the picture shows: it is drawn anew only when that changes

  const fit = (): void => {
    const extent = viewer.scene()?.field?.info.viewPlane.extent ?? [1, 1];
    const side = matchMedia(NARROW).matches ? SMALL_SIDE : SIDE;
    const longer = Math.max(...extent, 1e-12);
    size.width = Math.max(SMALLEST, (extent[0] / longer) * (side - 2 * MARGIN) + 2 * MARGIN);
    size.height = Math.max(SMALLEST, (extent[1] / longer) * (side - 2 * MARGIN) + 2 * MARGIN);
  };
  const placed = (x: number, y: number): [number, number] => [
    size.width / 2 + (x * (size.width - 2 * MARGIN)) / 2,
    size.height / 2 - (y * (size.height - 2 * MARGIN)) / 2,
  ];

  const draw = (): void => {
    const info = viewer.scene()?.field?.info;
    if (!info) return;
    const eye = viewer.coordinates();
    const captured = viewer.captured();
    const ratio = Math.min(devicePixelRatio, 2);
    const key = [eye.x.toFixed(3), eye.y.toFixed(3), captured, ratio].join();
    if (info !== shown) drawn = "";
    shown = info;
    if (key === drawn) return;
    drawn = key;
    fit();
    canvas.width = Math.round(size.width * ratio);
    canvas.height = Math.round(size.height * ratio);
    canvas.style.width = `${size.width}px`;
    canvas.style.height = `${size.height}px`;
    const pen = canvas.getContext("2d");
    if (!pen) return;
    pen.scale(ratio, ratio);
    const { origin, right, up, extent } = info.viewPlane;
    const radius = info.cameras.length > 150 ? 1.3 : 2;
    info.cameras.forEach((camera, i) => {
      const offset = camera.centre.map((value, axis) => value - (origin[axis] ?? 0));
      const along = (axis: readonly number[], half: number): number =>
        half > 0 ? axis.reduce((sum, value, k) => sum + value * (offset[k] ?? 0), 0) / half : 0;
      const [x, y] = placed(along(right, extent[0]), along(up, extent[1]));
      pen.fillStyle = info.heldOut[i] === true ? "#e5a14b" : "#b4bac3";
      pen.beginPath();
      pen.arc(x, y, i === captured ? radius + 1.5 : radius, 0, 2 * Math.PI);
      pen.fill();
    });
    const [eyeX, eyeY] = placed(eye.x, eye.y);
    const [x, y] = [clamp(eyeX, 7, size.width - 7), clamp(eyeY, 7, size.height - 7)];
    pen.beginPath();
    pen.arc(x, y, 5, 0, 2 * Math.PI);
    pen.strokeStyle = "#10131a";
    pen.lineWidth = 4;
    pen.stroke();
    pen.strokeStyle = "#6cb2ff";
    pen.lineWidth = 2;
    pen.stroke();
  };

  const go = (event: PointerEvent): void => {
    const box = canvas.getBoundingClientRect();
    const x = ((event.clientX - box.left - size.width / 2) / (size.width - 2 * MARGIN)) * 2;
    const y = ((event.clientY - box.top - size.height / 2) / (size.height - 2 * MARGIN)) * -2;
    viewer.goTo(clamp(x, -1, 1), clamp(y, -1, 1));
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    go(event);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (canvas.hasPointerCapture(event.pointerId)) go(event);
  });

  return {
    root,
    update: () => {
      root.hidden = !viewer.scene()?.field;
      draw();
    },
  };
}
