import {
  EventDispatcher,
  FrontSide,
  Matrix4,
  Texture,
  Vector3,
  type Camera,
  type DataArrayTexture,
  type Mesh,
  type WebGLRenderer,
} from "three";
import { SceneError, asSceneError } from "./errors.js";
import { medianFootprint } from "./footprint.js";
import { Composer, type Recipe } from "./composer.js";
import { basesOf, planeCoordinates, ranksOf, type CaptureCamera, type SceneInfo, type Vector } from "./info.js";
import { makeMaps } from "./maps.js";
import { FILTERS, VIEWS, makeMaterial, type Filter, type SurfaceMaterial } from "./material.js";
import type { EigenfieldOptions } from "./options.js";
import { opacityPart, partsOf } from "./parts.js";
import type { Reduction } from "./memory.js";
import { onPlane } from "./passes.js";
import { SheetStack } from "./sheet-stack.js";
import { eigenGain } from "./strength.js";
import { Textures, type TextureParts } from "./textures.js";
import type { Blend, Mixing, ViewWeights } from "./weights.js";

const ONE_SAMPLE = 1.5; // photograph pixels a pixel up to which the finest level is read
const ON_PLANE = 1e-3; // of the larger extent: an eye this near the view plane is on it

export interface FieldEvents {
  texture: {};
  complete: {};
  error: { error: SceneError };
  limited: {};
}

/** What the plug-in has read and checked when a field is made of it. */
export interface FieldParts extends TextureParts {
  info: SceneInfo;
  meshes: Mesh[]; // at least one
  omega: Float32Array; // (encoded cameras) x (eigen textures of all bases)
  weights: ViewWeights;
}

/**
 * A scene that draws itself: its mesh carries the material, and before each draw takes eye and weights for whichever
 * camera draws it. Eigen textures follow in the background once a renderer is known. The fields that can be set take
 * effect at the next draw; who draws on demand asks for one, and after each `texture` and `complete`.
 */
export class EigenField extends EventDispatcher<FieldEvents> {
  readonly mesh: Mesh;
  readonly info: SceneInfo;
  readonly total: number;
  count = Infinity;
  weightMode: "ray" | "eye";
  mixing: Mixing = "delaunay";
  filter: Filter;
  /** What is composed has its side over this: for slow devices, while something moves. */
  coarser: 1 | 2 | 4 = 1;
  camera: number | null = null;
  /** A camera whose exposure a view of a harmonised scene has. Without one: see `SceneInfo.mixedColours`. */
  exposure: number | null = null;
  view: keyof typeof VIEWS = "picture";
  eigen = 0;
  photograph: Texture | null = null;

  /** Eigen-texture weights of the last frame, one entry for each eye that was drawn. */
  lastWeights: Float64Array[] = [];
  /** Whether in the last draw each texel looked its own weights up. */
  lastByRay = false;
  /** All eigen textures are there; rejects with the SceneError of the `error` event. */
  readonly complete: Promise<void>;

  private readonly material: SurfaceMaterial;
  private readonly stack: SheetStack | null; // null: one opaque surface
  private readonly textures: Textures;
  private readonly counts: number[]; // eigen textures of each basis
  private readonly composers = new Map<number, Composer>(); // by `coarser`, each when it is first asked for
  private readonly encoded: CaptureCamera[];
  private readonly rowOf: Int32Array; // of each camera among the encoded, -1 if it is held out
  private readonly gains = new Map<number, number>();
  private readonly detail: number; // of an atlas, along a side of the photographs' pixels
  private maps: { texture: DataArrayTexture; mixing: Mixing; usable: number } | null = null;
  private frame = -1;

