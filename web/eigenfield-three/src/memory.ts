// What fits on the GPU: smaller eigen textures first, then fewer.

const MIPS = 4 / 3; // a texture with all its mips, relative to its largest level
const CODES = 4; // bytes of a texel of codes of 8 bits
const HALVES = 8; // bytes of a texel of half-floats, which hold codes of more bits too
const WORDS = 2; // bytes of a code of more than 8 bits before it is packed
export const MAP_SIDE = 129; // nodes of a weight map along X and Y
const MIB = 2 ** 20;

type Size = [number, number];

export interface DeviceLimits {
  side: number; // MAX_TEXTURE_SIZE
  layers: number; // MAX_ARRAY_TEXTURE_LAYERS
  memory: number; // bytes
}

export interface Needs {
  atlas: Size;
  // of planes, and of the opacity; pieces: pictures one below the other
  means: { size: Size; channels: number; pieces: number; tenBits: boolean }[];
  bases: { size: Size; grid: Size; channels: number; count: number; tenBits: boolean }[]; // codes of 10 bits
  rays: boolean; // weights may be looked up texel by texel
  geometry: number; // bytes
}

export interface Plan {
  meanDown: number; // the mean and what is composed have their side over this
  scaleDown: number; // eigen textures
  usable: number; // of each basis
  bytes: number;
  limitation: string | null;
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

/** The largest choice within the limits. */
export function makePlan(needs: Needs, limits: DeviceLimits): Plan {
  const total = Math.max(0, ...needs.bases.map(({ count }) => count));
  const channels = Math.max(1, ...needs.bases.map((basis) => basis.channels));
  const most = Math.min(total, 4 * Math.floor(limits.layers / channels));
  const meanDown = [1, 2, 4, 8, 16].find(
    (down) => Math.max(...needs.atlas) / down <= limits.side && composing(needs, down) <= limits.memory / 2,
  ) ?? 16;
  const fixed = composing(needs, meanDown) + needs.geometry;
  const bytes = (down: number, count: number): number => fixed + stored(needs, down, count);
  const hasRoom = (down: number, count: number): boolean =>
    bytes(down, count) + onTheWay(needs, down) <= limits.memory;
  const largest = Math.max(1, ...needs.bases.flatMap(({ size }) => size));
  const fits = (down: number): boolean => largest / down <= limits.side;
  const scaleDown = [1, 2, 4].find((down) => fits(down) && hasRoom(down, most)) ?? 4;
  let usable = fits(scaleDown) ? most : 0;
  while (usable > 0 && !hasRoom(scaleDown, usable)) usable--;
  const plan = { meanDown, scaleDown, usable, bytes: bytes(scaleDown, usable) };
  return { ...plan, limitation: sentence(plan, total, needs, limits) };
}

/** Bytes of means and opacity and of what is composed: the atlas with its mips, sums at other sizes, where texels lie. */
function composing(needs: Needs, down: number): number {
  const means = needs.means.map((mean) => bytesOf(mean) * meanLayers(mean.channels) * texels(mean.size, down));
  const sums = gridsOf(needs).map((size) => {
    const mips = size.join() === needs.atlas.join() ? MIPS : 1;
    const places = needs.rays && needs.bases.some(({ grid }) => grid.join() === size.join());
    return HALVES * texels(size, down) * (mips + (places ? 1 : 0));
  });
  return Math.round([...means, ...sums].reduce((a, b) => a + b, 0));
}

function bytesOf({ tenBits }: { tenBits: boolean }): number {
  return tenBits ? HALVES : CODES;
}

/** Bytes of the first `count` textures of each basis and of the maps of their weights. */
function stored({ bases, rays }: Needs, down: number, count: number): number {
  return bases.reduce((sum, basis) => {
    const used = Math.min(count, basis.count);
    if (!used) return sum;
    const maps = rays ? groupsOf(used) * MAP_SIDE * MAP_SIDE * HALVES : 0;
    return sum + bytesOf(basis) * layersOf(used, basis.channels) * texels(basis.size, down) + maps;
  }, 0);
}

/** Columns and rows of the largest piece of a picture that is packed while textures arrive. */
export function roomFor({ means, bases }: Pick<Needs, "means" | "bases">, meanDown: number, scaleDown: number): Size {
  const sizes = [
    ...means.filter(({ pieces, tenBits }) => pieces > 1 || tenBits).map(({ size }) => smaller(size, meanDown)),
    ...bases.filter(({ count }) => count > 0).map(({ size }) => smaller(size, scaleDown)),
  ];
  return covering(sizes);
}

/** Columns and rows in which each of some sizes fits. */
export function covering(sizes: Size[]): Size {
  return [Math.max(1, ...sizes.map(([width]) => width)), Math.max(1, ...sizes.map(([, height]) => height))];
}

function onTheWay(needs: Needs, down: number): number {
  const [width, height] = roomFor({ means: [], bases: needs.bases }, 1, down);
  return (CODES + (needs.bases.some(({ tenBits }) => tenBits) ? WORDS : 0)) * width * height;
}

function sentence(plan: Omit<Plan, "limitation">, total: number, needs: Needs, limits: DeviceLimits): string | null {
  const parts: string[] = [];
  if (plan.usable < total) parts.push(`${plan.usable} of ${total} eigen textures are drawn`);
  if (plan.usable && plan.scaleDown > 1) parts.push(`eigen textures have 1/${plan.scaleDown} of their size`);
  if (plan.meanDown > 1) parts.push(`the mean texture has 1/${plan.meanDown} of its size`);
  if (!parts.length) return null;
  const all = composing(needs, 1) + stored(needs, 1, total) + onTheWay(needs, 1) + needs.geometry;
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
