// Whose a scene is: the packet of KHR_xmp_json_ld that stands for the whole file. Other programs write it too, so that
// what of it is no text of one line is left out, and nothing of it keeps a scene from being drawn.

import type { Json } from "./json.js";
import { MAX_RIGHTS } from "./limits.js";

const XMP = "KHR_xmp_json_ld";
/** Controls, halves of characters, ends of lines, and what turns the direction of the text behind it. */
const NO_TEXT = /[\p{Cc}\p{Cs}\p{Zl}\p{Zp}\u202a-\u202e\u2066-\u2069]/u;

/** Texts of strangers; what is empty the file does not say. */
export interface Rights {
  title: string;
  author: string;
  licence: string;
  source: string;
}

export function readRights(json: Json): Rights {
  const index = member(json, "asset", "extensions", XMP, "packet");
  const packets = member(json, "extensions", XMP, "packets");
  const packet = Array.isArray(packets) && typeof index === "number" ? packets[index] : undefined;
  const text = (key: string): string => {
    const found = textOf(member(packet, key)) ?? "";
    return [...found].length > MAX_RIGHTS || NO_TEXT.test(found) ? "" : found;
  };
  return { title: text("dc:title"), author: text("dc:creator"), licence: text("dc:rights"), source: text("dc:source") };
}

/** Of a property in any of the forms of XMP: plain, the first language of several, a list. */
function textOf(value: Json | undefined): string | null {
  const several = member(value, "@list") ?? member(value, "@set");
  if (Array.isArray(several) && several.every((one) => typeof one === "string")) return several.join(", ");
  const text = typeof value === "string" ? value : member(value, "rdf:_1", "@value");
  return typeof text === "string" ? text : null;
}

/** A member of objects within each other, if there is one. */
function member(value: Json | undefined, ...keys: string[]): Json | undefined {
  for (const key of keys) {
    if (typeof value !== "object" || value === null || Array.isArray(value) || !Object.hasOwn(value, key)) return undefined;
    value = value[key];
  }
  return value;
}
