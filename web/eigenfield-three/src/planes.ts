// Planes of a scene's document, checked: means, bases, and the pictures that hold them.

import type { Accessor, AccessorReader } from "./document.js";
import { SceneError } from "./errors.js";
import { Value } from "./json.js";
import * as limits from "./limits.js";

export const FLOAT = 5126; // the component type of accessors

export interface Picture {
  view: number;
  mimeType: string;
  scale: number[]; // of each channel of each texture: value = (code - zero) * scale
  zero: number[];
  textures: number; // in this picture, one below the other
  where: string;
}

/** Eigen textures of one plane and size, and the cameras' weights of them. */
export interface Basis {
  size: [number, number]; // of each texture
  grid: [number, number]; // of the whole atlas at this density
  corner: [number, number]; // column and row of the grid at which the textures begin
  pictures: Picture[];
  count: number; // textures
  weights: Accessor | null; // null: no textures
  where: string;
}

export interface Plane {
  channels: number;
  mean: Picture;
  meanSize: [number, number] | null; // null: `images[0]`, whose header says it
  bases: Basis[];
}

/** The buffer view that a value names. */
type PictureView = (value: Value) => number;

function unsupported(what: string, where: string): SceneError {
  const message = `The scene has ${what}, which this viewer does not draw; draw it with "eigenfield render".`;
  return new SceneError("unsupported", message, where);
}

function readSize(value: Value): [number, number] {
  const [width = 0, height = 0] = value.items(2).map((item) => item.integer(1, limits.MAX_SIDE));
  if (!width || !height) throw value.wrong("two numbers are needed");
  if (width * height > limits.MAX_TEXELS) throw value.wrong(`more than ${limits.MAX_TEXELS} texels`);
  return [width, height];
}

export function readPlanes(
  extension: Value,
  encoded: number,
  preview: number | null,
  accessor: AccessorReader,
  pictureView: PictureView,
): Plane[] {
  const listed = extension.key("planes").items(limits.MAX_PLANES);
  if (!listed.length) throw extension.key("planes").wrong("no plane");
  const planes = listed.map((plane, i): Plane => {
    const channels = plane.key("channels").integer(1, limits.MAX_CHANNELS);
    const mean = readMean(plane, channels, i === 0 ? preview : null, pictureView);
    const bases = plane.key("bases").items(limits.MAX_BASES);
    const read = (basis: Value): Basis => readBasis(basis, channels, encoded, accessor, pictureView);
    return { channels, ...mean, bases: bases.map(read) };
  });
  let [decoded, textures] = [0, 0];
  for (const { channels, meanSize, bases } of planes) {
    decoded += 4 * channels * (meanSize ? meanSize[0] * meanSize[1] : 0);
    for (const { size, count } of bases) {
      decoded += size[0] * size[1] * channels * count;
      textures += count;
    }
  }
  if (textures > limits.MAX_COMPONENTS) {
    throw extension.key("planes").wrong(`more than ${limits.MAX_COMPONENTS} textures`);
  }
  if (decoded > limits.MAX_DECODED) throw extension.key("planes").wrong("too large when it is decoded");
  return planes;
}

/** What makes R, G and B of the channels; one plane of one or three channels needs nothing for it. */
export function readColours(extension: Value, planes: Plane[]): [number, number, number][] {
  const total = planes.reduce((sum, { channels }) => sum + channels, 0);
  const matrix = extension.key("toRGB");
  if (matrix.exists) {
    const rows = matrix.numbers(3 * total);
    const entry = (row: number, channel: number): number => rows[row * total + channel] ?? 0;
    return Array.from({ length: total }, (_, k) => [entry(0, k), entry(1, k), entry(2, k)]);
  }
  if (planes.length === 1 && total === 1) return [[1, 1, 1]];
  if (planes.length === 1 && total === 3) return [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const what = planes.length > 1 ? `${planes.length} planes` : `${total} channels`;
  throw unsupported(`${what} and no colours for them`, `${extension.where}/planes`);
}

/** A picture of one or `textures` textures: as many scales and zeros as they have channels. */
function readPicture(value: Value, channels: number, textures: number, pictureView: PictureView): Picture {
  const mimeType = value.key("mimeType").text(limits.MAX_NAME);
  if (!/^image\/(png|jpeg|webp|avif)$/.test(mimeType)) throw value.key("mimeType").wrong("an unknown type");
  return {
    view: pictureView(value.key("bufferView")),
    mimeType,
    scale: value.key("scale").numbers(channels * textures),
    zero: value.key("zero").numbers(channels * textures),
    textures,
    where: value.where,
  };
}

function readMean(
  plane: Value,
  channels: number,
  preview: number | null,
  pictureView: PictureView,
): { mean: Picture; meanSize: [number, number] | null } {
  const own = plane.key("mean");
  const plain = { scale: Array<number>(channels).fill(1 / 255), zero: Array<number>(channels).fill(0) };
  if (!own.exists) {
    if (preview === null || (channels !== 1 && channels !== 3)) throw own.wrong("no mean");
    const mean = { view: preview, mimeType: "image/png", ...plain, textures: 1, where: "/images/0" };
    return { mean, meanSize: null };
  }
  const meanSize = readSize(own.key("size"));
  const coded = own.key("scale").exists || own.key("zero").exists;
  const complete = coded ? own : new Value({ ...own.object(), ...plain }, own.where);
  const mean = readPicture(complete, channels, 1, pictureView);
  checkRows(own, channels, meanSize, 1);
  return { mean, meanSize };
}

function readBasis(
  basis: Value,
  channels: number,
  encoded: number,
  accessor: AccessorReader,
  pictureView: PictureView,
): Basis {
  const size = readSize(basis.key("size"));
  const [grid, corner] = [basis.key("grid"), basis.key("corner")];
  const whole = grid.exists ? readSize(grid) : size;
  const [column = 0, row = 0] = corner.exists ? corner.numbers(2, 0, limits.MAX_SIDE) : [];
  if (!Number.isInteger(column) || !Number.isInteger(row)) throw corner.wrong("no whole numbers");
  if (column + size[0] > whole[0] || row + size[1] > whole[1]) throw basis.wrong("textures beyond their grid");
  let count = 0;
  const pictures = basis.key("textures").items(limits.MAX_COMPONENTS).map((picture) => {
    const several = picture.key("count");
    const textures = several.exists ? several.integer(1, limits.MAX_COMPONENTS) : 1;
    count += textures;
    checkRows(picture, channels, size, textures);
    return readPicture(picture, channels, textures, pictureView);
  });
  if (count > limits.MAX_COMPONENTS) throw basis.wrong(`more than ${limits.MAX_COMPONENTS} textures`);
  const weights = count ? accessor(basis.key("weights"), "SCALAR", [FLOAT], encoded * count) : null;
  return { size, grid: whole, corner: [column, row], pictures, count, weights, where: basis.where };
}

/** Rows of a picture of textures of `height`: three channels are R, G and B, others lie one below the other. */
export function rowsOf(channels: number, height: number, textures: number): number {
  return (channels === 3 ? 1 : channels) * height * textures;
}

function checkRows(picture: Value, channels: number, [width, height]: [number, number], textures: number): void {
  const rows = rowsOf(channels, height, textures);
  if (rows > height && rows > limits.MAX_STACKED) throw picture.wrong(`a picture of ${rows} rows`);
  if (width * rows > limits.MAX_TEXELS) throw picture.wrong(`more than ${limits.MAX_TEXELS} texels`);
}
