// Means and bases as compose.glsl takes them: where they lie, and the numbers that make values of what is stored.

import type { Texture } from "three";
import type { SceneDocument } from "./document.js";
import { groupsOf, type Plan } from "./memory.js";
import { FINE } from "./packing-shaders.js";
import { hasTenBits, unitOf, type Picture, type Still } from "./planes.js";
import type { Textures } from "./textures.js";

/** A mean, or the textures of a basis. */
export interface Part {
  stored: Texture;
  grid: [number, number];
  rectangle: [number, number, number, number]; // of the grid: left, top, right, bottom in 0..1
  colours: [number, number, number][]; // of the value 1 of each channel
  // Four numbers for each channel of each group of textures: value = stored * scale + bias. Stored are codes over
  // the largest, or as half-floats the codes, or of a mean with a precision what packing.ts makes of them.
  // In words a texture makes a group of its own, and its code's bytes are the first two of the four.
  scale: Float32Array;
  bias: Float32Array;
  words: boolean;
  basis: BasisPart | null; // null: a mean
}

interface BasisPart {
  ready: boolean[];
  column: number; // of its first texture in the weights
  group: number; // its first layer in the maps of weights
}

/** All parts of a scene, of each basis as many textures as the plan has room for. */
export function partsOf(scene: SceneDocument, textures: Textures, plan: Plan): Part[] {
  const parts: Part[] = [];
  let [channel, number, column, group] = [0, 0, 0, 0];
  const { words } = plan;
  scene.planes.forEach((plane, i) => {
    const { channels, bases } = plane;
    const colours = scene.colours.slice(channel, channel + channels);
    channel += channels;
    const grid = textures.needs.means[i]?.size ?? [1, 1];
    const stored = textures.means[i];
    const numbers = words ? wordNumbers([plane.mean]) : meanNumbers(plane);
    if (stored) parts.push({ stored, grid, rectangle: [0, 0, 1, 1], colours, ...numbers, words, basis: null });
    for (const { size, grid, corner, pictures, count } of bases) {
      const stored = textures.bases[number];
      const ready = textures.ready[number++] ?? [];
      const used = Math.min(count, plan.usable);
      if (used && stored) {
        const [left, top] = [corner[0] / grid[0], corner[1] / grid[1]];
        parts.push({
          stored,
          grid,
          rectangle: [left, top, left + size[0] / grid[0], top + size[1] / grid[1]],
          colours,
          ...(words ? wordNumbers(pictures) : basisNumbers(pictures, channels, used, plan.halves && hasTenBits(pictures))),
          words,
          basis: { ready, column, group },
        });
      }
      column += count;
      group += used ? groupsOf(used) : 0;
    }
  });
  return parts;
}

/** Gives parts the numbers that the pictures of their scene have now. */
export function rescale(parts: Part[], scene: SceneDocument, textures: Textures, plan: Plan): void {
  partsOf(scene, textures, plan).forEach(({ scale, bias }, i) => Object.assign(parts[i] ?? {}, { scale, bias }));
}

/** The opacity of sheets, as a mean whose only channel is R. */
export function opacityPart({ planes, sheets }: SceneDocument, { means, needs }: Textures, { words }: Plan): Part | null {
  const stored = means[planes.length];
  const grid = needs.means[planes.length]?.size;
  if (!sheets || !stored || !grid) return null;
  const numbers = words ? wordNumbers([sheets.opacity.mean]) : meanNumbers(sheets.opacity);
  return { stored, grid, rectangle: [0, 0, 1, 1], colours: [[1, 0, 0]], ...numbers, words, basis: null };
}

type Numbers = Pick<Part, "scale" | "bias">;

/** Of a mean channel c is component c % 4, so that three of four scales are zero; grey pictures are the first. */
function meanNumbers({ mean, channels, precision }: Still): Numbers {
  const { scale, zero } = mean;
  const unit = precision ? FINE : 1 / unitOf(mean, hasTenBits([mean]));
  const numbers = { scale: new Float32Array(4 * channels), bias: new Float32Array(4 * channels) };
  for (let channel = 0; channel < channels; channel++) {
    const at = 4 * channel + (channel % 4);
    numbers.scale[at] = unit * (scale[channel] ?? 0);
    numbers.bias[at] = precision ? 0 : -(zero[channel] ?? 0) * (scale[channel] ?? 0);
  }
  return numbers;
}

/** Of each channel of each texture; stored are bytes / 255. */
function wordNumbers(pictures: Picture[]): Numbers {
  const scale = pictures.flatMap((picture) => picture.scale);
  const zero = pictures.flatMap((picture) => picture.zero);
  return {
    scale: Float32Array.from(scale.flatMap((own) => [255 * own, 255 * 256 * own, 0, 0])),
    bias: Float32Array.from(scale.flatMap((own, i) => [-(zero[i] ?? 0) * own, 0, 0, 0])),
  };
}

function basisNumbers(pictures: Picture[], channels: number, used: number, halves: boolean): Numbers {
  const units = pictures.flatMap((picture) => Array<number>(picture.textures).fill(unitOf(picture, halves)));
  const scale = pictures.flatMap((picture) => picture.scale);
  const zero = pictures.flatMap((picture) => picture.zero);
  const length = 4 * channels * groupsOf(used);
  const numbers = { scale: new Float32Array(length), bias: new Float32Array(length) };
  for (let j = 0; j < used; j++) {
    for (let channel = 0; channel < channels; channel++) {
      const at = 4 * (channels * Math.floor(j / 4) + channel) + (j % 4);
      const own = scale[channels * j + channel] ?? 0;
      numbers.scale[at] = own / (units[j] ?? 1);
      numbers.bias[at] = -(zero[channels * j + channel] ?? 0) * own;
    }
  }
  return numbers;
}
