// Numbers as people read them.

export function bytes(count: number): string {
  if (count < 1000) return `${count}\u00a0B`;
  if (count < 999_500) return `${(count / 1e3).toFixed(count < 99_950 ? 1 : 0)}\u00a0kB`;
  if (count < 999_500_000) return `${(count / 1e6).toFixed(2)}\u00a0MB`;
  return `${(count / 1e9).toFixed(2)}\u00a0GB`;
}

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
  value === null ? "–" : `${value.toFixed(digits)}${unit}`;
