// Planes of a scene's document, checked: means, bases, and the pictures that hold them.

import { FLOAT, streamOf, type Accessor, type AccessorReader, type Stream, type ViewReader } from "./accessors.js";
import { CODECS, codecOf, pictureCodec, type Codec } from "./codecs.js";
import { SceneError } from "./errors.js";
import type { FilmPart } from "./film-codes.js";
import { Value } from "./json.js";
import * as limits from "./limits.js";
import type { PictureFile } from "./pieces.js";
import type * as schema from "./schema.js";

const EIGHT = 8; // bits of a code unless a picture says otherwise
const MOST_BITS = 16;
const KEY_PICTURE = "av1-10bit-2"; // what the first unit of a film is too

/** One or several textures: value = (code - zero) * scale. */
export interface Picture extends PictureFile {
  codec: Codec<"picture">;
  scale: number[]; // of each channel of each texture; of a clip those of the group that is shown
  zero: number[];
  part: FilmPart | null; // null: a picture of its own in the file; else `view` is none
}

/** A small grey picture over all of a mean: value = (code - zero) * scale / p, p = (its own code + 1) / 256. */
export interface Precision extends PictureFile {
  codec: Codec<"picture">;
  size: [number, number];
}

/** What has one picture for all views: a plane's mean, the opacity of sheets. */
export interface Still {
  channels: number;
  mean: Picture;
  meanSize: [number, number] | null; // null: `images[0]`, whose header says it
  precision: Precision | null; // of the mean; null: 1 everywhere
}

/** Eigen textures of one plane and size, and the cameras' weights of them. */
export interface Basis {
  size: [number, number]; // of each texture
  grid: [number, number]; // of the whole atlas at this density
  corner: [number, number]; // column and row of the grid at which the textures begin
  pictures: Picture[];
  count: number; // textures
  weights: Accessor | Stream<"weights"> | null; // null: no textures, or those of a clip, whose groups have weights
  where: string;
}

export interface Plane extends Still {
  bases: Basis[];
}

function unsupported(what: string, where: string): SceneError {
  const message = `The scene has ${what}, which this viewer does not draw; draw it with "eigenfield render".`;
  return new SceneError("unsupported", message, where);
}

function readSize(value: Value, most = limits.MAX_SIDE): [number, number] {
  const [width = 0, height = 0] = value.items(2).map((item) => item.integer(1, most));
  if (!width || !height) throw value.wrong("two numbers are needed");
  if (width * height > limits.MAX_TEXELS) throw value.wrong(`more than ${limits.MAX_TEXELS} texels`);
  return [width, height];
}

