import { ExternalTexture, type BufferGeometry, type WebGLRenderer } from "three";
import { stillsOf, type SceneDocument } from "./document.js";
import { SceneError } from "./errors.js";
import * as gpu from "./gpu.js";
import type { SceneInfo } from "./info.js";
import type { Mean } from "./means.js";
import * as memory from "./memory.js";
import type { EigenfieldOptions } from "./options.js";
import { makePacker, type Aim, type Fineness, type Packer, type Slot } from "./packing.js";
import type { Codes, Piece } from "./pieces.js";
import { codeStep, hasTenBits, unitOf, type Basis, type Picture } from "./planes.js";
import type { Surface } from "./surface.js";
import type { Filling, TextureSource } from "./texture-source.js";

/** What says how large the textures of a field are. */
export interface TextureParts {
  scene: SceneDocument;
  info: SceneInfo;
  meanSizes: memory.Size[]; // of each plane, and of the opacity
}

/** The textures of a scene on a GPU: as many as fit. A source fills them, again after a lost context has come back. */
export class Textures {
  readonly means: ExternalTexture[]; // of each plane, and of the opacity
  readonly bases: ExternalTexture[]; // of all planes
  readonly ready: boolean[][]; // each texture of each basis
  plan: memory.Plan | null = null;
  version = 0; // grows with what is there to be summed

  onPlan: (plan: memory.Plan) => void = () => undefined;
  onTexture: () => void = () => undefined;
  onComplete: () => void = () => undefined;
  onError: (reason: unknown) => void = () => undefined;

  readonly needs: memory.Needs;
  private readonly layout: (Basis & { channels: number; tenBits: boolean })[]; // of `bases`
  private readonly stillVersions: number[]; // at which each of `means` was put; 0: it is not there
  private renderer: WebGLRenderer | null = null;
  private packer: Packer | null = null; // while textures arrive
  private turn = new AbortController(); // of loading: aborted when what is loaded is on the GPU no more
  private disposed = false;

  /** `surface`: its mesh has the charts and takes memory too. */
  constructor(
    private readonly parts: TextureParts,
    private readonly source: TextureSource,
    private readonly surface: Surface,
    private readonly options: EigenfieldOptions,
  ) {
    const { scene, info, meanSizes } = parts;
    const bases = scene.planes.flatMap(({ channels, bases }) =>
      bases.map((basis) => ({ ...basis, channels, tenBits: hasTenBits(basis.pictures) })),
    );
    this.layout = bases;
    const means = stillsOf(scene).map(({ channels, mean }, i): memory.Needs["means"][number] => {
      const opacity = i === scene.planes.length;
      return { size: meanSizes[i] ?? [1, 1], channels, pieces: mean.pieces, tenBits: hasTenBits([mean]), opacity };
    });
    const films = stillsOf(scene).some(({ mean }) => mean.part);
    const geometry = geometryBytes(surface.geometry);
    this.needs = { atlas: info.size, means, bases, films, rays: info.facesPlane, geometry };
    this.means = means.map(() => new ExternalTexture());
    this.bases = bases.map(() => new ExternalTexture());
    this.ready = bases.map(({ count }) => Array<boolean>(count).fill(false));
    this.stillVersions = means.map(() => 0);
  }

  get hasMeans(): boolean {
    return this.stillVersions.every((version) => version > 0);
  }

  /** `version` at which the opacity of sheets was put; 0: it is not there. */
  get opacityVersion(): number {
    return this.stillVersions[this.parts.scene.planes.length] ?? 0;
  }

  /** Eigen textures of each basis that are there, as far as none of a smaller rank is missing. */
  get loaded(): number {
    const first = this.ready.map((own) => own.indexOf(false)).filter((rank) => rank >= 0);
    const most = Math.max(0, ...this.ready.map((own) => own.length));
    return Math.min(most, ...first);
  }

  /** Bytes on the GPU: of the textures, what is composed of them, and the geometry. */
  get bytes(): number {
    return this.plan ? this.plan.bytes - this.needs.geometry + geometryBytes(this.surface.geometry) : 0;
  }

  /** Whether there is nothing to attach for what this renderer draws. One whose context is gone gives way to another. */
  serves(renderer: WebGLRenderer): boolean {
    if (this.disposed || this.renderer === renderer) return true;
    return this.renderer !== null && !this.renderer.getContext().isContextLost();
  }

