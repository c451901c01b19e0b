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
import type { SceneDocument } from "./document.js";
import { SceneError, asSceneError } from "./errors.js";
import { medianFootprint } from "./footprint.js";
import { planeCoordinates, type SceneInfo, type Vector, type ViewBytes } from "./info.js";
import { makeMaps } from "./maps.js";
import { FILTERS, VIEWS, makeMaterial, resizeMaterial, type Filter, type SurfaceMaterial } from "./material.js";
import type { EigenfieldOptions } from "./options.js";
import { eigenGain } from "./strength.js";
import { Textures } from "./textures.js";
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
export interface FieldParts {
  scene: SceneDocument;
  info: SceneInfo;
  meshes: Mesh[]; // at least one
  mean: ImageBitmap;
  omega: Float32Array; // (encoded cameras) x (eigen textures)
  weights: ViewWeights;
  bytes: ViewBytes;
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
  camera: number | null = null;
  exposure: number | null = null;
  view: keyof typeof VIEWS = "picture";
  eigen = 0;
  photograph: Texture | null = null;

  /** Eigen-texture weights of the last frame, one entry for each eye that was drawn. */
  lastWeights: Float64Array[] = [];
  /** All eigen textures are there; rejects with the SceneError of the `error` event. */
  readonly complete: Promise<void>;

  private readonly material: SurfaceMaterial;
  private readonly textures: Textures;
  private readonly rowOf: Int32Array; // of each camera among the encoded, -1 if it is held out
  private readonly gains = new Map<number, number>();
  private readonly detail: number; // of an atlas, along a side of the photographs' pixels
  private readonly meanSize: [number, number];
  private maps: { texture: DataArrayTexture; mixing: Mixing; usable: number } | null = null;
  private frame = -1;

  /** Made by the plug-in. */
  constructor(
    private readonly parts: FieldParts,
    options: EigenfieldOptions = {},
  ) {
    super();
    const { scene, info, meshes, mean } = parts;
    const [mesh] = meshes;
    if (!mesh) throw new Error("a field needs a mesh");
    this.mesh = mesh;
    this.info = info;
    this.total = scene.textures.length;
    this.filter = options.filter ?? "mixed";
    this.weightMode = info.facesPlane ? "ray" : "eye";
    let row = 0;
    this.rowOf = Int32Array.from(scene.heldOut, (out) => (out ? -1 : row++));
    this.textures = new Textures(parts, geometryBytes(mesh), options);
    const doubleSided = [mesh.material].flat().some((material) => material.side !== FrontSide);
    this.material = makeMaterial(scene, this.textures.mean, this.textures.eigen, doubleSided);
    this.complete = new Promise((resolve, reject) => {
      this.addEventListener("complete", () => resolve());
      this.addEventListener("error", ({ error }) => reject(error));
    });
    this.complete.catch(() => undefined); // who does not wait for it hears of it by the event
    const reference = info.cameras[info.reference];
    this.detail = reference ? medianFootprint(mesh.geometry, reference, [1, 1]) : 0;
    this.meanSize = [mean.width, mean.height];
    this.listen();
    for (const each of meshes) {
      each.material = this.material;
      each.onBeforeRender = (renderer, _scene, camera) => this.prepare(renderer, camera, each);
    }
    if (options.renderer) this.textures.attach(options.renderer);
  }

  /** Eigen textures for which memory and limits of the device have room. */
  get usable(): number {
    return this.textures.plan?.usable ?? this.total;
  }

  /** Eigen textures on the GPU. */
  get loaded(): number {
    return this.textures.loaded;
  }

  /** 1, 2 or 4: eigen textures on the GPU have the file's side over this. */
  get scaleDown(): number {
    return this.textures.plan?.scaleDown ?? 1;
  }

  /** A sentence where the device has no room for all of the scene. */
  get limitation(): string | null {
    return this.textures.plan?.limitation ?? null;
  }

  /** Bytes on the GPU: textures with their mips, maps of weights, geometry. */
  get gpuBytes(): number {
    return this.textures.plan?.bytes ?? 0;
  }

  /** Weights over the encoded cameras at view-plane coordinates; they sum to 1. */
  viewWeights(x: number, y: number, mixing: Mixing = this.mixing): Float64Array {
    const weights = new Float64Array(this.parts.weights.places.length / 2);
    const { camera, weight } = this.parts.weights.at(x, y, mixing);
    camera.forEach((index, i) => (weights[index] = (weights[index] ?? 0) + (weight[i] ?? 0)));
    return weights;
  }

  /** Weights of the eigen textures at view-plane coordinates. */
  componentWeights(x: number, y: number): Float64Array {
    return this.mix(this.parts.weights.at(x, y, this.mixing));
  }

  /** Weights of the eigen textures of a captured camera: its own, or if it was held out those of its place. */
  cameraWeights(index: number): Float64Array {
    const row = this.rowOf[index] ?? -1;
    const camera = this.info.cameras[index];
    if (row >= 0) return Float64Array.from(this.parts.omega.subarray(row * this.total, (row + 1) * this.total));
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
    this.maps?.texture.dispose();
    this.material.dispose();
    this.mesh.geometry.dispose();
  }

