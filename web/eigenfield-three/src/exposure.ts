// What gives a view the exposure that its cameras had: the scene holds gain * photograph + offset.

import type { CaptureCamera } from "./info.js";

/** Scale and bias of R, G and B for cameras that take part with weights; one without gain and offset changes nothing. */
export function exposureOf(parts: [CaptureCamera | undefined, number][]): { scale: number[]; bias: number[] } {
  const [scale, bias] = [
    [1, 1, 1],
    [0, 0, 0],
  ];
  for (const [camera, part] of parts) {
    if (!camera?.gain || !camera.offset) continue;
    for (let i = 0; i < 3; i++) {
      const factor = 1 / (camera.gain[i] ?? 1);
      scale[i] = (scale[i] ?? 1) + part * (factor - 1);
      bias[i] = (bias[i] ?? 0) - part * factor * (camera.offset[i] ?? 0);
    }
  }
  return { scale, bias };
}
