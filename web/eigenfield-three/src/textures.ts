import { ExternalTexture, type WebGLRenderer } from "three";
import { decodePicture } from "./decode.js";
import type { SceneDocument } from "./document.js";
import { SceneError } from "./errors.js";
import * as gpu from "./gpu.js";
import type { ViewBytes } from "./info.js";
import { defaultMemory, layersOf, makePlan, type Plan } from "./memory.js";
import type { EigenfieldOptions } from "./options.js";
import { makePacker, type Packer } from "./packing.js";

const AHEAD = 3; // pictures decoded at a time

/**
 * The textures of a scene on a GPU: as many as fit, the mean first, eigen textures in order. Compressed pictures stay
 * in memory, decoded ones do not, and are decoded again when a lost context comes back.
 */
export class Textures {
  readonly mean = new ExternalTexture();
  readonly eigen = new ExternalTexture();
  plan: Plan | null = null;
  loaded = 0;

  onPlan: (plan: Plan) => void = () => undefined;
  onTexture: () => void = () => undefined;
  onComplete: () => void = () => undefined;
  onError: (reason: unknown) => void = () => undefined;

  private renderer: WebGLRenderer | null = null;
  private packer: Packer | null = null; // while eigen textures arrive
  private bitmap: ImageBitmap | null; // the mean, until it is on the GPU
  private readonly meanSize: [number, number];
  private turn = 0; // of loading: an older one stops
  private disposed = false;

  /** `geometry`: bytes of the mesh, which count too. */
  constructor(
    private readonly parts: { scene: SceneDocument; bytes: ViewBytes; mean: ImageBitmap },
    private readonly geometry: number,
    private readonly options: EigenfieldOptions,
  ) {
    this.bitmap = parts.mean;
    this.meanSize = [parts.mean.width, parts.mean.height];
  }

  /** Whether there is nothing to attach any more. */
  get attached(): boolean {
    return this.renderer !== null || this.disposed;
  }

  /** Loads everything for a renderer, again if it was there. What can be drawn at once is there on return. */
  attach(renderer: WebGLRenderer): void {
    if (this.disposed) return;
    const gl = renderer.getContext();
    if (!(gl instanceof WebGL2RenderingContext)) {
      throw new SceneError("unsupported", "Eigen textures need WebGL 2; use a newer browser.");
    }
    this.detach();
    this.renderer = renderer;
    renderer.domElement.addEventListener("webglcontextlost", this.onLost);
    renderer.domElement.addEventListener("webglcontextrestored", this.onRestored);
    const turn = this.turn;
    this.load(gl, turn).catch((reason: unknown) => {
      if (turn === this.turn) this.onError(reason);
    });
  }

  dispose(): void {
    this.detach();
    this.disposed = true;
    this.bitmap?.close();
    this.bitmap = null;
  }

  private detach(): void {
    this.turn += 1;
    this.loaded = 0;
    const gl = this.renderer?.getContext();
    this.freePacker();
    for (const texture of [this.mean, this.eigen]) {
      if (gl && texture.sourceTexture instanceof WebGLTexture) gl.deleteTexture(texture.sourceTexture);
      texture.sourceTexture = null;
    }
    this.renderer?.domElement.removeEventListener("webglcontextlost", this.onLost);
    this.renderer?.domElement.removeEventListener("webglcontextrestored", this.onRestored);
    this.renderer = null;
  }

  private readonly onLost = (): void => {
    this.turn += 1;
    this.loaded = 0;
    this.mean.sourceTexture = this.eigen.sourceTexture = null;
    this.packer = null; // its objects went with the context
  };

  private readonly onRestored = (): void => {
    if (this.renderer) this.attach(this.renderer);
  };

  private async load(gl: WebGL2RenderingContext, turn: number): Promise<void> {
    const { array, packer, plan } = this.makeRoom(gl);
    this.plan = plan;
    this.packer = packer;
    this.eigen.sourceTexture = array;
    this.onPlan(plan);
    await this.loadMean(gl, turn, plan.meanDown);
    const queue: Promise<ImageBitmap>[] = [];
    try {
      for (let j = 0; j < plan.usable; j++) {
        while (queue.length < AHEAD && j + queue.length < plan.usable) {
          queue.push(this.decode(j + queue.length, plan.scaleDown));
        }
        const bitmap = await queue[0];
        queue.shift();
        if (turn === this.turn && bitmap) packer.put(bitmap, j);
        bitmap?.close();
        if (turn !== this.turn) return;
        this.loaded = j + 1;
        this.onTexture();
      }
    } finally {
      for (const left of queue) left.then((bitmap) => bitmap.close()).catch(() => undefined);
    }
    if (turn !== this.turn) return;
    this.freePacker();
    gpu.finishArray(gl, array);
    this.onComplete();
  }

  /** Room for the eigen textures, within the memory that may be used and that there is. */
  private makeRoom(gl: WebGL2RenderingContext): { array: WebGLTexture; packer: Packer; plan: Plan } {
    const { size, textures, channels } = this.parts.scene;
    const needs = { mean: this.meanSize, size, channels, total: textures.length, geometry: this.geometry };
    for (let memory = this.options.memory ?? defaultMemory(); ; memory /= 2) {
      const plan = makePlan(needs, gpu.deviceLimits(gl, memory));
      const [width, height] = plan.usable ? size : [1, 1];
      const [w, h] = [Math.ceil(width / plan.scaleDown), Math.ceil(height / plan.scaleDown)];
      const [array, picture] = [gpu.makeArray(gl, w, h, layersOf(plan.usable, channels)), gpu.makeRoom(gl, w, h)];
      if (array && picture) return { array, packer: makePacker(gl, array, picture, channels), plan };
      gl.deleteTexture(array);
      gl.deleteTexture(picture);
      if (!plan.usable) {
        throw new SceneError("unsupported", "The graphics memory is full; close other pages and try again.");
      }
    }
  }

  private freePacker(): void {
    this.packer?.free();
    this.packer = null;
  }

  /** At once if it is decoded and needs no resizing: the first draw shows it. */
  private async loadMean(gl: WebGL2RenderingContext, turn: number, down: number): Promise<void> {
    const { scene, bytes } = this.parts;
    let { bitmap } = this;
    this.bitmap = null;
    if (!bitmap || down > 1) {
      bitmap?.close();
      bitmap = await decodePicture(await bytes(scene.mean.view), scene.mean, scene.meanSize, down);
    }
    if (turn === this.turn) this.mean.sourceTexture = gpu.makeTexture(gl, bitmap);
    bitmap.close();
  }

  private decode(index: number, down: number): Promise<ImageBitmap> {
    const { scene, bytes } = this.parts;
    const picture = scene.textures[index];
    if (!picture) return Promise.reject(new RangeError(`no eigen texture ${index}`));
    const decoded = bytes(picture.view).then((data) => decodePicture(data, picture, scene.size, down));
    decoded.catch(() => undefined); // awaited later, or not at all
    return decoded;
  }
}
