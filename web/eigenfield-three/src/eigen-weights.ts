// Weights of the eigen textures for a place of the view plane: those of the encoded cameras, by their view weights.

import type { DataArrayTexture } from "three";
import { planeCoordinates, type SceneInfo } from "./info.js";
import { makeMaps } from "./maps.js";
import type { Mixing, ViewWeights } from "./weights.js";

export class EigenWeights {
  private readonly total: number; // columns: eigen textures of all bases
  private readonly rowOf: Int32Array; // of each camera among the encoded, -1 if it is held out
  private made: { texture: DataArrayTexture; mixing: Mixing; usable: number } | null = null;

  /** `omega`: (encoded cameras) x (eigen textures of all bases); `counts`: eigen textures of each basis. */
  constructor(
    private readonly info: SceneInfo,
    private readonly counts: number[],
    private readonly omega: Float32Array,
    private readonly views: ViewWeights,
  ) {
    this.total = counts.reduce((a, b) => a + b, 0);
    let row = 0;
    this.rowOf = Int32Array.from(info.heldOut, (out) => (out ? -1 : row++));
  }

  /** Over the encoded cameras. */
  viewsAt(x: number, y: number, mixing: Mixing): Float64Array {
    const weights = new Float64Array(this.views.places.length / 2);
    const { camera, weight } = this.views.at(x, y, mixing);
    camera.forEach((index, i) => (weights[index] = (weights[index] ?? 0) + (weight[i] ?? 0)));
    return weights;
  }

  at(x: number, y: number, mixing: Mixing): Float64Array {
    const { camera, weight } = this.views.at(x, y, mixing);
    const mixed = new Float64Array(this.total);
    for (let i = 0; i < 4; i++) {
      const part = weight[i] ?? 0;
      if (!part) continue;
      const row = (camera[i] ?? 0) * this.total;
      for (let j = 0; j < this.total; j++) mixed[j] = (mixed[j] ?? 0) + part * (this.omega[row + j] ?? 0);
    }
    return mixed;
  }

  /** A captured camera's own, or if it was held out those of its place. */
  ofCamera(index: number, mixing: Mixing): Float64Array {
    const row = this.rowOf[index] ?? -1;
    if (row >= 0) return Float64Array.from(this.omega.subarray(row * this.total, (row + 1) * this.total));
    const camera = this.info.cameras[index];
    if (!camera) throw new RangeError(`no camera ${index}`);
    return this.at(...planeCoordinates(this.info.viewPlane, camera.centre), mixing);
  }

  /** Those of the first `usable` textures of each basis, over the whole view plane. */
  maps(mixing: Mixing, usable: number): DataArrayTexture {
    if (this.made?.mixing === mixing && this.made.usable === usable) return this.made.texture;
    this.dispose();
    const texture = makeMaps(this.views, mixing, this.omega, this.counts, usable);
    this.made = { texture, mixing, usable };
    return texture;
  }

  dispose(): void {
    this.made?.texture.dispose();
  }
}
