import { ExternalTexture, type BufferGeometry, type WebGLRenderer } from "three";
import type { ViewBytes } from "./accessors.js";
import { stillsOf, type SceneDocument } from "./document.js";
import { SceneError } from "./errors.js";
import * as gpu from "./gpu.js";
import { atlasOf } from "./info.js";
import { closeMean, decodeMean, type Mean } from "./means.js";
import * as memory from "./memory.js";
import type { EigenfieldOptions } from "./options.js";
import { makePacker, type Aim, type Packer, type Slot } from "./packing.js";
import { closePieces, type Piece } from "./pieces.js";
import { codeStep, hasTenBits, unitOf, type Basis, type Picture, type Still } from "./planes.js";

const AHEAD = 3; // pictures decoded at a time

/** What the textures of a field are read from. */
export interface TextureParts {
  scene: SceneDocument;
  bytes: ViewBytes;
  means: Mean[]; // of each plane, and of the opacity
  meanSizes: [number, number][];
  rays: boolean; // weights may be looked up texel by texel
}

/** A picture of eigen textures: those from `first` of basis `basis`, counted over all planes. */
interface Entry {
  basis: Basis;
  number: number;
  channels: number;
  picture: Picture;
  first: number;
}

/**
 * The textures of a scene on a GPU: as many as fit, the means first, eigen textures by rank. Compressed pictures stay
 * in memory, decoded ones do not, and are decoded again when a lost context comes back.
 */
export class Textures {
  readonly means: ExternalTexture[]; // of each plane, and of the opacity
  readonly bases: ExternalTexture[]; // of all planes
  readonly ready: boolean[][]; // each texture of each basis
  plan: memory.Plan | null = null;
  hasMeans = false;
  version = 0; // grows with what is there to be summed

  onPlan: (plan: memory.Plan) => void = () => undefined;
  onTexture: () => void = () => undefined;
  onComplete: () => void = () => undefined;
  onError: (reason: unknown) => void = () => undefined;

  readonly needs: memory.Needs;
  private readonly entries: Entry[]; // by rank
  private renderer: WebGLRenderer | null = null;
  private packer: Packer | null = null; // while textures arrive
  private decoded: Mean[] | null; // the means, until they are on the GPU
  private turn = 0; // of loading: an older one stops
  private disposed = false;

  /** `geometry`: of the mesh, which has the charts and takes memory too. */
  constructor(
    private readonly parts: TextureParts,
    private readonly geometry: BufferGeometry,
    private readonly options: EigenfieldOptions,
  ) {
    const { scene, meanSizes, rays } = parts;
    this.decoded = parts.means;
    const bases = scene.planes.flatMap(({ channels, bases }) =>
      bases.map((basis) => ({ ...basis, channels, tenBits: hasTenBits(basis.pictures) })),
    );
    const means = stillsOf(scene).map(({ channels, mean }, i): memory.Needs["means"][number] => {
      return { size: meanSizes[i] ?? [1, 1], channels, pieces: mean.pieces, tenBits: hasTenBits([mean]) };
    });
    this.needs = { atlas: atlasOf(scene, meanSizes), means, bases, rays, geometry: geometryBytes(geometry) };
    this.means = means.map(() => new ExternalTexture());
    this.bases = bases.map(() => new ExternalTexture());
    this.ready = bases.map(({ count }) => Array<boolean>(count).fill(false));
    this.entries = bases.flatMap((basis, number) => {
      let next = 0;
      return basis.pictures.map((picture) => {
        const first = next;
        next += picture.textures;
        return { basis, number, channels: basis.channels, picture, first };
      });
    });
    this.entries.sort((a, b) => a.first - b.first || a.number - b.number);
  }

  /** Eigen textures of each basis that are there, as far as none of a smaller rank is missing. */
  get loaded(): number {
    const first = this.ready.map((own) => own.indexOf(false)).filter((rank) => rank >= 0);
    const most = Math.max(0, ...this.ready.map((own) => own.length));
    return Math.min(most, ...first);
  }

  /** Whether there is nothing to attach any more. */
  get attached(): boolean {
    return this.renderer !== null || this.disposed;
  }

