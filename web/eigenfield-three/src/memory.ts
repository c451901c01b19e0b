// What fits on the GPU: eigen textures of fewer bits first, then smaller ones, then a smaller mean too, then fewer.

const MIPS = 4 / 3; // a texture with all its mips, relative to its largest level
const COMPOSED = bytesOf({ components: 4, halves: true }); // of a texel
export const PICTURE: Format = { components: 4, halves: false }; // as browsers decode it
export const WORDS: Format = { components: 2, halves: false }; // the two bytes of a code of more than 8 bits
const REDUCED: Format = { components: 2, halves: true }; // a value, and whether it is of a chart
const MOST_WORDS = 16; // channels in words, of which one draw sums four textures
export const MAP_SIDE = 129; // nodes of a weight map along X and Y
const MIB = 2 ** 20;
const ROOM_SHARE = 1 / 64; // of the memory, for rows of a picture that are packed at once
const ROOM_ROWS = 34; // at least: those of a row of the smallest textures, and two

export type Size = [number, number];

export interface DeviceLimits {
  side: number; // MAX_TEXTURE_SIZE
  layers: number; // MAX_ARRAY_TEXTURE_LAYERS
  memory: number; // bytes
}

export interface Needs {
  atlas: Size;
  // of planes, and of the opacity; pieces: pictures one below the other
  means: { size: Size; channels: number; pieces: number; tenBits: boolean; opacity?: boolean }[];
  bases: { size: Size; grid: Size; channels: number; count: number; tenBits: boolean }[]; // codes of 10 bits
  films: boolean; // each frame puts all of them anew, as codes of 10 bits
  rays: boolean; // weights may be looked up texel by texel
  geometry: number; // bytes
}

export interface Plan {
  meanDown: number; // the mean and what is composed have their side over this
  scaleDown: number; // eigen textures
  halves: boolean; // codes of eigen textures have all their bits, else 8
  words: boolean; // each channel of each texture has a layer of its own, with the two bytes of its codes
  usable: number; // of each basis
  bytes: number;
  reductions: Reduction[];
  limitation: string | null;
}

/** What a scene has less of than its file: eigen textures, their bits, their sides, or the mean's sides. */
export type Reduction =
  | { kind: "count"; part: number; whole: number }
  | { kind: "bits" }
  | { kind: "scale" | "mean"; percent: number };

/** Numbers that a texel holds: up to four, each in 8 bits, or as a half-float. */
export interface Format {
  components: number;
  halves: boolean;
}

/** Bytes of a texel. There is no format of three that can be drawn into everywhere. */
export function bytesOf({ components, halves }: Format): number {
  return (components > 2 ? 4 : components) * (halves ? 2 : 1);
}

/** GPU bytes that a scene may use where nobody says: by the device's own memory, less on phones and headsets. */
export function defaultMemory(): number {
  const device = typeof navigator === "undefined" ? undefined : navigator;
  const gibibytes = (device as { deviceMemory?: number } | undefined)?.deviceMemory;
  const agent = device?.userAgent ?? "";
  const mobile = /Mobi|Android|iPhone|iPad|Quest/i.test(agent) || (/Macintosh/.test(agent) && hasTouch(device));
  return mobile ? Math.min(gibibytes ?? 4, 6) * 128 * MIB : Math.min(gibibytes ?? 8, 8) * 256 * MIB;
}

function hasTouch(device: Navigator | undefined): boolean {
  return (device?.maxTouchPoints ?? 0) > 1; // an iPad that calls itself a Macintosh
}

/** A size `down` times smaller along each side. */
export function smaller([width, height]: Size, down: number): Size {
  return [Math.ceil(width / down), Math.ceil(height / down)];
}

function texels(size: Size, down: number): number {
  const [width, height] = smaller(size, down);
  return width * height;
}

/** Layers that hold a mean of `channels`, four to a texel. */
export function meanLayers(channels: number): number {
  return Math.ceil(channels / 4);
}

/** Layers that hold `textures` of `channels`, four to a texel; at least those of one. */
export function layersOf(textures: number, channels: number): number {
  return channels * groupsOf(textures);
}

