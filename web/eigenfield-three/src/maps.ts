import { ClampToEdgeWrapping, DataArrayTexture, DataUtils, HalfFloatType, LinearFilter, RGBAFormat } from "three";
import { MAP_SIDE, groupsOf } from "./memory.js";
import type { Mixing, ViewWeights } from "./weights.js";

/**
 * Weights of eigen textures over X, Y in -1..1 at MAP_SIDE x MAP_SIDE nodes, those on the rim at -1 and 1, as half
 * floats, four to a layer. `omega` is (encoded cameras) x (textures of all bases, `counts`); of each basis the first
 * `usable` are wanted, and begin with a layer.
 */
export function makeMaps(
  weights: ViewWeights,
  mixing: Mixing,
  omega: Float32Array,
  counts: number[],
  usable: number,
): DataArrayTexture {
  const total = counts.reduce((a, b) => a + b, 0);
  const places: [number, number][] = []; // column of omega, slot of the maps
  let [column, layers] = [0, 0];
  for (const count of counts) {
    const used = Math.min(count, usable);
    for (let j = 0; j < used; j++) places.push([column + j, 4 * layers + j]);
    column += count;
    layers += used ? groupsOf(used) : 0;
  }
  const data = new Uint16Array(Math.max(1, layers) * MAP_SIDE * MAP_SIDE * 4);
  for (let row = 0; row < MAP_SIDE; row++) {
    for (let column = 0; column < MAP_SIDE; column++) {
      const { camera, weight } = weights.at((2 * column) / (MAP_SIDE - 1) - 1, (2 * row) / (MAP_SIDE - 1) - 1, mixing);
      const [a, b, c, d] = [camera[0] * total, camera[1] * total, camera[2] * total, camera[3] * total];
      const [p, q, r, s] = weight;
      for (const [j, slot] of places) {
        const value =
          p * (omega[a + j] ?? 0) + q * (omega[b + j] ?? 0) + r * (omega[c + j] ?? 0) + s * (omega[d + j] ?? 0);
        data[4 * (((slot >> 2) * MAP_SIDE + row) * MAP_SIDE + column) + (slot & 3)] = DataUtils.toHalfFloat(value);
      }
    }
  }
  const texture = new DataArrayTexture(data, MAP_SIDE, MAP_SIDE, Math.max(1, layers));
  texture.format = RGBAFormat;
  texture.type = HalfFloatType;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
  texture.needsUpdate = true;
  return texture;
}
