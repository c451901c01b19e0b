// Where a scene comes from: the page itself, a URL, or a file from this machine.

import type { Config } from "./config";
import { embeddedScene } from "./config";
import { words } from "./language";

export interface Source {
  name: string; // for people
  from: string | Blob;
  bytes: number | null;
  own: boolean; // the page was made for it: its title and photographs belong to it
  files?: ReadonlyMap<string, Blob>; // of the folder that a clip is
}

/** What the page or its address names, or null: then somebody has to bring a file. */
export function namedSource(config: Config, page: Document, address: URL): Source | null {
  const title = config.title ?? words("scene");
  if (config.embedded) {
    const blob = embeddedScene(page);
    if (blob) return { name: title, from: blob, bytes: blob.size, own: true };
  }
  if (config.scene !== null) return { name: title, from: config.scene, bytes: config.bytes, own: true };
  const asked = address.searchParams.get("load");
  if (asked !== null && asked !== "") return { name: lastPart(asked), from: asked, bytes: null, own: false };
  return null;
}

/** The scene beside the page's own, or null. */
export function besideSource({ beside }: Config, page: Document): Source | null {
  const from = beside && (beside.scene ?? embeddedScene(page, "eigenfield-beside"));
  return beside && from ? { name: beside.names[1], from, bytes: beside.bytes, own: true } : null;
}

export function fileSource(file: File): Source {
  return { name: withoutSuffix(file.name), from: file, bytes: file.size, own: false };
}

/** The clip in a folder, whose files are named by their paths in it. Without its file another is opened, and says why not. */
export function folderSource(name: string, files: ReadonlyMap<string, File>): Source | null {
  const file = files.get("scene.glb") ?? files.values().next().value;
  return file ? { ...fileSource(file), ...(file.name === "scene.glb" && { name }), files } : null;
}

function lastPart(url: string): string {
  const name = url.split(/[?#]/)[0]?.split("/").pop() ?? "";
  try {
    return withoutSuffix(decodeURIComponent(name)) || words("scene");
  } catch {
    return withoutSuffix(name) || words("scene");
  }
}

const withoutSuffix = (name: string): string => name.replace(/\.(glb|gltf)$/i, "");