/** Layers of the maps that hold the weights of `textures`. */
export function groupsOf(textures: number): number {
  return Math.max(1, Math.ceil(textures / 4));
}

/** The sizes at which sums are taken, each once, that of the atlas among them. */
export function gridsOf(needs: { atlas: Size; means: { size: Size }[]; bases: { grid: Size }[] }): Size[] {
  const { atlas, means, bases } = needs;
  const sizes = [atlas, ...means.map(({ size }) => size), ...bases.map(({ grid }) => grid)];
  return [...new Map(sizes.map((size) => [size.join(), size])).values()];
}

type Choice = Pick<Plan, "meanDown" | "scaleDown" | "halves" | "words">;

// In the order of what they cost a picture (decision 42). What is composed holds no more of eigen textures than its own
// texels, so that larger ones would be in vain.
const DOWNS = [1, 1.5, 2, 3, 4, 6, 8, 12, 16];
const WHOLE: Choice = { meanDown: 1, scaleDown: 1, halves: true, words: false };
const CHOICES: Choice[] = [
  WHOLE,
  ...DOWNS.flatMap((meanDown) =>
    [1, 1.5, 2].map((further) => ({ meanDown, scaleDown: further * meanDown, halves: false, words: false })),
  ),
];

/** The best choice within the limits. */
export function makePlan(needs: Needs, limits: DeviceLimits): Plan {
  const total = Math.max(0, ...needs.bases.map(({ count }) => count));
  const channels = Math.max(1, ...needs.bases.map((basis) => basis.channels));
  const most = Math.min(total, 4 * Math.floor(limits.layers / channels));
  const bytes = (choice: Choice, count: number): number =>
    composing(needs, choice.meanDown) + needs.geometry + stored(needs, choice, count);
  const hasRoom = (choice: Choice, count: number): boolean =>
    bytes(choice, count) + onTheWay(needs, choice, limits.memory) <= limits.memory;
  const largest = Math.max(1, ...needs.atlas, ...needs.bases.flatMap(({ size }) => size));
  const widest = Math.max(channels, ...needs.means.map((mean) => mean.channels));
  const fits = total * channels <= limits.layers && widest <= MOST_WORDS;
  const inWords = needs.films && fits ? [{ ...WHOLE, words: true }] : [];
  const possible = [...inWords, ...CHOICES].filter(({ meanDown }) => largest / meanDown <= limits.side);
  let usable = possible.length ? most : 0;
  let choice = possible.find((one) => hasRoom(one, usable));
  for (; !choice && usable > 0; usable--) choice = possible.find((one) => hasRoom(one, usable - 1));
  choice ??= CHOICES.at(-1)!;
  const reductions = reductionsOf({ ...choice, usable }, needs);
  const limitation = sentence(reductions, needs, limits);
  return { ...choice, usable, bytes: bytes(choice, usable), reductions, limitation };
}

/** Bytes of means and opacity and of what is composed: the atlas with its mips, sums at other sizes, where texels lie. */
function composing(needs: Needs, down: number): number {
  const means = needs.means.map(({ size, channels, tenBits, opacity }) => {
    const own = opacity ? COMPOSED : 0; // it is summed by itself
    return (bytesOf({ components: channels, halves: tenBits }) * meanLayers(channels) + own) * texels(size, down);
  });
  const sums = gridsOf({ ...needs, means: needs.means.filter(({ opacity }) => !opacity) }).map((size) => {
    const mips = size.join() === needs.atlas.join() ? MIPS : 1;
    const places = needs.rays && needs.bases.some(({ grid }) => grid.join() === size.join());
    return COMPOSED * texels(size, down) * (mips + (places ? 1 : 0));
  });
  return Math.round([...means, ...sums].reduce((a, b) => a + b, 0));
}

/** Bytes of the first `count` textures of each basis and of the maps of their weights. */
function stored({ bases, rays }: Needs, { scaleDown, halves }: Choice, count: number): number {
  return bases.reduce((sum, basis) => {
    const used = Math.min(count, basis.count);
    if (!used) return sum;
    const maps = rays ? groupsOf(used) * MAP_SIDE * MAP_SIDE * COMPOSED : 0;
    const texel = bytesOf({ components: used, halves: halves && basis.tenBits });
    return sum + texel * layersOf(used, basis.channels) * texels(basis.size, scaleDown) + maps;
  }, 0);
}

