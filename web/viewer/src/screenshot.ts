// The picture as it is on the screen, as a PNG file.

import { save } from "./download";
import type { Viewer } from "./viewer";

export function saveScreenshot(viewer: Viewer): void {
  const scene = viewer.scene();
  if (!scene) return;
  viewer.drawNow(); // in this task: the canvas is empty once the browser has shown it
  const { x, y } = viewer.coordinates();
  const captured = viewer.captured();
  const place = captured === null ? `${x.toFixed(2)} ${y.toFixed(2)}` : scene.field?.info.names[captured];
  const name = `${scene.source.name} ${place ?? ""}`.replaceAll(/[^\p{L}\p{N}._+-]+/gu, "-").slice(0, 100);
  viewer.stage.canvas.toBlob((blob) => {
    if (blob) save(blob, `${name}.png`);
  }, "image/png");
}