  /** Loads everything for a renderer, again if it was there. What can be drawn at once is there on return. */
  attach(renderer: WebGLRenderer): void {
    if (this.disposed) return;
    this.detach();
    this.renderer = renderer;
    renderer.domElement.addEventListener("webglcontextlost", this.onLost);
    renderer.domElement.addEventListener("webglcontextrestored", this.onRestored);
    const turn = this.turn;
    this.load(renderer, turn).catch((reason: unknown) => {
      if (turn === this.turn) this.onError(reason);
    });
  }

  dispose(): void {
    this.detach();
    this.disposed = true;
    this.decoded?.forEach(closeMean);
    this.decoded = null;
  }

  private detach(): void {
    const gl = this.renderer?.getContext();
    this.packer?.free();
    this.renderer?.domElement.removeEventListener("webglcontextlost", this.onLost);
    this.renderer?.domElement.removeEventListener("webglcontextrestored", this.onRestored);
    this.renderer = null;
    for (const { sourceTexture } of [...this.means, ...this.bases]) {
      if (gl && sourceTexture instanceof WebGLTexture) gl.deleteTexture(sourceTexture);
    }
    this.forget();
  }

  /** What was on the GPU is there no more. */
  private readonly forget = (): void => {
    this.turn += 1;
    this.version += 1;
    this.packer = null;
    this.hasMeans = false;
    this.ready.forEach((own) => own.fill(false));
    for (const texture of [...this.means, ...this.bases]) texture.sourceTexture = null;
  };

  private readonly onLost = this.forget;

  private readonly onRestored = (): void => {
    if (this.renderer) this.attach(this.renderer);
  };

  private async load(renderer: WebGLRenderer, turn: number): Promise<void> {
    const gl = gpu.contextOf(renderer);
    if (gl.isContextLost()) return; // `onRestored` begins anew
    const { packer, plan } = this.makeRoom(gl);
    this.plan = plan;
    this.packer = packer;
    this.onPlan(plan);
    await this.loadMeans(gl, turn);
    if (turn !== this.turn) return;
    const wanted = this.entries.filter(({ first }) => first < plan.usable);
    const queue: Promise<Piece[]>[] = [];
    let next = 0;
    try {
      for (const entry of wanted) {
        while (queue.length < AHEAD && next < wanted.length) queue.push(this.decode(wanted[next++]));
        const pieces = (await queue[0]) ?? [];
        queue.shift();
        if (turn === this.turn) this.pack(pieces, entry, packer, plan);
        closePieces(pieces);
        if (turn !== this.turn) return;
        this.onTexture();
      }
    } finally {
      for (const left of queue) left.then(closePieces).catch(() => undefined);
    }
    packer.free();
    this.packer = null;
    this.onComplete();
  }

  private pack(pieces: Piece[], entry: Entry, packer: Packer, { usable, scaleDown, halves }: memory.Plan): void {
    const { basis, number, channels, first, picture } = entry;
    const array = this.bases[number]?.sourceTexture;
    const ready = this.ready[number];
    if (!(array instanceof WebGLTexture) || !ready) return;
    const { grid, corner } = basis;
    const unit = unitOf(picture, halves && hasTenBits(basis.pictures));
    const aim = { size: memory.smaller(basis.size, scaleDown), grid, corner, unit, codes: 255 * codeStep(picture) };
    const together = picture.pieces < channels; // R, G and B
    for (let j = first; j < Math.min(first + picture.textures, usable); j++) {
      for (let i = 0; i < picture.pieces; i++) {
        const layer = (channel: number): number => channels * Math.floor(j / 4) + channel;
        const slots = (together ? [0, 1, 2] : [i]).map((channel): Slot => {
          return { channel: together ? channel : 0, layer: layer(channel), component: j % 4 };
        });
        const piece = pieces[(j - first) * picture.pieces + i];
        if (piece) packer.put(piece, array, slots, aim);
      }
      ready[j] = true;
    }
    this.version += 1;
  }