interface Room {
  size: Size;
  format: Format;
}

/** What is needed while textures arrive: room for rows of a picture, for codes of more than 8 bits, and for what becomes
 * smaller. */
export function roomsOf(
  { means, bases }: Pick<Needs, "means" | "bases">,
  { meanDown, scaleDown }: Pick<Plan, "meanDown" | "scaleDown">,
  memory: number,
): { picture: Room; codes: Room | null; smaller: Room | null } {
  const stills = means.filter(({ pieces, tenBits }) => pieces > 1 || tenBits || meanDown > 1);
  const own = bases.filter(({ count }) => count > 0);
  const [width, height] = covering([...stills, ...own].map(({ size }) => size));
  const rows = Math.floor((ROOM_SHARE * memory) / (bytesOf(PICTURE) * width));
  const size: Size = [width, Math.min(height, Math.max(ROOM_ROWS, rows))];
  const reduced = [
    ...(meanDown > 1 ? stills.map((mean) => smaller(mean.size, meanDown)) : []),
    ...(scaleDown > 1 ? own.map((basis) => smaller(basis.size, scaleDown)) : []),
  ];
  return {
    picture: { size, format: PICTURE },
    codes: [...stills, ...own].some(({ tenBits }) => tenBits) ? { size, format: WORDS } : null,
    smaller: reduced.length ? { size: covering(reduced), format: REDUCED } : null,
  };
}

/** Columns and rows in which each of some sizes fits. */
export function covering(sizes: Size[]): Size {
  return [Math.max(1, ...sizes.map(([width]) => width)), Math.max(1, ...sizes.map(([, height]) => height))];
}

/** Bytes while textures arrive: the rooms, and which texels of a grid lie in charts. */
function onTheWay(needs: Needs, choice: Choice, memory: number): number {
  if (choice.words) return 0;
  const rooms = Object.values(roomsOf(needs, choice, memory)) as (Room | null)[];
  const bytes = rooms.map((room) => (room ? bytesOf(room.format) * texels(room.size, 1) : 0));
  const charts = choice.scaleDown > 1 ? Math.max(...gridsOf(needs).map((size) => texels(size, 1))) : 0;
  return [...bytes, charts].reduce((a, b) => a + b, 0);
}

function reductionsOf({ usable, meanDown, scaleDown, halves }: Choice & { usable: number }, needs: Needs): Reduction[] {
  const whole = Math.max(0, ...needs.bases.map(({ count }) => count));
  const list: Reduction[] = [];
  if (usable < whole) list.push({ kind: "count", part: usable, whole });
  if (usable && scaleDown > 1) list.push({ kind: "scale", percent: Math.round(100 / scaleDown) });
  if (usable && !halves && needs.bases.some(({ tenBits }) => tenBits)) list.push({ kind: "bits" });
  if (meanDown > 1) list.push({ kind: "mean", percent: Math.round(100 / meanDown) });
  return list;
}

function sentence(reductions: Reduction[], needs: Needs, limits: DeviceLimits): string | null {
  if (!reductions.length) return null;
  const parts = reductions.map((one) => {
    if (one.kind === "count") return `${one.part} of ${one.whole} eigen textures are drawn`;
    if (one.kind === "bits") return "eigen textures have 8 bits";
    const what = one.kind === "mean" ? "the mean texture has" : "eigen textures have";
    return `${what} ${one.percent} % of ${one.kind === "mean" ? "its" : "their"} width and height`;
  });
  const all = composing(needs, 1) + stored(needs, WHOLE, Infinity) + onTheWay(needs, WHOLE, limits.memory) + needs.geometry;
  const why =
    all > limits.memory
      ? `the scene needs ${megabytes(all)} MB of graphics memory and ${megabytes(limits.memory)} MB may be used`
      : "this device's graphics allow no more";
  return `${capital(parts.join(", "))}: ${why}.`;
}

function megabytes(bytes: number): string {
  return (bytes / 1e6).toFixed(bytes < 1e7 ? 1 : 0);
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
