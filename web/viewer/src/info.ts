// The information panel: what the file is, what it says of itself, and what it costs here.

import type { EigenField, Fallback, Player, SceneInfo } from "eigenfield-three";
import { isWeb } from "./config";
import { element } from "./dom";
import { limitationWords, words } from "./language";
import { bytes, figure, shown, whole } from "./text";
import type { Viewer } from "./viewer";

type Rows = [string, string][];

export interface Info {
  readonly root: HTMLElement;
  update(): void;
}

export function createInfo(viewer: Viewer): Info {
  const root = element("div", { class: "facts" });
  return {
    root,
    update: () => {
      const scene = viewer.scene();
      const field = scene?.field;
      if (!scene) return root.replaceChildren();
      if (!field) {
        return root.replaceChildren(
          element("p", {}, scene.lacks ?? `${words("plainGltf")} ${words("plainGltfShown")}`),
        );
      }
      const limitation = limitationWords(field);
      root.replaceChildren(
        ...section(words("quality"), quality(field.info)),
        ...section(words("bytes"), sizes(field.info)),
        ...section(words("sceneFacts"), facts(field.info)),
        ...section(words("rights"), rights(field.info)),
        ...section(words("here"), [
          [words("gpuMemory"), bytes(field.gpuBytes)],
          [words("eigenTexturesHere"), words("outOf", { part: field.loaded, whole: field.total })],
        ]),
        ...(limitation === null ? [] : [element("p", { class: "warning" }, limitation)]),
        ...settings(field),
      );
    },
  };
}

/** What one wants to know first: how near it comes to its photographs, what it takes here, and where a clip is. */
export function briefly({ info, gpuBytes, player }: EigenField): HTMLElement {
  return rowsOf([...imageQuality(info), [words("gpuMemory"), bytes(gpuBytes)], ...(player ? whereIn(player) : [])]);
}

/** Bytes and the best known score, for a label. */
export function shortly(info: SceneInfo): string {
  const scores = info.scores;
  const [own, between] = [figure(scores, "image", "encoded", "psnr"), figure(scores, "between", "psnr")];
  const parts = own === null ? [] : [shown(own, 1, "\u00a0dB")];
  if (own === null && between !== null) parts.push(words("aboutValue", { value: shown(between, 1, "\u00a0dB") }));
  return [bytes(info.bytes.total), ...parts].join(" · ");
}

/** Why a clip is shown without some of it. */
function fallbackWords(kind: Fallback): string {
  if (kind === "bits") return words("shownBits");
  if (kind === "textures") return words("shownMeans");
  return words(globalThis.isSecureContext ? "shownKeys" : "shownInsecure");
}

function whereIn({ frame, frames, rate, group, late, fallbacks }: Player): Rows {
  const outOf = (part: number, count: number): string => words("outOf", { part: part + 1, whole: count });
  return [
    [words("frame"), `${outOf(frame, frames)}\u00a0· ${shown(rate, Number.isInteger(rate) ? 0 : 2)}\u00a0Hz`],
    [words("group"), `${outOf(group.index, group.count)}\u00a0· ${bytes(group.bytes)}`],
    [words("leftOut"), whole(late)],
    ...(fallbacks.length ? [[words("shownHere"), fallbacks.map(fallbackWords).join("; ")] as [string, string]] : []),
  ];
}

function section(title: string, rows: Rows): Node[] {
  if (rows.length === 0) return [];
  return [element("h3", {}, title), rowsOf(rows)];
}

function rowsOf(rows: Rows): HTMLElement {
  const row = ([name, value]: [string, string]): HTMLElement =>
    element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, linked(value)));
  return element("table", {}, ...rows.map(row));
}

/** A text that is an address leads there. */
function linked(text: string): HTMLElement | string {
  return isWeb(text) ? element("a", { href: text, target: "_blank", rel: "noopener noreferrer" }, text) : text;
}

function rights({ rights: { title, author, licence, source } }: SceneInfo): Rows {
  const rows: Rows = [
    [words("title"), title], [words("author"), author], [words("licence"), licence], [words("source"), source],
  ];
  return rows.filter(([, text]) => text !== "");
}

