// What the file says about itself: its bytes with n eigen textures, and how near it comes to its photographs.

import type { SceneInfo } from "eigenfield-three";
import { figure } from "./text";

/** Everything but the eigen textures, and the first n of those. */
export function bytesWith(info: SceneInfo, count: number): number {
  const { total, textures } = info.bytes;
  const sum = (sizes: readonly number[]): number => sizes.reduce((a, b) => a + b, 0);
  return total - sum(textures.slice(Math.min(count, textures.length)));
}

/** UV SSIM with n eigen textures: from the file's curve, or the one figure it has for all of them. */
export function uvSsim(info: SceneInfo, count: number): number | null {
  const { curve } = info.scores as { curve?: unknown };
  if (Array.isArray(curve)) {
    const point: unknown = curve.find((entry) => figure(entry, "textures") === count);
    const value = figure(point, "uv_ssim");
    if (value !== null) return value;
  }
  return figure(info.scores, "textures") === count ? figure(info.scores, "uv", "ssim") : null;
}
