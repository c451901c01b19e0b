// The JSON of a scene, checked: what stands where in the binary chunk. No byte of that chunk is needed for it.

import {
  FLOAT,
  UINT16,
  UINT32,
  UINT8,
  accessorReader,
  readViews,
  streamOf,
  viewReader,
  type Accessor,
  type AccessorReader,
  type Stream,
  type View,
  type ViewReader,
} from "./accessors.js";
import { CODECS } from "./codecs.js";
import { SceneError, damaged } from "./errors.js";
import { Value, type Json, type JsonObject } from "./json.js";
import * as limits from "./limits.js";
import { readColours, readPlanes, type Plane, type Still } from "./planes.js";
import type { CamerasJson, Feature, PatternJson, SceneJson, ViewPlaneJson } from "./schema.js";
import { readRights, type Rights } from "./rights.js";
import { readSheets, type Sheets } from "./sheets.js";
import { readTimeline, type Timeline } from "./timeline.js";

export interface SceneDocument {
  version: string;
  generator: string;
  rights: Rights;
  planes: Plane[];
  colours: [number, number, number][]; // R, G, B of the value 1 of each channel of all planes
  names: string[] | Stream<"names">; // as many as `heldOut`
  heldOut: boolean[];
  reference: number;
  calibration: Stream<"cameras"> | { intrinsics: Accessor; poses: Accessor };
  sizes: Accessor | [number, number]; // of each photograph, or of all
  colour: Accessor | Stream<"weights"> | null; // a stream is of the encoded cameras, and views mix its colours
  origin: [number, number, number];
  right: [number, number, number];
  up: [number, number, number];
  extent: [number, number];
  triangles: Accessor | Stream<"triangles"> | null;
  settings: JsonObject;
  scores: JsonObject;
  views: View[];
  mesh: Stream<"mesh"> | null; // the proxy, of which `shown` is then a coarse form for other viewers
  sheets: Sheets | null; // null: one opaque surface
  shown: { position: Accessor; uv: Accessor; indices: Accessor } | null; // null: nothing, for none but `mesh`
  preview: number | null; // buffer view of `images[0]`
  timeline: Timeline | null; // null: a scene of one instant
}

const LAYOUT_FEATURES: Feature[] = [
  "groupFiles",
  "namePattern",
  "noFallback",
  "packed",
  "precision",
  "regions",
  "sharedPicture",
  "sheets",
  "stacks",
  "timeline",
  "toRGB",
];
const CODEC_FEATURES = Object.values(CODECS).flatMap(({ needs }) => needs ?? []);
export const KNOWN_NEEDS: ReadonlySet<string> = new Set([...LAYOUT_FEATURES, ...CODEC_FEATURES]);

const MOST_PARTS = 64; // of a pattern of names
const MOST_DIGITS = 9;
const MOST_NUMBER = 10 ** MOST_DIGITS;

/** Whether a glTF document says that it is a scene of ours. */
export function isScene(json: Json): boolean {
  const root = new Value(json, "");
  try {
    return root.key("extensions").key(limits.EXTENSION).exists;
  } catch {
    return false;
  }
}

/** Reads and checks the document of a scene. Raises SceneError: `version`, `needs`, `unsupported`, `damaged`. */
export function readDocument(json: Json): SceneDocument {
  const root = new Value(json, "");
  const extension = root.key("extensions").key(limits.EXTENSION) as Value<SceneJson>;
  const version = checkVersion(extension);
  const views = readViews(root);
  const accessor = accessorReader(root, views);
  const viewOf = viewReader(views);

  checkNodes(root);
  const preview = previewOf(root, viewOf);
  const cameras = extension.key("cameras");
  const { count, names } = namesOf(cameras, viewOf);
  const heldOut = heldOutOf(cameras, count);
  const encoded = heldOut.filter((out) => !out).length;
  const planes = readPlanes(extension, encoded, preview, accessor, viewOf);
  const colours = readColours(extension, planes);
  const colour = cameras.key("colour");
  const codedColour = cameras.key("codedColour");
  if ((colour.exists || codedColour.exists) && colours.length < 3) throw colour.wrong("needs three channels");

  const viewPlane = extension.key("viewPlane");
  const [triangles, codedTriangles] = [viewPlane.key("triangles"), viewPlane.key("codedTriangles")];
  const generator = extension.key("generator");
  const [mesh, timeline] = [extension.key("mesh"), extension.key("timeline")];
  const sheets = readSheets(extension.key("sheets"), viewOf);
  return {
    version,
    generator: generator.exists ? generator.text(limits.MAX_NAME) : "",
    rights: readRights(json),
    planes,
    colours,
    names,
    heldOut,
    reference: extension.key("reference").integer(0, count - 1),
    calibration: calibrationOf(cameras, count, accessor, viewOf),
    sizes: sizesOf(cameras, count, accessor),
    colour: codedColour.exists
      ? streamOf("weights", codedColour, viewOf)
      : colour.exists
        ? accessor(colour, "SCALAR", [FLOAT], 6 * count)
        : null,
    ...readViewPlane(viewPlane),
    triangles: codedTriangles.exists
      ? streamOf("triangles", codedTriangles, viewOf)
      : triangles.exists
        ? trianglesOf(accessor(triangles, "SCALAR", [UINT16, UINT32], null), 2 * limits.MAX_CAMERAS)
        : null,
    settings: freeForm(extension.key("settings")),
    scores: freeForm(extension.key("scores")),
    views,
    mesh: mesh.exists || timeline.exists ? streamOf("mesh", mesh, viewOf) : null,
    sheets,
    shown: mesh.exists && !root.key("meshes").exists ? null : readShown(root, accessor),
    preview,
    timeline: readTimeline(timeline, planes, sheets && sheets.opacity.mean),
  };
}

