// The capture's own pictures, one for each camera, fetched when somebody wants to compare.

import { LinearFilter, LinearMipmapLinearFilter, NoColorSpace, Texture } from "three";
import { fromBase64 } from "./config";

const KEPT = 6; // on the GPU at a time

export interface Photographs {
  has(name: string): boolean;
  /** The picture if it is here; otherwise null, and it is fetched. */
  get(name: string): Texture | null;
  pending(): boolean;
  forget(): void;
}

/** changed: one has come. failed: one that should be there could not be had. */
export function createPhotographs(
  urls: ReadonlyMap<string, string>,
  changed: () => void,
  failed: (name: string) => void,
): Photographs {
  const here = new Map<string, Texture>();
  const coming = new Set<string>();
  const broken = new Set<string>();

  const fetchOne = async (name: string, url: string): Promise<void> => {
    coming.add(name);
    try {
      const bitmap = await createImageBitmap(await bytesOf(url), {
        colorSpaceConversion: "none",
        premultiplyAlpha: "none",
      });
      const texture = new Texture(bitmap);
      texture.colorSpace = NoColorSpace;
      texture.flipY = false; // row 0 is the top one, as in the file
      texture.minFilter = LinearMipmapLinearFilter;
      texture.magFilter = LinearFilter;
      texture.generateMipmaps = true;
      texture.needsUpdate = true;
      here.set(name, texture);
      for (const [old, unused] of here) {
        if (here.size <= KEPT) break;
        unused.dispose();
        here.delete(old);
      }
    } catch {
      broken.add(name);
      failed(name);
    } finally {
      coming.delete(name);
      changed();
    }
  };

  return {
    has: (name) => urls.has(name) && !broken.has(name),
    get: (name) => {
      const url = urls.get(name);
      const texture = here.get(name);
      if (!texture && url !== undefined && !coming.has(name) && !broken.has(name)) void fetchOne(name, url);
      return texture ?? null;
    },
    pending: () => coming.size > 0,
    forget: () => {
      for (const texture of here.values()) texture.dispose();
      here.clear();
    },
  };
}

/** A data URL is taken apart here: fetching one is a request that a strict policy forbids. */
async function bytesOf(url: string): Promise<Blob> {
  const inside = /^data:[^,]*;base64,(.*)$/s.exec(url)?.[1];
  if (inside !== undefined) return fromBase64(inside);
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${answer.status}`);
  return answer.blob();
}
