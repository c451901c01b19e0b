// What both ways of moving, on the view plane and around a point, have in common.

import type { Frame } from "eigenfield-three";
import type { PerspectiveCamera } from "three";
import type { Mover } from "./loop";

/** What keys and sticks ask for, each -1..1: sideways, up, larger, into the scene. */
export interface Push {
  x: number;
  y: number;
  closer: number;
  forward: number;
}

export const WHOLE: Frame = { left: 0, top: 0, width: 1, height: 1 };

export interface Mode extends Mover {
  grab(): void;
  /** The hand moved by so much, in parts of the canvas's smaller side, right and down. */
  drag(dx: number, dy: number, pan: boolean): void;
  release(): void;
  push(wish: Push, seconds: number): void;
  closer(factor: number): void;
  /** Into the scene, in parts of its distance. */
  forward(amount: number): void;
  place(camera: PerspectiveCamera, aspect: number): Frame;
  /** Radians to the nearest direction from which what the eye sees was captured; 0 among the captured views. */
  beyond(): number;
}

/** Nobody who asked the system for less motion wants things to glide. */
export const reducedMotion = (): boolean => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** From `value` towards `goal`, exponentially, and exactly there in the end. */
export function approach(value: number, goal: number, seconds: number, constant: number, close: number): number {
  if (reducedMotion() || Math.abs(goal - value) < close) return goal;
  return goal + (value - goal) * Math.exp(-seconds / constant);
}

/** On a phone held upright the picture fills the height, and its sides are cut; elsewhere all of it is seen. */
export const fillsHeight = (aspect: number): boolean => aspect < 1 && matchMedia("(pointer: coarse)").matches;

export const clamp = (value: number, low: number, high: number): number => Math.min(Math.max(value, low), high);
