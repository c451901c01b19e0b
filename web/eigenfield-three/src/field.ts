import {
  EventDispatcher,
  Matrix4,
  Texture,
  Vector3,
  type BufferAttribute,
  type BufferGeometry,
  type Camera,
  type Mesh,
  type WebGLRenderer,
} from "three";
import { SceneError, asSceneError } from "./errors.js";
import { exposureOf } from "./exposure.js";
import type { Clip } from "./clip.js";
import { Composer, type Recipe } from "./composer.js";
import { EigenWeights } from "./eigen-weights.js";
import { basesOf, planeCoordinates, ranksOf, type CaptureCamera, type SceneInfo, type Vector } from "./info.js";
import { FILTERS, VIEWS, compareWith, type Filter } from "./material.js";
import { FilmTextures } from "./film-textures.js";
import type { ClipFrame } from "./frame-ring.js";
import { setScales, type Group } from "./groups.js";
import type { DecodedMesh } from "./mesh-decoder.js";
import type { EigenfieldOptions } from "./options.js";
import { opacityPart, partsOf, rescale, type Part } from "./parts.js";
import { Player } from "./player.js";
import type { Reduction } from "./memory.js";
import { onPlane } from "./passes.js";
import { geometryOf } from "./proxy.js";
import { Surface } from "./surface.js";
import type { TextureSource } from "./texture-source.js";
import { Textures, type TextureParts } from "./textures.js";
import type { Mixing, ViewWeights } from "./weights.js";

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
  meshes: Mesh[]; // at least one; they share a geometry
  omega: Float32Array; // (encoded cameras) x (eigen textures of all bases)
  weights: ViewWeights;
  clip: Clip | null; // null: a scene of one instant
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
  /** Plays a clip; null: a scene of one instant. */
  readonly player: Player | null;
  /** All eigen textures are there; rejects with the SceneError of the `error` event, or an AbortError if the field was
   * disposed of before. */
  readonly complete: Promise<void>;

  private giveUp: (reason: unknown) => void = () => undefined; // `complete`
  private readonly surface: Surface;
  private readonly textures: Textures;
  private weights: EigenWeights;
  private group: Group | null; // of the frame that is shown
  private plain = false; // that frame has no eigen textures
  private moved: BufferGeometry | null; // of a clip, whose groups may have another mesh, and frames their own vertices
  private summed: { parts: Part[]; opacity: Part | null } = { parts: [], opacity: null };
  private readonly composers = new Map<number, Composer>(); // by `coarser`, each when it is first asked for
  private readonly encoded: CaptureCamera[];
  private readonly gains = new Map<number, number>();
  private frame = -1;

  /** Made by the plug-in. */
  constructor(
    private readonly parts: FieldParts,
    private readonly source: TextureSource,
    options: EigenfieldOptions = {},
  ) {
    super();
    const { scene, info } = parts;
    const faces = scene.sheets?.faces ?? null;
    this.surface = new Surface(parts.meshes, faces, info.cameras[info.reference], (...draw) => this.prepare(...draw));
    this.mesh = this.surface.mesh;
    this.info = info;
    this.total = ranksOf(scene);
    this.filter = options.filter ?? "bicubic";
    this.weightMode = info.facesPlane ? "ray" : "eye";
    this.encoded = info.cameras.filter((_, i) => !info.heldOut[i]);
    this.weights = this.weightsOf(parts.omega);
    this.group = parts.clip && parts.clip.group;
    this.player = parts.clip && this.makePlayer(parts.clip);
    this.moved = parts.clip && this.surface.geometry;
    if (parts.clip) this.shape(parts.clip.group, 0, parts.clip.mesh, false);
    this.textures = new Textures(parts, source, this.surface, options);
    this.complete = new Promise((resolve, reject) => {
      this.giveUp = reject;
      this.addEventListener("complete", () => resolve());
      this.addEventListener("error", ({ error }) => reject(error));
    });
    this.complete.catch(() => undefined); // who does not wait for it hears of it by the event
    this.listen();
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
    return this.textures.bytes + this.surface.bytes;
  }

  /** Weights over the encoded cameras at view-plane coordinates; they sum to 1. */
  viewWeights(x: number, y: number, mixing: Mixing = this.mixing): Float64Array {
    return this.weights.viewsAt(x, y, mixing);
  }

  /** Weights of the eigen textures, of one basis after the other, at view-plane coordinates. */
  componentWeights(x: number, y: number): Float64Array {
    return this.weights.at(x, y, this.mixing);
  }

  /** Weights of the eigen textures of a captured camera: its own, or if it was held out those of its place. */
  cameraWeights(index: number): Float64Array {
    return this.weights.ofCamera(index, this.mixing);
  }

  /** Another mesh for the same textures, or the same one after its vertices have moved: with `position`, `uv` and an
   * index. `faces`: triangles of each sheet; as many as before unless said. The one before is disposed of. */
  setGeometry(geometry: BufferGeometry, faces?: number[]): void {
    this.surface.setGeometry(geometry, faces);
  }

  /** Puts textures on the GPU of another renderer, or on that of the same one once more. A context that was lost and
   * comes back is seen to without it. */
  restore(renderer: WebGLRenderer): void {
    this.textures.attach(renderer);
  }

  dispose(): void {
    this.giveUp(new DOMException("The field was disposed of.", "AbortError"));
    this.player?.dispose();
    this.textures.dispose();
    this.freeComposers();
    this.surface.dispose();
    this.weights.dispose();
  }

  private listen(): void {
    this.textures.onPlan = (plan) => {
      const { scene } = this.parts;
      this.freeComposers();
      this.summed = { parts: partsOf(scene, this.textures, plan), opacity: opacityPart(scene, this.textures, plan) };
      if (plan.limitation) queueMicrotask(() => this.dispatchEvent({ type: "limited" })); // not within a draw
    };
    this.textures.onTexture = () => this.dispatchEvent({ type: "texture" });
    this.textures.onComplete = () => this.dispatchEvent({ type: "complete" });
    this.textures.onError = (reason) => this.fail(reason);
  }

  /** Texels a pixel up to which the finest level of what is composed is read. */
  private finestOf([width, height]: [number, number], down: number): number {
    return ONE_SAMPLE * Math.max(1, (this.surface.detail * Math.sqrt(width * height)) / down);
  }

  private weightsOf(omega: Float32Array): EigenWeights {
    const { scene, info, weights } = this.parts;
    return new EigenWeights(info, basesOf(scene).map(({ count }) => count), omega, weights);
  }

  // ---- clips

  private makePlayer({ timeline, ring, sound }: Clip): Player {
    const show = (frame: ClipFrame): void => this.showFrame(frame);
    const failed = (reason: unknown): void => this.dispatchEvent({ type: "error", error: asSceneError(reason) });
    return new Player(timeline, ring, { show, failed }, sound);
  }

  /** All of a frame at once: what its group has, and its textures. */
  private showFrame({ number, group, films }: ClipFrame): void {
    if (this.group) this.shape(group, number - group.first, this.group.mesh, this.group.motion !== null);
    if (group !== this.group) this.enter(group);
    this.plain = films.includes(null);
    if (this.source instanceof FilmTextures) this.source.show(films);
  }

  /** Gives the surface the shape of a frame of a group, unless it was exchanged for another by now. `shown`: the mesh
   * that it has, whose vertices may have `moved`. */
  private shape({ mesh, motion }: Group, frame: number, shown: DecodedMesh, moved: boolean): void {
    if (this.surface.geometry !== this.moved || (mesh === shown && !motion && !moved)) return;
    const geometry = mesh === shown ? this.moved : geometryOf(mesh);
    const position = geometry.getAttribute("position") as BufferAttribute;
    if (motion) motion.place(frame, position.array as Float32Array);
    else position.copyArray(mesh.positions);
    position.needsUpdate = true;
    this.moved = geometry;
    this.surface.setGeometry(geometry);
  }

  private enter(group: Group): void {
    const { scene } = this.parts;
    const { plan } = this.textures;
    this.group = group;
    this.weights.dispose();
    this.weights = this.weightsOf(group.omega);
    setScales(scene, group);
    if (plan) rescale(this.summed.parts, scene, this.textures, plan);
  }

  // ---- before each draw

  private prepare(renderer: WebGLRenderer, camera: Camera, mesh: Mesh): void {
    if (!this.textures.serves(renderer)) this.textures.attach(renderer);
    const eye = eyeOf(camera, mesh);
    const [x, y] = planeCoordinates(this.info.viewPlane, eye);
    const captured = this.camera !== null && this.info.cameras[this.camera] ? this.camera : null;
    const weights = captured === null ? this.componentWeights(x, y) : this.cameraWeights(captured);
    const rays = captured === null && this.weightMode === "ray" && this.info.facesPlane && !this.isOnPlane(eye);
    const { material } = this.surface;
    this.setView();
    this.setExposure(captured, [x, y]);
    const bicubic = FILTERS[this.filter];
    if (material.defines.BICUBIC !== bicubic) {
      material.defines.BICUBIC = bicubic;
      material.needsUpdate = true;
    }
    material.uniformsNeedUpdate = true;
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
      const { parts, opacity } = this.summed;
      composer = new Composer(size, parts, opacity, down, this.coarser > 1, this.surface, viewPlane);
      this.composers.set(down, composer);
    }
    composer.compose(renderer, camera, recipe);
    const { composed, finest } = this.surface.material.uniforms;
    composed.value = composer.texture;
    finest.value = this.finestOf(size, down);
  }

  private freeComposers(): void {
    for (const composer of this.composers.values()) composer.dispose();
    this.composers.clear();
  }

  /** What is to be composed. `eye`: each texel looks its weights up. */
  private recipe(weights: Float64Array, eye: Vector | null): Recipe {
    const shown = this.surface.material.uniforms.shown.value;
    const one = shown === VIEWS.eigen ? this.shownEigen : null;
    return {
      version: this.textures.version,
      mean: this.textures.hasMeans && one === null,
      opacity: this.textures.opacityVersion,
      only: one,
      count: shown === VIEWS.mean || this.plain ? 0 : Math.max(0, Math.floor(Math.min(this.count, this.total))),
      weights,
      eye: eye && onPlane(this.info.viewPlane, eye),
      places: eye ? this.surface.version : this.coarser > 1 ? this.surface.laid : 0,
      maps: eye && this.weights.maps(this.mixing, this.usable),
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
    const { scale, bias } = exposureOf(parts);
    const { exposureScale, exposureBias } = this.surface.material.uniforms;
    exposureScale.value.fromArray(scale);
    exposureBias.value.fromArray(bias);
  }

  private get showsErrors(): boolean {
    return this.view === "error" && this.photograph !== null && this.camera !== null;
  }

  private setView(): void {
    const { uniforms } = this.surface.material;
    const errors = this.showsErrors;
    const shown = this.view === "error" && !errors ? "picture" : this.view;
    const one = this.shownEigen;
    uniforms.shown.value = VIEWS[shown === "eigen" && (this.plain || one >= this.loaded) ? "mean" : shown];
    if (shown === "eigen") uniforms.shownGain.value = this.gainOf(one);
    const camera = errors && this.info.cameras[this.camera ?? 0];
    if (camera && this.photograph) compareWith(uniforms, camera, this.photograph);
  }

  /** The eigen texture that is shown alone, of each basis; -1 if there is none. */
  private get shownEigen(): number {
    return Math.min(Math.max(0, Math.floor(this.eigen)), this.total - 1);
  }

  /** The factor that makes an eigen texture visible; found once, when it is first shown. */
  private gainOf(one: number): number {
    const known = this.gains.get(one);
    if (known !== undefined || one < 0) return known ?? 1;
    this.gains.set(one, 1);
    this.source
      .gain(one)
      .then((gain) => {
        this.gains.set(one, gain);
        this.dispatchEvent({ type: "texture" });
      })
      .catch(() => undefined); // drawing has reported it already
    return 1;
  }

  private isOnPlane(eye: Vector): boolean {
    const { origin, normal, extent } = this.info.viewPlane;
    const height = eye.reduce((sum, value, i) => sum + (value - (origin[i] ?? 0)) * (normal[i] ?? 0), 0);
    return Math.abs(height) <= ON_PLANE * Math.max(...extent);
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

function isAbort(reason: unknown): boolean {
  return reason instanceof DOMException && reason.name === "AbortError";
}
