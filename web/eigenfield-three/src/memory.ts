// What fits on the GPU: smaller eigen textures first, then fewer.

const MIPS = 4 / 3; // a texture with all its mips, relative to its largest level
export const MAP_SIDE = 129; // nodes of a weight map along X and Y
const MIB = 2 ** 20;

export interface DeviceLimits {
  side: number; // MAX_TEXTURE_SIZE
  layers: number; // MAX_ARRAY_TEXTURE_LAYERS
  vectors: number; // MAX_FRAGMENT_UNIFORM_VECTORS
  memory: number; // bytes
}

export interface Needs {
  mean: [number, number];
  size: [number, number];
  channels: 1 | 3;
  total: number;
  geometry: number; // bytes
}

export interface Plan {
  meanDown: number;
  scaleDown: number;
  usable: number;
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

/** Bytes of an RGBA8 texture with its mips. */
export function textureBytes([width, height]: [number, number], down = 1): number {
  return Math.round(4 * MIPS * Math.ceil(width / down) * Math.ceil(height / down));
}

/** Layers of RGBA8 that hold `textures` of `channels`, four to a texel; at least those of one. */
export function layersOf(textures: number, channels: 1 | 3): number {
  return channels * Math.max(1, Math.ceil(textures / 4));
}

/** Bytes of the maps that hold the weights of `textures`. */
export function mapBytes(textures: number): number {
  return Math.max(1, Math.ceil(textures / 4)) * MAP_SIDE * MAP_SIDE * 8;
}

/** The largest choice within the limits. */
export function makePlan(needs: Needs, limits: DeviceLimits): Plan {
  const uniforms = Math.floor((limits.vectors - 40) / (2 * needs.channels + 1)); // scales, biases, weights of four
  const groups = Math.min(uniforms, Math.floor(limits.layers / needs.channels));
  const most = Math.max(0, Math.min(needs.total, 4 * groups));
  const meanDown = [1, 2, 4, 8, 16].find(
    (down) => Math.max(...needs.mean) / down <= limits.side && textureBytes(needs.mean, down) <= limits.memory / 2,
  ) ?? 16;
  const fixed = textureBytes(needs.mean, meanDown) + needs.geometry;
  const bytes = (down: number, count: number): number =>
    fixed + (count && layersOf(count, needs.channels) * textureBytes(needs.size, down)) + mapBytes(count);
  const hasRoom = (down: number, count: number): boolean =>
    bytes(down, count) + onTheWay(needs, down) <= limits.memory;
  const fits = (down: number): boolean => Math.max(...needs.size) / down <= limits.side;
  const scaleDown = [1, 2, 4].find((down) => fits(down) && hasRoom(down, most)) ?? 4;
  let usable = fits(scaleDown) ? most : 0;
  while (usable > 0 && !hasRoom(scaleDown, usable)) usable--;
  const plan = { meanDown, scaleDown, usable, bytes: bytes(scaleDown, usable) };
  return { ...plan, limitation: sentence(plan, needs, limits) };
}

/** Bytes of the picture that is being packed while textures arrive. */
function onTheWay({ size, total }: Needs, down: number): number {
  return total && 4 * Math.ceil(size[0] / down) * Math.ceil(size[1] / down);
}

function sentence(plan: Omit<Plan, "limitation">, needs: Needs, limits: DeviceLimits): string | null {
  const parts: string[] = [];
  if (plan.usable < needs.total) parts.push(`${plan.usable} of ${needs.total} eigen textures are drawn`);
  if (plan.usable && plan.scaleDown > 1) parts.push(`eigen textures have 1/${plan.scaleDown} of their size`);
  if (plan.meanDown > 1) parts.push(`the mean texture has 1/${plan.meanDown} of its size`);
  if (!parts.length) return null;
  const textures = textureBytes(needs.mean) + layersOf(needs.total, needs.channels) * textureBytes(needs.size);
  const all = textures + onTheWay(needs, 1) + needs.geometry + mapBytes(needs.total);
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