  /** Made by the plug-in. */
  constructor(
    private readonly parts: FieldParts,
    options: EigenfieldOptions = {},
  ) {
    super();
    const { scene, info, meshes } = parts;
    const [mesh] = meshes;
    if (!mesh) throw new Error("a field needs a mesh");
    this.mesh = mesh;
    this.info = info;
    this.total = ranksOf(scene);
    this.counts = basesOf(scene).map(({ count }) => count);
    this.filter = options.filter ?? "bicubic";
    this.weightMode = info.facesPlane ? "ray" : "eye";
    this.encoded = info.cameras.filter((_, i) => !info.heldOut[i]);
    let row = 0;
    this.rowOf = Int32Array.from(scene.heldOut, (out) => (out ? -1 : row++));
    this.textures = new Textures(parts, mesh.geometry, options);
    const doubleSided = [mesh.material].flat().some((material) => material.side !== FrontSide);
    this.material = makeMaterial(doubleSided, scene.sheets !== null);
    this.stack = scene.sheets && new SheetStack(scene.sheets.faces, mesh.geometry, this.material);
    this.complete = new Promise((resolve, reject) => {
      this.addEventListener("complete", () => resolve());
      this.addEventListener("error", ({ error }) => reject(error));
    });
    this.complete.catch(() => undefined); // who does not wait for it hears of it by the event
    const reference = info.cameras[info.reference];
    this.detail = reference ? medianFootprint(mesh.geometry, reference, [1, 1]) : 0;
    this.listen();
    for (const each of meshes) {
      const prepare = (renderer: WebGLRenderer, camera: Camera): void => this.prepare(renderer, camera, each);
      if (this.stack) this.stack.attach(each, prepare);
      else {
        each.material = this.material;
        each.onBeforeRender = (renderer, _scene, camera) => prepare(renderer, camera);
      }
    }
    if (options.renderer) this.textures.attach(options.renderer);
  }

  /** Eigen textures of each basis for which memory and limits of the device have room. */
  get usable(): number {
    return this.textures.plan?.usable ?? this.total;
  }

  /** Eigen textures of each basis on the GPU, up to the first that is not. */
  get loaded(): number {
    return this.textures.loaded;
  }

  /** Eigen textures on the GPU have the file's side over this. */
  get scaleDown(): number {
    return this.textures.plan?.scaleDown ?? 1;
  }

  /** What the device has no room for. */
  get reductions(): Reduction[] {
    return this.textures.plan?.reductions ?? [];
  }

  /** The same as a sentence. */
  get limitation(): string | null {
    return this.textures.plan?.limitation ?? null;
  }

  /** Bytes on the GPU: textures, what is composed of them, maps of weights, geometry, what sheets are drawn into. */
  get gpuBytes(): number {
    return (this.textures.plan?.bytes ?? 0) + (this.stack?.bytes ?? 0);
  }

  /** Weights over the encoded cameras at view-plane coordinates; they sum to 1. */
  viewWeights(x: number, y: number, mixing: Mixing = this.mixing): Float64Array {
    const weights = new Float64Array(this.parts.weights.places.length / 2);
    const { camera, weight } = this.parts.weights.at(x, y, mixing);
    camera.forEach((index, i) => (weights[index] = (weights[index] ?? 0) + (weight[i] ?? 0)));
    return weights;
  }

  /** Weights of the eigen textures, of one basis after the other, at view-plane coordinates. */
  componentWeights(x: number, y: number): Float64Array {
    return this.mix(this.parts.weights.at(x, y, this.mixing));
  }

  /** Weights of the eigen textures of a captured camera: its own, or if it was held out those of its place. */
  cameraWeights(index: number): Float64Array {
    const row = this.rowOf[index] ?? -1;
    const camera = this.info.cameras[index];
    const all = this.columns;
    if (row >= 0) return Float64Array.from(this.parts.omega.subarray(row * all, (row + 1) * all));
    if (!camera) throw new RangeError(`no camera ${index}`);
    return this.componentWeights(...planeCoordinates(this.info.viewPlane, camera.centre));
  }

  /** Puts textures on the GPU of another renderer, or on that of the same one once more. A context that was lost and
   * comes back is seen to without it. */
  restore(renderer: WebGLRenderer): void {
    this.textures.attach(renderer);
  }

  dispose(): void {
    this.textures.dispose();
    this.freeComposers();
    this.stack?.dispose();
    this.maps?.texture.dispose();
    this.material.dispose();
    this.mesh.geometry.dispose();
  }

  private listen(): void {
    this.textures.onPlan = ({ limitation }) => {
      this.freeComposers();
      if (limitation) queueMicrotask(() => this.dispatchEvent({ type: "limited" })); // not within a draw
    };
    this.textures.onTexture = () => this.dispatchEvent({ type: "texture" });
    this.textures.onComplete = () => this.dispatchEvent({ type: "complete" });
    this.textures.onError = (reason) => this.fail(reason);
  }

  /** Texels a pixel up to which the finest level of what is composed is read. */
  private finestOf([width, height]: [number, number], down: number): number {
    return ONE_SAMPLE * Math.max(1, (this.detail * Math.sqrt(width * height)) / down);
  }

  /** Eigen textures of all bases: columns of the weights. */
  private get columns(): number {
    return this.counts.reduce((a, b) => a + b, 0);
  }