  /** Loads everything for a renderer, again if it was there. What can be drawn at once is there on return. */
  attach(renderer: WebGLRenderer): void {
    if (this.disposed) return;
    this.detach();
    this.renderer = renderer;
    renderer.domElement.addEventListener("webglcontextlost", this.forget);
    renderer.domElement.addEventListener("webglcontextrestored", this.onRestored);
    const { signal } = this.turn;
    this.load(renderer, signal).catch((reason: unknown) => {
      if (!signal.aborted) this.onError(reason);
    });
  }

  dispose(): void {
    this.detach();
    this.disposed = true;
    this.source.dispose();
  }

  private detach(): void {
    const gl = this.renderer?.getContext();
    this.packer?.free();
    this.renderer?.domElement.removeEventListener("webglcontextlost", this.forget);
    this.renderer?.domElement.removeEventListener("webglcontextrestored", this.onRestored);
    this.renderer = null;
    for (const { sourceTexture } of [...this.means, ...this.bases]) {
      if (gl && sourceTexture instanceof WebGLTexture) gl.deleteTexture(sourceTexture);
    }
    this.forget();
  }

  /** What was on the GPU is there no more. */
  private readonly forget = (): void => {
    this.turn.abort();
    this.turn = new AbortController();
    this.version += 1;
    this.packer = null;
    this.stillVersions.fill(0);
    this.ready.forEach((own) => own.fill(false));
    for (const texture of [...this.means, ...this.bases]) texture.sourceTexture = null;
  };

  private readonly onRestored = (): void => {
    if (this.renderer) this.attach(this.renderer);
  };

  private async load(renderer: WebGLRenderer, signal: AbortSignal): Promise<void> {
    const gl = gpu.contextOf(renderer);
    if (gl.isContextLost()) return; // `onRestored` begins anew
    const { packer, plan } = this.makeRoom(gl);
    this.plan = plan;
    this.packer = packer;
    this.onPlan(plan);
    await this.source.fill(this.filling(gl, plan, signal));
    if (!signal.aborted) this.onComplete();
  }

  private filling(gl: WebGL2RenderingContext, plan: memory.Plan, signal: AbortSignal): Filling {
    return {
      plan,
      signal,
      putMean: (index, mean) => {
        if (!signal.aborted) this.putMean(gl, plan, index, mean);
      },
      putTextures: (basis, first, pieces, picture) => {
        if (!signal.aborted) this.putTextures(gl, plan, basis, first, pieces, picture);
      },
      announce: () => {
        if (!signal.aborted) this.onTexture();
      },
      end: () => {
        if (signal.aborted) return;
        this.packer?.free();
        this.packer = null;
      },
    };
  }

  private putTextures(
    gl: WebGL2RenderingContext,
    plan: memory.Plan,
    number: number,
    first: number,
    pieces: Piece[],
    picture: Picture,
  ): void {
    const { usable, scaleDown, halves, words } = plan;
    const [array, ready, basis] = [this.bases[number]?.sourceTexture, this.ready[number], this.layout[number]];
    if (!(array instanceof WebGLTexture) || !ready || !basis) return;
    const { size, grid, corner, channels, tenBits } = basis;
    if (words) gpu.putWords(gl, array, channels * first, codesOf(pieces.slice(0, channels * (usable - first))));
    const unit = unitOf(picture, halves && tenBits);
    const aim = { size: memory.smaller(size, scaleDown), grid, corner, unit, codes: 255 * codeStep(picture) };
    for (let j = first; j < Math.min(first + picture.textures, usable); j++) {
      const own = pieces.slice((j - first) * picture.pieces, (j - first + 1) * picture.pieces);
      const layer = channels * Math.floor(j / 4);
      if (!words) this.put(own, array, channels, aim, (channel) => ({ layer: layer + channel, component: j % 4 }));
      ready[j] = true;
    }
    this.version += 1;
  }

