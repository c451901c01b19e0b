// Numbers as people read them.

import { LANGUAGE, words } from "./language";

export function bytes(count: number): string {
  const [B, kB, MB, GB] = words("units").split(" ");
  if (count < 1000) return `${count}\u00a0${B}`;
  if (count < 999_500) return `${decimal(count / 1e3, count < 99_950 ? 1 : 0)}\u00a0${kB}`;
  if (count < 999_500_000) return `${decimal(count / 1e6, 2)}\u00a0${MB}`;
  return `${decimal(count / 1e9, 2)}\u00a0${GB}`;
}

const decimal = (value: number, digits: number): string =>
  value.toLocaleString(LANGUAGE, { minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false });

export const whole = (count: number): string => count.toLocaleString("en-GB").replaceAll(",", "\u202f");

/** A number inside JSON, by its path, or null. */
export function figure(json: unknown, ...path: string[]): number | null {
  const value = path.reduce<unknown>(
    (at, key) => (typeof at === "object" && at !== null ? (at as Record<string, unknown>)[key] : undefined),
    json,
  );
  return typeof value === "number" && Number.isFinite(value) ? value : null;
}

export const shown = (value: number | null, digits: number, unit = ""): string =>
  value === null ? "–" : `${decimal(value, digits)}${unit}`;