/** The arrays of meshes[0]. */
function readShown(root: Value, accessor: AccessorReader): NonNullable<SceneDocument["shown"]> {
  const primitive = root.key("meshes").at(0).key("primitives").at(0);
  const mode = primitive.key("mode");
  if (mode.exists && mode.integer(0, 6) !== 4) throw mode.wrong("no triangles");
  const [attributes, indices] = [primitive.key("attributes"), primitive.key("indices")];
  return {
    position: limited(accessor(attributes.key("POSITION"), "VEC3", [FLOAT], null), limits.MAX_VERTICES),
    uv: limited(accessor(attributes.key("TEXCOORD_0"), "VEC2", [FLOAT], null), limits.MAX_VERTICES),
    indices: trianglesOf(accessor(indices, "SCALAR", [UINT8, UINT16, UINT32], null), limits.MAX_TRIANGLES),
  };
}

/** Means of all planes, and after them the opacity of sheets. */
export function stillsOf({ planes, sheets }: SceneDocument): Still[] {
  return sheets ? [...planes, sheets.opacity] : planes;
}

/** Raises SceneError: `version`, `needs`. */
export function checkVersion(extension: Value<SceneJson>): string {
  const version = extension.key("version").text(limits.MAX_NAME);
  if (!/^1\.\d+$/.test(version)) {
    throw new SceneError(
      "version",
      `The scene is of format version ${version.slice(0, 20)} and this viewer reads 1.x; take a newer viewer.`,
      `${extension.where}/version`,
    );
  }
  const needs = extension.key("needs");
  for (const need of needs.exists ? needs.items(limits.MAX_VIEWS) : []) {
    const feature = need.text(limits.MAX_NAME);
    if (!KNOWN_NEEDS.has(feature)) {
      const message = `The scene needs "${feature.slice(0, 60)}", which this viewer cannot draw; take a newer viewer.`;
      throw new SceneError("needs", message, need.where);
    }
  }
  return version;
}

/** Nodes make trees: in a circle three.js' loader would wait for itself. */
function checkNodes(root: Value): void {
  const nodes = root.key("nodes").items(limits.MAX_VIEWS);
  const hasParent = Array<boolean>(nodes.length).fill(false);
  for (const node of nodes) {
    const children = node.key("children");
    for (const child of children.exists ? children.items(nodes.length) : []) {
      const index = child.integer(0, nodes.length - 1);
      if (hasParent[index]) throw child.wrong("a node with two parents");
      hasParent[index] = true;
    }
  }
  for (const scene of root.key("scenes").items(limits.MAX_VIEWS)) {
    const roots = scene.key("nodes");
    for (const top of roots.exists ? roots.items(nodes.length) : []) {
      if (hasParent[top.integer(0, nodes.length - 1)]) throw top.wrong("a node with two parents");
    }
  }
}

function limited(accessor: Accessor, most: number): Accessor {
  if (accessor.count > most) throw damaged(accessor.where, `more than ${most}`);
  return accessor;
}

function trianglesOf(accessor: Accessor, most: number): Accessor {
  if (accessor.count % 3) throw damaged(accessor.where, "torn triangles");
  return limited(accessor, 3 * most);
}

function previewOf(root: Value, viewOf: ViewReader): number | null {
  const images = root.key("images");
  if (!images.exists) return null;
  const view = images.at(0).key("bufferView");
  return view.exists ? viewOf(view) : null;
}

