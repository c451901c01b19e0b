// The GLB container, read as it arrives: header, JSON, then the places of the chunks behind it.

import type { Arrival } from "./arrival.js";
import { SceneError, damaged } from "./errors.js";
import type { Json } from "./json.js";
import * as limits from "./limits.js";

const GLTF = 0x46546c67;
const JSON_CHUNK = 0x4e4f534a;
const BINARY_CHUNK = 0x004e4942;
const GROUPS_CHUNK = 0x4c544645; // "EFTL": the groups of a clip

export interface Container {
  length: number; // of the file, as its header says
  text: string; // the JSON
  json: Json;
  /** Where the content of the binary chunk begins; rejects if there is none. */
  binary(): Promise<number>;
  /** The same of the chunk of groups. */
  groups(): Promise<number>;
}

/** Reads header and JSON. Raises SceneError: `not-glb`, `version`, `truncated`, `damaged`. */
export async function openContainer(arrival: Arrival): Promise<Container> {
  const magic = await arrival.read(0, 4).catch((reason: unknown) => {
    throw reason instanceof SceneError && reason.code === "truncated" ? notGlb(arrival.received === 0) : reason;
  });
  if (new DataView(magic).getUint32(0, true) !== GLTF) throw notGlb(false);
  const header = new DataView(await arrival.read(0, 12));
  const version = header.getUint32(4, true);
  const length = header.getUint32(8, true);
  if (version !== 2) {
    const message = `The file is GLB version ${version} and this viewer reads 2; save it as glTF 2.`;
    throw new SceneError("version", message, "4");
  }
  if (length < 20) throw damaged("8", "a length of no file");
  const first = new DataView(await arrival.read(12, 20));
  const size = first.getUint32(0, true);
  if (first.getUint32(4, true) !== JSON_CHUNK) throw damaged("16", "it does not begin with JSON");
  if (size > limits.MAX_JSON) throw damaged("12", `${size} bytes of JSON`);
  if (20 + size > length) throw damaged("12", "a chunk longer than the file");
  const text = decodeText(await arrival.read(20, 20 + size));
  const start = (kind: number, name: string) => (): Promise<number> => chunkStart(arrival, 20 + size, length, kind, name);
  return {
    length,
    text,
    json: parseJson(text, "20"),
    binary: start(BINARY_CHUNK, "binary chunk"),
    groups: start(GROUPS_CHUNK, "chunk of groups"),
  };
}

async function chunkStart(arrival: Arrival, from: number, length: number, kind: number, name: string): Promise<number> {
  let at = from;
  for (let chunk = 1; chunk < limits.MAX_CHUNKS && at + 8 <= length; chunk++) {
    const head = new DataView(await arrival.read(at, at + 8));
    const size = head.getUint32(0, true);
    if (at + 8 + size > length) throw damaged(String(at), "a chunk longer than the file");
    if (head.getUint32(4, true) === kind) return at + 8;
    at += 8 + size;
  }
  throw damaged(String(from), `no ${name}`);
}

function decodeText(bytes: ArrayBuffer): string {
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    throw damaged("20", "its JSON is not UTF-8");
  }
}

export function parseJson(text: string, where: string): Json {
  if (depthOf(text) > limits.MAX_DEPTH) throw damaged(where, "its JSON is nested too deep");
  try {
    return JSON.parse(text) as Json;
  } catch {
    throw damaged(where, "its JSON cannot be read");
  }
}

/** Nested objects and arrays, at most; strings are passed over. */
function depthOf(text: string): number {
  let [depth, deepest] = [0, 0];
  let quoted = false;
  for (let i = 0; i < text.length; i++) {
    const letter = text[i];
    if (letter === '"') quoted = !quoted;
    else if (quoted && letter === "\\") i += 1;
    else if (quoted) continue;
    else if (letter === "[" || letter === "{") deepest = Math.max(deepest, ++depth);
    else if (letter === "]" || letter === "}") depth -= 1;
  }
  return deepest;
}

function notGlb(empty: boolean): SceneError {
  const message = empty
    ? "The file is empty; take a .glb file that eigenfield wrote."
    : "The file is no GLB; take a .glb file that eigenfield wrote.";
  return new SceneError("not-glb", message, "0");
}