  private listen(): void {
    this.textures.onPlan = ({ usable, meanDown, scaleDown, limitation }) => {
      const { scene } = this.parts;
      resizeMaterial(this.material, scene.textures, usable);
      this.material.uniforms.finest.value = this.finestOf(this.meanSize, meanDown);
      this.material.uniforms.finestEigen.value = this.finestOf(scene.size, scaleDown);
      if (limitation) queueMicrotask(() => this.dispatchEvent({ type: "limited" })); // not within a draw
    };
    this.textures.onTexture = () => this.dispatchEvent({ type: "texture" });
    this.textures.onComplete = () => this.dispatchEvent({ type: "complete" });
    this.textures.onError = (reason) => this.fail(reason);
  }

  /** Texels a pixel up to which the finest level of a texture on the GPU is read. */
  private finestOf([width, height]: [number, number], down: number): number {
    return ONE_SAMPLE * Math.max(1, (this.detail * Math.sqrt(width * height)) / down);
  }

  private mix({ camera, weight }: Blend): Float64Array {
    const { omega } = this.parts;
    const mixed = new Float64Array(this.total);
    for (let i = 0; i < 4; i++) {
      const part = weight[i] ?? 0;
      if (!part) continue;
      const row = (camera[i] ?? 0) * this.total;
      for (let j = 0; j < this.total; j++) mixed[j] = (mixed[j] ?? 0) + part * (omega[row + j] ?? 0);
    }
    return mixed;
  }

  // ---- before each draw

  private prepare(renderer: WebGLRenderer, camera: Camera, mesh: Mesh): void {
    if (!this.textures.attached) this.textures.attach(renderer);
    const { uniforms } = this.material;
    const eye = eyeOf(camera, mesh, uniforms.eye.value);
    const [x, y] = planeCoordinates(this.info.viewPlane, eye);
    const captured = this.camera !== null && this.info.cameras[this.camera] ? this.camera : null;
    const weights = captured === null ? this.componentWeights(x, y) : this.cameraWeights(captured);
    uniforms.viewWeights.value.fill(0);
    uniforms.viewWeights.value.set(weights.subarray(0, this.usable));
    uniforms.rayWeights.value =
      captured === null && this.weightMode === "ray" && this.info.facesPlane && !this.isOnPlane(eye);
    if (uniforms.rayWeights.value) uniforms.weightMaps.value = this.mapsOf(this.mixing);
    uniforms.count.value = Math.min(this.loaded, Math.max(0, Math.floor(this.count)));
    this.setView();
    const bicubic = FILTERS[this.filter];
    if (this.material.defines.BICUBIC !== bicubic) {
      this.material.defines.BICUBIC = bicubic;
      this.material.needsUpdate = true;
    }
    this.material.uniformsNeedUpdate = true;
    if (renderer.info.render.frame !== this.frame) this.lastWeights = [];
    this.frame = renderer.info.render.frame;
    this.lastWeights.push(weights);
  }

  private setView(): void {
    const { uniforms } = this.material;
    const errors = this.view === "error" && this.photograph !== null && this.camera !== null;
    const wanted = this.exposure ?? (errors ? this.camera : null);
    const { gain = null, offset = null } = (wanted === null ? undefined : this.info.cameras[wanted]) ?? {};
    const scale = (gain ?? [1, 1, 1]).map((value) => 1 / value);
    uniforms.exposureScale.value.fromArray(scale);
    uniforms.exposureBias.value.fromArray(scale.map((value, i) => -(offset?.[i] ?? 0) * value));
    const shown = this.view === "error" && !errors ? "picture" : this.view;
    const one = Math.min(Math.max(0, Math.floor(this.eigen)), this.total - 1);
    uniforms.shown.value = VIEWS[shown === "eigen" && one >= this.loaded ? "mean" : shown];
    uniforms.shownEigen.value = Math.max(0, one);
    if (shown === "eigen") uniforms.shownGain.value = this.gainOf(one);
    if (errors) this.aimPhotograph();
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
    const picture = this.parts.scene.textures[one];
    this.gains.set(one, 1);
    if (picture) {
      this.parts
        .bytes(picture.view)
        .then((bytes) => eigenGain(bytes, picture))
        .then((gain) => {
          this.gains.set(one, gain);
          this.dispatchEvent({ type: "texture" });
        })
        .catch(() => undefined); // drawing has told of it already
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
    const texture = makeMaps(this.parts.weights, mixing, this.parts.omega, this.total, usable);
    this.maps = { texture, mixing, usable };
    return texture;
  }

  private fail(reason: unknown): void {
    if (isAbort(reason)) return;
    const error = asSceneError(reason);
    const drawn = `The picture is drawn with ${this.loaded} of ${this.total} eigen textures.`;
    this.dispatchEvent({ type: "error", error: new SceneError(error.code, `${error.message} ${drawn}`, error.where) });
  }
}

const toMesh = new Matrix4();
const place = new Vector3();

/** The camera's place in the mesh's own axes, also put into `target`. */
function eyeOf(camera: Camera, mesh: Mesh, target: Vector3): Vector {
  place.setFromMatrixPosition(camera.matrixWorld).applyMatrix4(toMesh.copy(mesh.matrixWorld).invert());
  target.copy(place);
  return [place.x, place.y, place.z];
}

function geometryBytes(mesh: Mesh): number {
  const { attributes, index } = mesh.geometry;
  const own = Object.values(attributes).reduce((sum, attribute) => sum + attribute.array.byteLength, 0);
  return own + (index?.array.byteLength ?? 0);
}

function isBitmap(image: unknown): boolean {
  return typeof ImageBitmap !== "undefined" && image instanceof ImageBitmap;
}

export function isAbort(reason: unknown): boolean {
  return reason instanceof DOMException && reason.name === "AbortError";
}
