// Files that name other files: a scene holds all that is drawn, so that nobody hears who looks at it.

import type { GLTFLoaderPlugin, GLTFParser } from "three/addons/loaders/GLTFLoader.js";
import { SceneError } from "./errors.js";
import type { Json } from "./json.js";

const SHOWN = 60; // characters of an address in a message

/**
 * Keeps three.js' GLTFLoader from fetching what a file names: `loader.register(refuseAddresses)`. Such a file is refused
 * with a SceneError, `address`.
 */
export function refuseAddresses(parser: GLTFParser): GLTFLoaderPlugin {
  return {
    name: "EIGENFIELD_addresses",
    beforeRoot: async () => checkAddresses(parser.json as Json), // the JSON that three.js reads, before it fetches
  };
}

/** Every `uri` outside of `extras` is a data URI. Raises SceneError: `address`. */
export function checkAddresses(json: Json): void {
  const waiting: [string, Json | undefined][] = [["", json]];
  for (let next = waiting.pop(); next; next = waiting.pop()) {
    const [where, value] = next;
    if (value === null || typeof value !== "object") continue;
    for (const [key, item] of Object.entries(value)) {
      if (key === "extras" && !Array.isArray(value)) continue; // their owners', which nobody follows
      const place = `${where}/${key}`;
      const address = key === "uri" && !(typeof item === "string" && /^data:/i.test(item));
      if (address) throw refused(place, JSON.stringify(item));
      waiting.push([place, item]);
    }
  }
}

function refused(where: string, text: string): SceneError {
  const shown = text.length > SHOWN ? `${text.slice(0, SHOWN)}…` : text;
  const message = `The file names another one (${where}: ${shown}), which is not fetched; export all of it as one .glb.`;
  return new SceneError("address", message, where);
}
