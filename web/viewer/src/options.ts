// What the panel, the keys and the address can set.

import type { Filter } from "eigenfield-three";

export const VIEWS = ["picture", "mean", "eigen", "error"] as const;
export const MIXINGS = ["delaunay", "bilinear", "nearest3"] as const;
export const BACKGROUNDS = ["#000000", "#15171a", "#6b6f76", "#ffffff"] as const;

export interface Options {
  view: (typeof VIEWS)[number];
  eigen: number; // which one the view "eigen" shows
  count: number; // eigen textures to sum; Infinity for all there are
  weights: "ray" | "eye";
  mixing: (typeof MIXINGS)[number];
  filter: Filter;
  wireframe: boolean;
  divider: number | null; // where a photograph begins beside the drawing, in parts of its width; null: there is none
  background: (typeof BACKGROUNDS)[number];
}

export const DEFAULTS: Options = {
  view: "picture",
  eigen: 0,
  count: Infinity,
  weights: "ray",
  mixing: "delaunay",
  filter: "bicubic",
  wireframe: false,
  divider: null,
  background: "#15171a",
};

export const oneOf = <T extends string>(allowed: readonly T[], value: unknown): T | undefined =>
  allowed.find((one) => one === value);