export function readPlanes(
  extension: Value<schema.SceneJson>,
  encoded: number,
  preview: number | null,
  accessor: AccessorReader,
  viewOf: ViewReader,
): Plane[] {
  const listed = extension.key("planes").items(limits.MAX_PLANES);
  if (!listed.length) throw extension.key("planes").wrong("no plane");
  const planes = listed.map((plane, i): Plane => {
    const channels = plane.key("channels").integer(1, limits.MAX_CHANNELS);
    const mean = readMean(plane, channels, i === 0 ? preview : null, viewOf);
    const bases = plane.key("bases").items(limits.MAX_BASES);
    const read = (basis: Value<schema.BasisJson>): Basis => readBasis(basis, channels, encoded, accessor, viewOf);
    return { channels, ...mean, bases: bases.map(read) };
  });
  let [decoded, textures] = [0, 0];
  for (const { channels, meanSize, bases } of planes) {
    decoded += 4 * channels * (meanSize ? meanSize[0] * meanSize[1] : 0);
    for (const { size, count, pictures } of bases) {
      const bytes = pictures.reduce((sum, { textures, codec }) => sum + textures * (codec.bits === EIGHT ? 1 : 2), 0);
      decoded += size[0] * size[1] * channels * bytes;
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
export function readColours(extension: Value<schema.SceneJson>, planes: Plane[]): [number, number, number][] {
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

/** A picture of one or `textures` textures of `size`, if that is known. `plain`: code / 255 unless it says more. */
function readPicture(
  value: Value<schema.MeanJson | schema.TextureJson>,
  channels: number,
  textures: number,
  size: [number, number] | null,
  viewOf: ViewReader,
  plain = false,
): Picture {
  const codec = formatOf(value);
  const pieces = channels === 3 && codec.bits === EIGHT ? 1 : channels;
  if (size) checkRows(value, pieces * textures, size);
  const [scale, zero] = [value.key("scale"), value.key("zero")];
  const made = { view: viewOf(value.key("bufferView")), codec, textures, pieces, where: value.where, part: null };
  if (plain && codec.bits === EIGHT && !scale.exists && !zero.exists) return { ...made, ...asTheyAre(channels) };
  return { ...made, scale: numbersOf(scale, channels, textures), zero: numbersOf(zero, channels, textures) };
}

/** What a picture's type and bits say it is, and its codec if it names one. */
function formatOf(value: Value<schema.MeanJson | schema.TextureJson | schema.OpacityJson>): Codec<"picture"> {
  const mimeType = value.key("mimeType").text(limits.MAX_NAME);
  if (!pictureCodec(mimeType)) throw value.key("mimeType").wrong("an unknown type");
  const depth = value.key("bits");
  const bits = depth.exists ? depth.integer(1, MOST_BITS) : EIGHT;
  const usual = pictureCodec(mimeType, bits);
  if (!usual) throw depth.wrong(`${bits} bits of ${mimeType}`);
  const named = value.key("codec");
  const codec = codecOf("picture", named, usual);
  if (codec.mimeType !== mimeType || codec.bits !== bits) throw named.wrong(`${bits} bits of ${mimeType}`);
  return codec;
}

/** Textures in a film, `channels` to each; a group says what their codes stand for. */
function readInFilm(
  value: Value<schema.MeanJson | schema.BasisJson | schema.OpacityJson>,
  channels: number,
  size: [number, number],
): Picture {
  const places = value.key("at").items(limits.MAX_COMPONENTS * channels).map((place): [number, number] => {
    const [left = 0, top = 0] = place.numbers(2, 0, limits.MAX_FILM_SIDE);
    if (!Number.isInteger(left) || !Number.isInteger(top)) throw place.wrong("no whole numbers");
    return [left, top];
  });
  if (!places.length || places.length % channels) throw value.key("at").wrong(`places of ${channels} channels are needed`);
  const { where } = value;
  const part = { film: value.key("film").integer(0, limits.MAX_FILMS - 1), size, at: places, where };
  const none = { scale: Array<number>(places.length).fill(0), zero: Array<number>(places.length).fill(0) };
  return { view: -1, codec: CODECS[KEY_PICTURE], textures: places.length / channels, pieces: channels, where, part, ...none };
}

/** As `readInFilm`, of a single texture. */
function readOneInFilm(
  value: Value<schema.MeanJson | schema.OpacityJson>,
  channels: number,
  size: [number, number],
): Picture {
  const one = readInFilm(value, channels, size);
  if (one.textures !== 1) throw value.key("at").wrong(`${channels} places are needed`);
  return one;
}

function asTheyAre(channels: number): Pick<Picture, "scale" | "zero"> {
  return { scale: Array<number>(channels).fill(1 / 255), zero: Array<number>(channels).fill(0) };
}

/** Whether some of the codes have more than 8 bits. */
export function hasTenBits(pictures: Picture[]): boolean {
  return pictures.some(({ codec }) => codec.bits > EIGHT);
}

/** What codes of 8 bits, as browsers decode them, are short of codes of `bits`. */
export function codeStep({ codec }: Picture): number {
  return (2 ** codec.bits - 1) / 255;
}

/** What is stored of a code of 1 of a picture: 1 where codes are kept as half-floats, else a 1 is the largest code. */
export function unitOf(picture: Picture, halves: boolean): number {
  return halves ? 1 : 1 / (255 * codeStep(picture));
}

/** A number of each channel of each texture, or of each channel of all. */
export function numbersOf(value: Value, channels: number, textures: number): number[] {
  const given = value.items(channels * textures).map((item) => item.number());
  if (given.length === channels * textures) return given;
  if (given.length !== channels) throw value.wrong(`${channels} or ${channels * textures} numbers are needed`);
  return Array<number[]>(textures).fill(given).flat();
}

function readMean(
  plane: Value<schema.PlaneJson>,
  channels: number,
  preview: number | null,
  viewOf: ViewReader,
): Omit<Still, "channels"> {
  const own = plane.key("mean");
  if (!own.exists) {
    if (preview === null || (channels !== 1 && channels !== 3)) throw own.wrong("no mean");
    const mean = { view: preview, codec: CODECS.png, textures: 1, pieces: 1, where: "/images/0", part: null };
    return { mean: { ...mean, ...asTheyAre(channels) }, meanSize: null, precision: null };
  }
  const meanSize = readSize(own.key("size"));
  if (own.key("film").exists) {
    return { mean: readOneInFilm(own, channels, meanSize), meanSize, precision: null };
  }
  const mean = readPicture(own, channels, 1, meanSize, viewOf, true);
  return { mean, meanSize, precision: readPrecision(own.key("precision"), mean, viewOf) };
}

/** The opacity of sheets: its largest code is opaque. */
export function readOpacity(value: Value<schema.OpacityJson>, viewOf: ViewReader): Still {
  const size = readSize(value.key("size"));
  const picture = (): Omit<Picture, "scale" | "zero"> => {
    const codec = formatOf(value);
    checkRows(value, 1, size);
    return { view: viewOf(value.key("bufferView")), codec, textures: 1, pieces: 1, where: value.where, part: null };
  };
  const made = value.key("film").exists ? readOneInFilm(value, 1, size) : picture();
  const mean = { ...made, scale: [1 / (2 ** made.codec.bits - 1)], zero: [0] };
  return { channels: 1, mean, meanSize: size, precision: null };
}

function readPrecision(value: Value<schema.PrecisionJson>, mean: Picture, viewOf: ViewReader): Precision | null {
  if (!value.exists) return null;
  if (mean.codec.bits === EIGHT) throw value.wrong(`of a mean of ${EIGHT} bits`);
  const size = readSize(value.key("size"), limits.MAX_PRECISION_SIDE);
  const codec = codecOf("picture", value.key("codec"), "png");
  if (codec !== CODECS.png) throw value.key("codec").wrong("no PNG");
  return { view: viewOf(value.key("bufferView")), codec, size, textures: 1, pieces: 1, where: value.where };
}

function readBasis(
  basis: Value<schema.BasisJson>,
  channels: number,
  encoded: number,
  accessor: AccessorReader,
  viewOf: ViewReader,
): Basis {
  const size = readSize(basis.key("size"));
  const [grid, corner] = [basis.key("grid"), basis.key("corner")];
  const whole = grid.exists ? readSize(grid) : size;
  const [column = 0, row = 0] = corner.exists ? corner.numbers(2, 0, limits.MAX_SIDE) : [];
  if (!Number.isInteger(column) || !Number.isInteger(row)) throw corner.wrong("no whole numbers");
  if (column + size[0] > whole[0] || row + size[1] > whole[1]) throw basis.wrong("textures beyond their grid");
  const where = basis.where;
  if (basis.key("film").exists) {
    const picture = readInFilm(basis, channels, size);
    const { textures: count } = picture;
    if (count > limits.MAX_COMPONENTS) throw basis.wrong(`more than ${limits.MAX_COMPONENTS} textures`);
    return { size, grid: whole, corner: [column, row], pictures: [picture], count, weights: null, where };
  }
  let count = 0;
  const common = basis.key("picture");
  const shared = common.exists ? common.object() : {};
  const pictures = basis.key("textures").items(limits.MAX_COMPONENTS).map((own) => {
    const picture = new Value<schema.TextureJson>({ ...shared, ...own.object() }, own.where);
    const several = picture.key("count");
    const textures = several.exists ? several.integer(1, limits.MAX_COMPONENTS) : 1;
    count += textures;
    return readPicture(picture, channels, textures, size, viewOf);
  });
  if (count > limits.MAX_COMPONENTS) throw basis.wrong(`more than ${limits.MAX_COMPONENTS} textures`);
  const coded = basis.key("codedWeights");
  const plain = (): Accessor => accessor(basis.key("weights"), "SCALAR", [FLOAT], encoded * count);
  const weights = count ? (coded.exists ? streamOf("weights", coded, viewOf) : plain()) : null;
  return { size, grid: whole, corner: [column, row], pictures, count, weights, where };
}

/** Checks a picture of so many pieces of width x height, one below the other. */
function checkRows(picture: Value, pieces: number, [width, height]: [number, number]): void {
  const rows = pieces * height;
  if (pieces > 1 && rows > limits.MAX_STACKED) throw picture.wrong(`a picture of ${rows} rows`);
  if (width * rows > limits.MAX_TEXELS) throw picture.wrong(`more than ${limits.MAX_TEXELS} texels`);
}