  private mix({ camera, weight }: Blend): Float64Array {
    const { omega } = this.parts;
    const all = this.columns;
    const mixed = new Float64Array(all);
    for (let i = 0; i < 4; i++) {
      const part = weight[i] ?? 0;
      if (!part) continue;
      const row = (camera[i] ?? 0) * all;
      for (let j = 0; j < all; j++) mixed[j] = (mixed[j] ?? 0) + part * (omega[row + j] ?? 0);
    }
    return mixed;
  }

  // ---- before each draw

  private prepare(renderer: WebGLRenderer, camera: Camera, mesh: Mesh): void {
    if (!this.textures.attached) this.textures.attach(renderer);
    const eye = eyeOf(camera, mesh);
    const [x, y] = planeCoordinates(this.info.viewPlane, eye);
    const captured = this.camera !== null && this.info.cameras[this.camera] ? this.camera : null;
    const weights = captured === null ? this.componentWeights(x, y) : this.cameraWeights(captured);
    const rays = captured === null && this.weightMode === "ray" && this.info.facesPlane && !this.isOnPlane(eye);
    this.setView();
    this.setExposure(captured, [x, y]);
    const bicubic = FILTERS[this.filter];
    if (this.material.defines.BICUBIC !== bicubic) {
      this.material.defines.BICUBIC = bicubic;
      this.material.needsUpdate = true;
    }
    this.material.uniformsNeedUpdate = true;
    this.compose(renderer, camera, this.recipe(weights, rays ? eye : null));
    if (renderer.info.render.frame !== this.frame) this.lastWeights = [];
    this.frame = renderer.info.render.frame;
    this.lastWeights.push(weights);
    this.lastByRay = rays;
  }

  private compose(renderer: WebGLRenderer, camera: Camera, recipe: Recipe): void {
    const { plan } = this.textures;
    const { size, viewPlane } = this.info;
    if (!plan) return;
    const down = plan.meanDown * this.coarser;
    let composer = this.composers.get(down);
    if (!composer) {
      const { scene } = this.parts;
      const opacity = opacityPart(scene, this.textures);
      composer = new Composer(size, partsOf(scene, this.textures, plan), opacity, down, this.mesh, viewPlane);
      this.composers.set(down, composer);
    }
    composer.compose(renderer, camera, recipe);
    this.material.uniforms.composed.value = composer.texture;
    this.material.uniforms.finest.value = this.finestOf(size, down);
  }

  private freeComposers(): void {
    for (const composer of this.composers.values()) composer.dispose();
    this.composers.clear();
  }

  /** What is to be composed. `eye`: each texel looks its weights up. */
  private recipe(weights: Float64Array, eye: Vector | null): Recipe {
    const shown = this.material.uniforms.shown.value;
    const one = shown === VIEWS.eigen ? this.shownEigen : null;
    return {
      version: this.textures.version,
      mean: this.textures.hasMeans && one === null,
      opacity: this.textures.hasMeans && this.stack !== null,
      only: one,
      count: shown === VIEWS.mean ? 0 : Math.max(0, Math.floor(Math.min(this.count, this.total))),
      weights,
      eye: eye && onPlane(this.info.viewPlane, eye),
      maps: eye && this.mapsOf(this.mixing),
    };
  }

  /** Gives a view at a place of the view plane its exposure: a camera's own, or mixed by the weights that textures have. */
  private setExposure(captured: number | null, place: [number, number]): void {
    const { cameras, heldOut, mixedColours, viewPlane } = this.info;
    const wanted = this.exposure ?? (mixedColours || this.showsErrors ? captured : null);
    const own = wanted === null ? undefined : cameras[wanted];
    let parts: [CaptureCamera | undefined, number][] = [[own, 1]];
    if (mixedColours && (wanted === null || heldOut[wanted])) {
      const at = own ? planeCoordinates(viewPlane, own.centre) : place;
      const { camera, weight } = this.parts.weights.at(...at, this.mixing);
      parts = [0, 1, 2, 3].map((i) => [this.encoded[camera[i] ?? 0], weight[i] ?? 0]);
    }
    const [scale, bias] = [
      [1, 1, 1],
      [0, 0, 0],
    ];
    for (const [one, part] of parts) {
      if (!one?.gain || !one.offset) continue;
      for (let i = 0; i < 3; i++) {
        const factor = 1 / (one.gain[i] ?? 1);
        scale[i] = (scale[i] ?? 1) + part * (factor - 1);
        bias[i] = (bias[i] ?? 0) - part * factor * (one.offset[i] ?? 0);
      }
    }
    this.material.uniforms.exposureScale.value.fromArray(scale);
    this.material.uniforms.exposureBias.value.fromArray(bias);
  }