/** How many cameras there are, and their names or where those are coded. */
function namesOf(cameras: Value<CamerasJson>, viewOf: ViewReader): { count: number; names: SceneDocument["names"] } {
  const coded = cameras.key("codedNames");
  if (coded.exists) {
    const count = coded.key("count").integer(1, limits.MAX_CAMERAS);
    return { count, names: streamOf("names", coded, viewOf) };
  }
  const pattern = cameras.key("pattern");
  const given = pattern.exists ? pattern : cameras.key("names");
  const names = pattern.exists
    ? patternNames(pattern)
    : given.items(limits.MAX_CAMERAS).map((name) => name.text(limits.MAX_NAME));
  if (!names.length) throw given.wrong("no cameras");
  const wrong = wrongIn(names);
  if (wrong) throw given.wrong(wrong);
  return { count: names.length, names };
}

/** What is wrong with the names of cameras, if anything is. */
export function wrongIn(names: string[]): string | null {
  if (new Set(names).size !== names.length) return "a name stands twice";
  return names.some((name) => /[\u0000-\u001f\u007f-\u009f]/.test(name)) ? "control characters" : null;
}

/** Names of which the pieces are the same in all, along rows or along columns. */
function patternNames(pattern: Value<PatternJson>): string[] {
  const counts = pattern.key("counts").items(2).map((item) => item.integer(1, limits.MAX_CAMERAS));
  const [rows = 0, columns = 0] = counts;
  if (!columns || rows * columns > limits.MAX_CAMERAS) throw pattern.wrong("no counts of rows and columns");
  const pieces = pattern.key("parts").items(MOST_PARTS).map((part): [number, string[]] => {
    if (typeof part.raw === "string") return [0, Array<string>(rows).fill(part.text(limits.MAX_NAME))];
    const axis = part.key("axis").integer(0, 1);
    const count = axis ? columns : rows;
    const texts = part.key("texts");
    if (texts.exists) {
      const listed = texts.items(count).map((item) => item.text(limits.MAX_NAME));
      if (listed.length !== count) throw texts.wrong(`${count} texts are needed`);
      return [axis, listed];
    }
    const [first, step] = [part.key("first").integer(0, MOST_NUMBER), part.key("step").integer(0, MOST_NUMBER)];
    const digits = part.key("digits").integer(1, MOST_DIGITS);
    return [axis, Array.from({ length: count }, (_, k) => String(first + step * k).padStart(digits, "0"))];
  });
  return Array.from({ length: rows * columns }, (_, i) => {
    const at = [Math.floor(i / columns), i % columns];
    const name = pieces.map(([axis, texts]) => texts[at[axis] ?? 0]).join("");
    if (name.length > limits.MAX_NAME) throw pattern.wrong(`names of more than ${limits.MAX_NAME} characters`);
    return name;
  });
}

function heldOutOf(cameras: Value<CamerasJson>, count: number): boolean[] {
  const flags = Array<boolean>(count).fill(false);
  const held = cameras.key("heldOut");
  if (!held.exists) return flags;
  for (const item of held.items(count)) {
    const index = item.integer(0, count - 1);
    if (flags[index]) throw item.wrong("named twice");
    flags[index] = true;
  }
  if (flags.every((out) => out)) throw held.wrong("all cameras are held out");
  return flags;
}

function calibrationOf(
  cameras: Value<CamerasJson>,
  count: number,
  accessor: AccessorReader,
  viewOf: ViewReader,
): SceneDocument["calibration"] {
  const coded = cameras.key("coded");
  if (coded.exists) return streamOf("cameras", coded, viewOf);
  return {
    intrinsics: accessor(cameras.key("intrinsics"), "SCALAR", [FLOAT], 5 * count),
    poses: accessor(cameras.key("poses"), "SCALAR", [FLOAT], 12 * count),
  };
}

function sizesOf(cameras: Value<CamerasJson>, count: number, accessor: AccessorReader): SceneDocument["sizes"] {
  const one = cameras.key("size");
  if (!one.exists) return accessor(cameras.key("sizes"), "SCALAR", [UINT32], 2 * count);
  const [width = 0, height = 0] = one.numbers(2, 1, limits.MAX_CAMERA_SIDE);
  if (!Number.isInteger(width) || !Number.isInteger(height)) throw one.wrong("no whole numbers");
  return [width, height];
}

function readViewPlane(value: Value<ViewPlaneJson>): Pick<SceneDocument, "origin" | "right" | "up" | "extent"> {
  const [right, up] = [value.key("right").triple(), value.key("up").triple()];
  const dot = (a: number[], b: number[]): number => a.reduce((sum, x, i) => sum + x * (b[i] ?? 0), 0);
  for (const off of [dot(right, right) - 1, dot(up, up) - 1, dot(right, up)]) {
    if (!(Math.abs(off) <= limits.ORTHONORMAL)) throw value.wrong("axes not at right angles, or not of length 1");
  }
  const [width = 0, height = 0] = value.key("extent").numbers(2, 0);
  return { origin: value.key("origin").triple(), right, up, extent: [width, height] };
}

function freeForm(value: Value): JsonObject {
  return value.exists ? value.object() : {};
}
