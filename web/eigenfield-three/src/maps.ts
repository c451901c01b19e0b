import { ClampToEdgeWrapping, DataArrayTexture, DataUtils, HalfFloatType, LinearFilter, RGBAFormat } from "three";
import { MAP_SIDE } from "./memory.js";
import type { Mixing, ViewWeights } from "./weights.js";

/**
 * Weights of eigen textures over X, Y in -1..1 at MAP_SIDE x MAP_SIDE nodes, those on the rim at -1 and 1, as half
 * floats: layer g holds weights 4 g to 4 g + 3. `omega` is (encoded cameras) x `total`; `count` of them are wanted.
 */
export function makeMaps(
  weights: ViewWeights,
  mixing: Mixing,
  omega: Float32Array,
  total: number,
  count: number,
): DataArrayTexture {
  const layers = Math.max(1, Math.ceil(count / 4));
  const data = new Uint16Array(layers * MAP_SIDE * MAP_SIDE * 4);
  for (let row = 0; row < MAP_SIDE; row++) {
    for (let column = 0; column < MAP_SIDE; column++) {
      const { camera, weight } = weights.at((2 * column) / (MAP_SIDE - 1) - 1, (2 * row) / (MAP_SIDE - 1) - 1, mixing);
      const [a, b, c, d] = [camera[0] * total, camera[1] * total, camera[2] * total, camera[3] * total];
      const [p, q, r, s] = weight;
      for (let j = 0; j < count; j++) {
        const value =
          p * (omega[a + j] ?? 0) + q * (omega[b + j] ?? 0) + r * (omega[c + j] ?? 0) + s * (omega[d + j] ?? 0);
        data[4 * (((j >> 2) * MAP_SIDE + row) * MAP_SIDE + column) + (j & 3)] = DataUtils.toHalfFloat(value);
      }
    }
  }
  const texture = new DataArrayTexture(data, MAP_SIDE, MAP_SIDE, layers);
  texture.format = RGBAFormat;
  texture.type = HalfFloatType;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
  texture.needsUpdate = true;
  return texture;
}
