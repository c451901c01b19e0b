// Mouse, pen and fingers on the canvas.

import { Vector2 } from "three";
import type { Mode } from "./mode";
import type { Viewer } from "./viewer";

const WHEEL = 0.0015; // factor a pixel of scrolling
const DOLLY = 0.0006; // part of the scene's distance a pixel of scrolling

export function listenToPointers(viewer: Viewer): void {
  const { canvas } = viewer.stage;
  const down = new Map<number, { x: number; y: number }>();
  let grabbed: Mode | null = null; // which a key may have changed since for another one
  const side = (): number => Math.max(Math.min(canvas.clientWidth, canvas.clientHeight), 1);
  const spread = (): number => {
    const [a, b] = [...down.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  };

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    viewer.hold();
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = down.get(event.pointerId);
    if (!last) return;
    const before = spread();
    const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
    if (dx === 0 && dy === 0) return;
    Object.assign(last, { x: event.clientX, y: event.clientY });
    const mode = viewer.moving(); // only now: a mere click does not leave a captured camera
    if (mode !== grabbed) grabbed?.release();
    grabbed = mode;
    mode?.grab();
    const panning = event.pointerType !== "touch" && ((event.buttons & 6) !== 0 || event.shiftKey);
    mode?.drag(dx / side() / down.size, dy / side() / down.size, panning || down.size > 1);
    const after = spread();
    if (before > 0 && after > 0) mode?.closer(after / before);
  });
  const up = (event: PointerEvent): void => {
    if (!down.delete(event.pointerId) || down.size > 0) return;
    grabbed?.release();
    grabbed = null;
    if (viewer.captured() === null) viewer.moving(); // a mere click does not leave a captured camera
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());

  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1;
      const by = (event.deltaY || event.deltaX) * lines; // with Shift some browsers scroll sideways
      if (event.shiftKey) viewer.moving()?.forward(-by * DOLLY);
      else viewer.moving()?.closer(Math.exp(-by * WHEEL));
    },
    { passive: false },
  );
  canvas.addEventListener("dblclick", (event) => {
    const scene = viewer.scene();
    if (!scene || viewer.moving() !== scene.orbit) return;
    const box = canvas.getBoundingClientRect();
    const at = new Vector2(
      (2 * (event.clientX - box.left)) / box.width - 1,
      1 - (2 * (event.clientY - box.top)) / box.height,
    );
    scene.orbit.aim(viewer.stage.camera, at);
  });
}
