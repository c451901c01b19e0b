// The information panel: what the file is, what it says of itself, and what it costs here.

import type { EigenField, SceneInfo } from "eigenfield-three";
import { element } from "./dom";
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
          element("p", {}, "A plain glTF file: no eigen textures. It is shown as it is."),
        );
      }
      root.replaceChildren(
        ...section("Quality, as measured on the photographs", quality(field.info)),
        ...section("Bytes", sizes(field.info)),
        ...section("Scene", facts(field.info)),
        ...section("Here", [
          ["GPU memory", bytes(field.gpuBytes)],
          ["eigen textures", `${field.loaded} of ${field.total}`],
        ]),
        ...(field.limitation === null ? [] : [element("p", { class: "warning" }, field.limitation)]),
        ...settings(field),
      );
    },
  };
}

/** What one wants to know first: how near it comes to its photographs, and what it takes here. */
export function briefly({ info, gpuBytes }: EigenField): HTMLElement {
  return rowsOf([...imageQuality(info), ["GPU memory", bytes(gpuBytes)]]);
}

function section(title: string, rows: Rows): Node[] {
  if (rows.length === 0) return [];
  return [element("h3", {}, title), rowsOf(rows)];
}

function rowsOf(rows: Rows): HTMLElement {
  const row = ([name, value]: [string, string]): HTMLElement =>
    element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, value));
  return element("table", {}, ...rows.map(row));
}

/** PSNR and SSIM of a kind of picture, where the file has them. */
function measured({ scores }: SceneInfo, label: string, ...path: string[]): Rows {
  const [psnr, ssim] = [figure(scores, ...path, "psnr"), figure(scores, ...path, "ssim")];
  if (psnr === null && ssim === null) return [];
  const rest = ssim === null ? "" : `\u00a0· SSIM\u00a0${shown(ssim, 4)}`;
  return [[label, `${shown(psnr, 2, "\u00a0dB")}${rest}`]];
}

const imageQuality = (info: SceneInfo): Rows => [
  ...measured(info, "encoded views", "image", "encoded"),
  ...measured(info, "held-out views", "image", "held_out"),
  ...between(info),
];

/** The lower estimate of `encode`. */
function between({ scores }: SceneInfo): Rows {
  const psnr = figure(scores, "between", "psnr_luma_at_least");
  return psnr === null ? [] : [["between its views", `at least ${shown(psnr, 1, "\u00a0dB")} of luma`]];
}

function quality(info: SceneInfo): Rows {
  const rows = [...measured(info, "texture maps", "uv"), ...imageQuality(info)];
  const ratio = figure(info.scores, "ratio", "photographs");
  if (ratio !== null) rows.push(["smaller than its photographs", `${shown(ratio, 1)} ×`]);
  return rows.length > 0 ? rows : [["not measured", "eigenfield evaluate --store"]];
}

function sizes({ bytes: parts }: SceneInfo): Rows {
  const textures = parts.textures.reduce((a, b) => a + b, 0);
  return [
    ["file", bytes(parts.total)],
    ["mesh", bytes(parts.mesh)],
    ...(parts.opacity ? [["opacity", bytes(parts.opacity)] as [string, string]] : []),
    ["mean", bytes(parts.mean)],
    [`${parts.textures.length} eigen textures`, bytes(textures)],
    ["weights", bytes(parts.weights)],
    ["calibration and the rest", bytes(parts.other)],
  ];
}

function facts(info: SceneInfo): Rows {
  const held = info.heldOut.filter(Boolean).length;
  const grid = info.grid ? ` (${info.grid.columns} × ${info.grid.rows})` : "";
  const view = info.cameras[info.reference];
  return [
    ["cameras", `${info.cameras.length}${grid}${held > 0 ? `, ${held} held out` : ""}`],
    ...(view ? [["photographs", `${view.width} × ${view.height}`] as [string, string]] : []),
    ["texels", `${info.size[0]} × ${info.size[1]}`],
    ...(info.planes.length > 1 ? info.planes.map(plane) : []),
    ["vertices", whole(info.vertices)],
    ["triangles", whole(info.triangles)],
    ...(info.sheets ? [["sheets", `${info.sheets}, one over the other`] as [string, string]] : []),
    ["format", info.version],
    ...(info.generator === "" ? [] : [["made by", info.generator] as [string, string]]),
  ];
}

/** Channels of a plane, and where its mean and eigen textures have other sizes than the atlas. */
function plane({ channels, mean, bases }: SceneInfo["planes"][number], index: number): [string, string] {
  const kinds = bases.map(({ textures, grid }) => `${textures} eigen textures of ${grid[0]} × ${grid[1]}`);
  const parts = [channels === 1 ? "1 channel" : `${channels} channels`, `mean of ${mean[0]} × ${mean[1]}`, ...kinds];
  return [`plane ${index + 1}`, parts.join(", ")];
}

function settings({ info }: EigenField): Node[] {
  const entries = Object.entries(info.settings).filter(([, value]) => value !== null);
  if (entries.length === 0) return [];
  const text = (value: unknown): string => (typeof value === "string" ? value : JSON.stringify(value));
  const rows = entries.map(([key, value]): [string, string] => [key, text(value)]);
  return [element("details", {}, element("summary", {}, "How it was made"), ...section("", rows).slice(1))];
}