  private get showsErrors(): boolean {
    return this.view === "error" && this.photograph !== null && this.camera !== null;
  }

  private setView(): void {
    const { uniforms } = this.material;
    const errors = this.showsErrors;
    const shown = this.view === "error" && !errors ? "picture" : this.view;
    const one = this.shownEigen;
    uniforms.shown.value = VIEWS[shown === "eigen" && one >= this.loaded ? "mean" : shown];
    if (shown === "eigen") uniforms.shownGain.value = this.gainOf(one);
    if (errors) this.aimPhotograph();
  }

  /** The eigen texture that is shown alone, of each basis; -1 if there is none. */
  private get shownEigen(): number {
    return Math.min(Math.max(0, Math.floor(this.eigen)), this.total - 1);
  }

  private aimPhotograph(): void {
    const camera = this.camera === null ? undefined : this.info.cameras[this.camera];
    const { photograph } = this;
    if (!camera || !photograph) return;
    const { K, R, t, width, height } = camera;
    const pose = new Matrix4().set(...R[0], t[0], ...R[1], t[1], ...R[2], t[2], 0, 0, 0, 1);
    const lens = new Matrix4().set(...K[0], 0, ...K[1], 0, 0, 0, 0, 0, ...K[2], 0);
    const flipped = photograph.flipY && !isBitmap(photograph.image);
    const toTexture = new Matrix4().makeScale(1 / width, (flipped ? -1 : 1) / height, 1);
    if (flipped) toTexture.elements[13] = 1; // v = 1 - v: the entry that w is multiplied with
    this.material.uniforms.toPhotograph.value.multiplyMatrices(toTexture, lens.multiply(pose));
    this.material.uniforms.photograph.value = photograph;
  }

  /** The factor that makes an eigen texture visible; found once, when it is first shown. */
  private gainOf(one: number): number {
    const known = this.gains.get(one);
    if (known !== undefined) return known;
    this.gains.set(one, 1);
    const { scene, bytes } = this.parts;
    let channel = 0;
    for (const { channels, bases } of scene.planes) {
      const colours = scene.colours.slice(channel, (channel += channels));
      const basis = bases.find(({ count }) => count > one);
      if (!basis || one < 0) continue;
      eigenGain(basis, one, colours, bytes)
        .then((gain) => {
          this.gains.set(one, gain);
          this.dispatchEvent({ type: "texture" });
        })
        .catch(() => undefined); // drawing has reported it already
      break;
    }
    return 1;
  }

  private isOnPlane(eye: Vector): boolean {
    const { origin, normal, extent } = this.info.viewPlane;
    const height = eye.reduce((sum, value, i) => sum + (value - (origin[i] ?? 0)) * (normal[i] ?? 0), 0);
    return Math.abs(height) <= ON_PLANE * Math.max(...extent);
  }

  private mapsOf(mixing: Mixing): DataArrayTexture {
    const { usable } = this;
    if (this.maps?.mixing === mixing && this.maps.usable === usable) return this.maps.texture;
    this.maps?.texture.dispose();
    const texture = makeMaps(this.parts.weights, mixing, this.parts.omega, this.counts, usable);
    this.maps = { texture, mixing, usable };
    return texture;
  }

  private fail(reason: unknown): void {
    if (isAbort(reason)) return;
    const error = asSceneError(reason);
    const drawn = `${error.message} The picture is drawn with ${this.loaded} of ${this.total} eigen textures.`;
    const message = this.textures.hasMeans ? drawn : error.message;
    this.dispatchEvent({ type: "error", error: new SceneError(error.code, message, error.where) });
  }
}

const toMesh = new Matrix4();
const place = new Vector3();

/** The camera's place in the mesh's own axes. */
function eyeOf(camera: Camera, mesh: Mesh): Vector {
  place.setFromMatrixPosition(camera.matrixWorld).applyMatrix4(toMesh.copy(mesh.matrixWorld).invert());
  return [place.x, place.y, place.z];
}

function isBitmap(image: unknown): boolean {
  return typeof ImageBitmap !== "undefined" && image instanceof ImageBitmap;
}

export function isAbort(reason: unknown): boolean {
  return reason instanceof DOMException && reason.name === "AbortError";
}
