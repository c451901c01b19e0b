// The page's own scene as a file, for those who have the page alone.

import { element } from "./dom";
import type { Source } from "./source";

const FREED = 10_000; // milliseconds after which the file is no longer held

export function downloadScene({ name, from }: Source): void {
  save(from, `${name.replaceAll(/[^\p{L}\p{N}._+-]+/gu, "-").slice(0, 100) || "scene"}.glb`);
}

/** Saves a file under a name: its bytes, or what is at an address of this page's server. */
export function save(from: Blob | string, name: string): void {
  const url = typeof from === "string" ? from : URL.createObjectURL(from);
  element("a", { href: url, download: name }).click();
  if (from instanceof Blob) setTimeout(() => URL.revokeObjectURL(url), FREED);
}