  /** Room for all textures, within the memory that may be used and that there is. */
  private makeRoom(gl: WebGL2RenderingContext): { packer: Packer; plan: memory.Plan } {
    const { means, bases } = this.needs;
    const precisions = this.parts.scene.planes.flatMap(({ precision }) => (precision ? [precision.size] : []));
    for (let allowed = this.options.memory ?? memory.defaultMemory(); ; allowed /= 2) {
      const plan = memory.makePlan(this.needs, gpu.deviceLimits(gl, allowed));
      const { meanDown, scaleDown, usable, halves } = plan;
      const between = meanDown !== scaleDown; // texels of what is composed are none of what is stored
      const made = [
        ...means.map(({ size, channels, tenBits }) =>
          gpu.makeArray(gl, memory.smaller(size, meanDown), memory.meanLayers(channels), false, {
            components: channels,
            halves: tenBits,
          }),
        ),
        ...bases.map(({ size, channels, count, tenBits }) => {
          const used = Math.min(count, usable);
          return gpu.makeArray(
            gl,
            used ? memory.smaller(size, scaleDown) : [1, 1],
            used ? memory.layersOf(used, channels) : 1,
            between,
            { components: Math.max(1, used), halves: halves && tenBits },
          );
        }),
      ];
      const rooms = memory.roomsOf(this.needs, plan, allowed);
      const [picture, codes, smaller] = [rooms.picture, rooms.codes, rooms.smaller].map((room) =>
        room ? gpu.makeRoom(gl, room.size, room.format) : null,
      );
      const precision = gpu.makeRoom(gl, memory.covering(precisions), memory.PICTURE);
      if (picture && precision && (codes || !rooms.codes) && (smaller || !rooms.smaller) && !made.includes(null)) {
        [...this.means, ...this.bases].forEach((texture, i) => (texture.sourceTexture = made[i] ?? null));
        const own = { picture, codes: codes ?? null, precision, smaller: smaller ?? null };
        return { packer: makePacker(gl, own, rooms.picture.size[1], this.geometry), plan };
      }
      for (const texture of [...made, picture, codes, smaller, precision]) gl.deleteTexture(texture ?? null);
      if (!usable) {
        throw new SceneError("unsupported", "The graphics memory is full; close other pages and try again.");
      }
    }
  }

  /** At once if they are decoded: the first draw shows them. */
  private async loadMeans(gl: WebGL2RenderingContext, turn: number): Promise<void> {
    const { scene, bytes } = this.parts;
    const stills = stillsOf(scene);
    const decoded = this.decoded ?? (await Promise.all(stills.map((still) => decodeMean(still, bytes))));
    this.decoded = null;
    decoded.forEach((made, i) => {
      const array = this.means[i]?.sourceTexture;
      const still = stills[i];
      const { size } = this.needs.means[i] ?? {};
      if (turn === this.turn && still && size && array instanceof WebGLTexture) this.putMean(gl, made, still, size, array);
      closeMean(made);
    });
    if (turn !== this.turn) return;
    this.hasMeans = true;
    this.version += 1;
  }

  private putMean(gl: WebGL2RenderingContext, made: Mean, still: Still, grid: memory.Size, array: WebGLTexture): void {
    const { pieces, precision } = made;
    const { mean, channels } = still;
    const size = memory.smaller(grid, this.plan?.meanDown ?? 1);
    const halves = hasTenBits([mean]);
    const [first] = pieces;
    const whole = first && pieces.length === 1 && "close" in first.picture;
    if (whole && !halves && size.join() === grid.join()) {
      gpu.putPicture(gl, array, first.picture as ImageBitmap, channels);
      return;
    }
    const aim: Aim = { size, grid, corner: [0, 0], unit: unitOf(mean, halves), codes: 255 * codeStep(mean) };
    const together = pieces.length < channels; // R, G and B
    pieces.forEach((piece, i) => {
      const slots = (together ? [0, 1, 2] : [i]).map((channel): Slot => {
        return { channel: together ? channel : 0, layer: Math.floor(channel / 4), component: channel % 4 };
      });
      this.packer?.put(piece, array, slots, aim, precision && { precision, zero: mean.zero[i] ?? 0 });
    });
  }

  private decode(entry: Entry | undefined): Promise<Piece[]> {
    if (!entry) return Promise.reject(new RangeError("no such eigen texture"));
    const { basis, picture } = entry;
    const decoded = this.parts
      .bytes(picture.view)
      .then((data) => picture.codec.decode(data, picture, basis.size));
    decoded.catch(() => undefined); // awaited later, or not at all
    return decoded;
  }
}

function geometryBytes({ attributes, index }: BufferGeometry): number {
  const own = Object.values(attributes).reduce((sum, attribute) => sum + attribute.array.byteLength, 0);
  return own + (index?.array.byteLength ?? 0);
}
