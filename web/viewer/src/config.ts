// The configuration of the page: the JSON in #eigenfield-config, by whoever made the page, and the query of its
// address: ?memory=MB, ?ui=, ?poster=. Every key is optional, and a key of the wrong kind is as good as absent.

import { oneOf } from "./options";

/** What lies over the picture: nothing; title and a few buttons; or panel, map and tools. */
const UIS = ["none", "plain", "full"] as const;
export type Ui = (typeof UIS)[number];

export interface Sample {
  name: string;
  url: string;
  bytes: number | null;
  picture: string | null; // URL of what it shows
}

/** A second scene beside the page's own. */
export interface Other {
  names: [string, string]; // of both, for people
  scene: string | null; // URL; null: base64 text in #eigenfield-beside
  bytes: number | null;
}

export interface Config {
  title: string | null;
  scene: string | null; // URL, relative to the page
  bytes: number | null; // of the scene
  url: string | null; // where the page will be: links to it begin with that
  embedded: boolean; // the scene is base64 text in #eigenfield-scene
  photographs: ReadonlyMap<string, string>; // camera's name to URL
  metresPerUnit: number | null;
  version: string | null;
  start: { x: number; y: number } | null; // the first view, on the view plane
  ui: Ui;
  laboratory: boolean; // a page for guests may lead to panel, map and tools
  poster: string | null; // URL of a picture that is shown until the scene is there
  ownView: boolean; // the address names no view: the page may show its first one as it likes
  samples: readonly Sample[]; // which a page without a scene offers
  beside: Other | null;
  draft: string | null; // URL that says when the whole scene comes: this one is a draft
  download: boolean; // the page's own scene may be saved as a file
  worker: string | null; // URL of the service worker that keeps the page for times without a network
  memory: number | null; // GPU bytes the page may use; null: by the device
}

export function readConfig(page: Document, address: URL): Config {
  const given = parse(page.getElementById("eigenfield-config")?.textContent ?? "{}");
  const text = (key: string): string | null => {
    const value = given[key];
    return typeof value === "string" && value !== "" ? value : null;
  };
  const positive = (key: string): number | null => {
    const value = given[key];
    return typeof value === "number" && Number.isFinite(value) && value > 0 ? value : null;
  };
  const url = text("url");
  const photographs = given["photographs"];
  const start: unknown[] = Array.isArray(given["start"]) ? given["start"] : [];
  const [x, y] = start.map((value) => (typeof value === "number" && Math.abs(value) <= 1 ? value : undefined));
  const samples: unknown[] = Array.isArray(given["samples"]) ? given["samples"] : [];
  const asked = address.searchParams.get("ui");
  const wanted = oneOf(UIS, asked === "0" ? "none" : asked);
  const own = oneOf(UIS, given["ui"]) ?? "full";
  const megabytes = Number(address.searchParams.get("memory"));
  return {
    title: text("title"),
    scene: text("scene"),
    bytes: positive("bytes"),
    url: url !== null && isWeb(url) ? url : null,
    embedded: given["embedded"] === true,
    photographs: new Map(
      isObject(photographs)
        ? Object.entries(photographs).filter((entry): entry is [string, string] => typeof entry[1] === "string")
        : [],
    ),
    metresPerUnit: positive("metresPerUnit"),
    version: text("version"),
    start: x === undefined || y === undefined ? null : { x, y },
    ui: wanted ?? own,
    laboratory: own === "full" || wanted === "full",
    poster: address.searchParams.get("poster"),
    ownView: address.hash.length < 2,
    samples: samples.filter(isObject).flatMap(({ name, url, bytes, picture }) =>
      typeof name === "string" && typeof url === "string"
        ? [{
          name, url, bytes: typeof bytes === "number" ? bytes : null,
          picture: typeof picture === "string" ? picture : null,
        }]
        : [],
    ),
    beside: otherOf(given["beside"]),
    draft: text("draft"),
    download: given["download"] !== false,
    worker: text("worker"),
    memory: megabytes > 0 && Number.isFinite(megabytes) ? megabytes * 1e6 : null,
  };
}

function otherOf(value: unknown): Other | null {
  if (!isObject(value)) return null;
  const { names, scene, bytes } = value;
  const [first, second]: unknown[] = Array.isArray(names) ? names : [];
  if (typeof first !== "string" || typeof second !== "string") return null;
  return {
    names: [first, second], scene: typeof scene === "string" ? scene : null,
    bytes: typeof bytes === "number" ? bytes : null,
  };
}

/** A scene inside the page, or null where there is none. */
export function embeddedScene(page: Document, id = "eigenfield-scene"): Blob | null {
  const text = page.getElementById(id)?.textContent?.trim();
  return text ? fromBase64(text) : null;
}

/** Base64 text as a Blob, a piece at a time: `atob` on the whole would hold the file three times. */
export function fromBase64(text: string): Blob {
  const pieces: Uint8Array<ArrayBuffer>[] = [];
  const step = 1 << 20; // a multiple of four: each piece is base64 of its own
  for (let start = 0; start < text.length; start += step) {
    const binary = atob(text.slice(start, start + step));
    const bytes = new Uint8Array(binary.length);
    for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
    pieces.push(bytes);
  }
  return new Blob(pieces);
}

/** Whether it is an address that people can open. */
export const isWeb = (text: string): boolean => /^https?:/i.test(text) && URL.canParse(text);

function parse(text: string): Record<string, unknown> {
  try {
    const value: unknown = JSON.parse(text);
    return isObject(value) ? value : {};
  } catch {
    return {};
  }
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