/** PSNR and SSIM of a kind of picture, where the file has them. */
function measured({ scores }: SceneInfo, label: string, ...path: string[]): Rows {
  const [psnr, ssim] = [figure(scores, ...path, "psnr"), figure(scores, ...path, "ssim")];
  if (psnr === null && ssim === null) return [];
  const rest = ssim === null ? "" : `\u00a0· SSIM\u00a0${shown(ssim, 4)}`;
  return [[label, `${shown(psnr, 2, "\u00a0dB")}${rest}`]];
}

const imageQuality = (info: SceneInfo): Rows => [
  ...measured(info, words("encodedViews"), "image", "encoded"),
  ...measured(info, words("heldOutViews"), "image", "held_out"),
  ...between(info),
];

/** The estimate of `encode`: of few photographs a lower one, of luma. */
function between({ scores }: SceneInfo): Rows {
  const [lower, psnr] = [figure(scores, "between", "psnr_luma_at_least"), figure(scores, "between", "psnr")];
  const value = shown(lower ?? psnr, 1, "\u00a0dB");
  if (lower === null && psnr === null) return [];
  return [[words("betweenViews"), words(lower === null ? "aboutValue" : "atLeastLuma", { value })]];
}

function quality(info: SceneInfo): Rows {
  const rows = [...measured(info, words("textureMaps"), "uv"), ...imageQuality(info)];
  const ratio = figure(info.scores, "ratio", "photographs");
  if (ratio !== null) rows.push([words("ratio"), `${shown(ratio, 1)} ×`]);
  return rows.length > 0 ? rows : [[words("notMeasured"), "eigenfield evaluate --store"]];
}

function sizes({ bytes: parts }: SceneInfo): Rows {
  const textures = parts.textures.reduce((a, b) => a + b, 0);
  const pictures: Rows = [
    [words("mean"), bytes(parts.mean)],
    [words("countTextures", { count: parts.textures.length }), bytes(textures)],
    [words("weights"), bytes(parts.weights)],
  ];
  return [
    [words("file"), bytes(parts.total)],
    [words("mesh"), bytes(parts.mesh)],
    ...(parts.opacity ? [[words("opacity"), bytes(parts.opacity)] as [string, string]] : []),
    ...(parts.groups ? [[words("groups"), bytes(parts.groups)] as [string, string]] : pictures),
    [words("rest"), bytes(parts.other)],
  ];
}

function facts(info: SceneInfo): Rows {
  const held = info.heldOut.filter(Boolean).length;
  const out = held > 0 ? [words("countHeldOut", { count: held })] : [];
  const grid = info.grid ? ` (${info.grid.columns} × ${info.grid.rows})` : "";
  const view = info.cameras[info.reference];
  return [
    [words("cameras"), [`${info.cameras.length}${grid}`, ...out].join(", ")],
    ...(view ? [[words("photographs"), `${view.width} × ${view.height}`] as [string, string]] : []),
    [words("texelCount"), `${info.size[0]} × ${info.size[1]}`],
    ...(info.planes.length > 1 ? info.planes.map(plane) : []),
    [words("vertices"), whole(info.vertices)],
    [words("triangles"), whole(info.triangles)],
    ...(info.sheets ? [[words("sheets"), words("sheetsOver", { count: info.sheets })] as [string, string]] : []),
    [words("format"), info.version],
    ...(info.generator === "" ? [] : [[words("madeBy"), info.generator] as [string, string]]),
  ];
}

/** Channels of a plane, and where its mean and eigen textures have other sizes than the atlas. */
function plane({ channels, mean, bases }: SceneInfo["planes"][number], index: number): [string, string] {
  const sides = ([width, height]: readonly [number, number]): string => `${width} × ${height}`;
  const kinds = bases.map(({ textures, size }) => words("texturesOf", { count: textures, size: sides(size) }));
  const parts = [words("channels", { count: channels }), words("meanOf", { size: sides(mean) }), ...kinds];
  return [words("plane", { number: index + 1 }), parts.join(", ")];
}

function settings({ info }: EigenField): Node[] {
  const entries = Object.entries(info.settings).filter(([, value]) => value !== null);
  if (entries.length === 0) return [];
  const text = (value: unknown): string => (typeof value === "string" ? value : JSON.stringify(value));
  const rows = entries.map(([key, value]): [string, string] => [key, text(value)]);
  return [element("details", {}, element("summary", {}, words("howMade")), ...section("", rows).slice(1))];
}