  private putMean(gl: WebGL2RenderingContext, plan: memory.Plan, index: number, { pieces, precision }: Mean): void {
    const [array, still] = [this.means[index]?.sourceTexture, stillsOf(this.parts.scene)[index]];
    const { size: grid, tenBits } = this.needs.means[index] ?? {};
    if (!(array instanceof WebGLTexture) || !still || !grid) return;
    this.stillVersions[index] = this.version += 1;
    if (plan.words) return gpu.putWords(gl, array, 0, codesOf(pieces));
    const { mean, channels } = still;
    const size = memory.smaller(grid, plan.meanDown);
    const [first] = pieces;
    const whole = first && pieces.length === 1 && "close" in first.picture;
    if (whole && !tenBits && size.join() === grid.join()) {
      gpu.putPicture(gl, array, first.picture as ImageBitmap, channels);
      return;
    }
    const aim: Aim = { size, grid, corner: [0, 0], unit: unitOf(mean, tenBits === true), codes: 255 * codeStep(mean) };
    const place = (channel: number) => ({ layer: Math.floor(channel / 4), component: channel % 4 });
    this.put(pieces, array, channels, aim, place, (i) => precision && { precision, zero: mean.zero[i] ?? 0 });
  }

  /** Puts the pieces of a texture, which are R, G and B together or one channel each, where its channels go. */
  private put(
    pieces: Piece[],
    array: WebGLTexture,
    channels: number,
    aim: Aim,
    placeOf: (channel: number) => Pick<Slot, "layer" | "component">,
    finenessOf: (index: number) => Fineness | null = () => null,
  ): void {
    const together = pieces.length < channels; // R, G and B
    pieces.forEach((piece, i) => {
      const slots = (together ? [0, 1, 2] : [i]).map((channel): Slot => {
        return { channel: together ? channel : 0, ...placeOf(channel) };
      });
      this.packer?.put(piece, array, slots, aim, finenessOf(i));
    });
  }

  /** Room for all textures, within the memory that may be used and that there is. */
  private makeRoom(gl: WebGL2RenderingContext): { packer: Packer | null; plan: memory.Plan } {
    const { means, bases } = this.needs;
    this.needs.geometry = geometryBytes(this.surface.geometry);
    const precisions = this.parts.scene.planes.flatMap(({ precision }) => (precision ? [precision.size] : []));
    for (let allowed = this.options.memory ?? memory.defaultMemory(); ; allowed /= 2) {
      const plan = memory.makePlan(this.needs, gpu.deviceLimits(gl, allowed));
      const { meanDown, scaleDown, usable, halves, words } = plan;
      const between = meanDown !== scaleDown; // texels of what is composed are none of what is stored
      const made = [
        ...means.map(({ size, channels, tenBits }) => {
          if (words) return gpu.makeArray(gl, size, channels, false, memory.WORDS);
          const format = { components: channels, halves: tenBits };
          return gpu.makeArray(gl, memory.smaller(size, meanDown), memory.meanLayers(channels), false, format);
        }),
        ...bases.map(({ size, channels, count, tenBits }) => {
          const used = Math.min(count, usable);
          if (words && used) return gpu.makeArray(gl, size, channels * used, false, memory.WORDS);
          return gpu.makeArray(
            gl,
            used ? memory.smaller(size, scaleDown) : [1, 1],
            used ? memory.layersOf(used, channels) : 1,
            between,
            { components: Math.max(1, used), halves: halves && tenBits },
          );
        }),
      ];
      const store = (): void => {
        [...this.means, ...this.bases].forEach((texture, i) => (texture.sourceTexture = made[i] ?? null));
      };
      if (words && !made.includes(null)) {
        store();
        return { packer: null, plan };
      }
      const rooms = memory.roomsOf(this.needs, plan, allowed);
      const [picture, codes, smaller] = [rooms.picture, rooms.codes, rooms.smaller].map((room) =>
        room ? gpu.makeRoom(gl, room.size, room.format) : null,
      );
      const precision = gpu.makeRoom(gl, memory.covering(precisions), memory.PICTURE);
      if (picture && precision && (codes || !rooms.codes) && (smaller || !rooms.smaller) && !made.includes(null)) {
        store();
        const own = { picture, codes: codes ?? null, precision, smaller: smaller ?? null };
        return { packer: makePacker(gl, own, rooms.picture.size[1], this.surface), plan };
      }
      for (const texture of [...made, picture, codes, smaller, precision]) gl.deleteTexture(texture ?? null);
      if (!usable) {
        throw new SceneError("unsupported", "The graphics memory is full; close other pages and try again.");
      }
    }
  }
}

/** What films give. */
function codesOf(pieces: Piece[]): Codes[] {
  return pieces.map(({ picture }) => picture as Codes);
}

function geometryBytes({ attributes, index }: BufferGeometry): number {
  const own = Object.values(attributes).reduce((sum, attribute) => sum + attribute.array.byteLength, 0);
  return own + (index?.array.byteLength ?? 0);
}
