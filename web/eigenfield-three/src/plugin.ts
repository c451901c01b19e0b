import { MeshBasicMaterial, type Material, type Mesh, type Object3D } from "three";
import type { GLTF, GLTFLoaderPlugin, GLTFParser } from "three/addons/loaders/GLTFLoader.js";
import { checkAddresses } from "./addresses.js";
import type { ViewBytes } from "./accessors.js";
import { openClip, type Clip } from "./clip.js";
import { isScene, readDocument, stillsOf, type SceneDocument } from "./document.js";
import { SceneError, cutOff, damaged } from "./errors.js";
import { EigenField } from "./field.js";
import { FilmTextures } from "./film-textures.js";
import { contextOf } from "./gpu.js";
import { planeCoordinates, readCameras, readTriangles, readWeights, sceneInfo } from "./info.js";
import type { Json } from "./json.js";
import { EXTENSION } from "./limits.js";
import { decodeMean, type Mean } from "./means.js";
import type { Size } from "./memory.js";
import type { EigenfieldOptions } from "./options.js";
import { unpacked } from "./packed.js";
import type { DecodedMesh } from "./mesh-decoder.js";
import { canDecode } from "./pictures-8bit.js";
import { checkGeometry, countsOf, geometryOf, readCodedMesh } from "./proxy.js";
import { checkSheets } from "./sheets.js";
import { stillTextures } from "./still-textures.js";
import type { Timeline } from "./timeline.js";
import { ViewWeights } from "./weights.js";

/**
 * Draws eigen textures in whatever app uses three.js' GLTFLoader:
 *
 *     loader.register((parser) => new EigenfieldPlugin(parser));
 *
 * The loaded scene draws itself; `gltf.userData.eigenfield` is its EigenField. Other glTF files load as ever. A clip that
 * this browser cannot decode is shown as other viewers show it, and `gltf.userData.eigenfieldError` says why.
 */
export class EigenfieldPlugin implements GLTFLoaderPlugin {
  readonly name = EXTENSION;
  private scene: SceneDocument | null = null;
  private views: SceneDocument["views"] = []; // of our own file
  private lacks: SceneError | null = null; // why a scene is shown as other viewers show it
  private readonly ours: boolean;

  constructor(
    private readonly parser: GLTFParser,
    private readonly options: EigenfieldOptions = {},
  ) {
    this.ours = isScene(parser.json);
  }

  async beforeRoot(): Promise<void> {
    if (!this.ours) return;
    if (this.options.renderer) contextOf(this.options.renderer);
    const { json } = this.parser;
    checkAddresses(json as Json);
    Object.assign(json, await unpacked(json, (offset, length) => this.read(offset, length)));
    const scene = readDocument(json);
    const { stream } = this.options;
    const read = scene.timeline?.groups[0]?.file ? stream?.readFile : stream?.readGroups;
    if (scene.timeline && !read) return; // shown as other viewers show it
    this.views = scene.views;
    if (scene.timeline && scene.shown && !(await canDecode("image/avif"))) {
      const message = "This browser decodes no AV1; use a newer browser. The first frame is shown.";
      this.lacks = new SceneError("codec", message, "");
      return;
    }
    this.scene = scene;
    if (!this.scene.shown) showEmptyMesh(json);
  }

  private async read(offset: number, length: number): Promise<ArrayBuffer> {
    if (this.options.stream) return this.options.stream.read(offset, length);
    const bytes = ((await this.parser.getDependency("buffer", 0)) as ArrayBuffer).slice(offset, offset + length);
    if (bytes.byteLength < length) throw cutOff("/buffers/0");
    return bytes;
  }

  /** The picture for other viewers is not needed, and so not decoded. */
  loadMaterial(index: number): Promise<Material> | null {
    const primitive = this.scene && this.parser.json.meshes[0].primitives[0];
    if (!primitive || primitive.material !== index) return null;
    const { doubleSided } = this.parser.json.materials?.[index] ?? {};
    const material = new MeshBasicMaterial();
    material.side = doubleSided === true ? 2 : 0;
    return Promise.resolve(material);
  }

  loadBufferView(index: number): Promise<ArrayBuffer> | null {
    const view = this.views[index];
    return view && this.options.stream ? this.options.stream.read(view.offset, view.length) : null;
  }

  async afterRoot(gltf: GLTF): Promise<void> {
    const { scene } = this;
    if (this.lacks) gltf.userData["eigenfieldError"] = this.lacks;
    if (!scene) return;
    const meshes = proxiesOf(gltf, this.parser);
    const [mesh] = meshes;
    if (!mesh) throw damaged("/meshes/0", "no node shows it");
    if (scene.shown) checkGeometry(mesh.geometry, scene.shown);
    const bytes: ViewBytes = async (view) => {
      const data = (await this.parser.getDependency("bufferView", view)) as ArrayBuffer;
      if (data.byteLength < (scene.views[view]?.length ?? 0)) throw cutOff(`/bufferViews/${view}`);
      return data;
    };
    const coded = scene.mesh && (await readCodedMesh(scene.mesh, bytes));
    const clip = scene.timeline && coded && (await this.openClip(scene, scene.timeline, coded));
    if (coded) {
      const proxy = geometryOf(coded);
      mesh.geometry.dispose();
      for (const each of meshes) each.geometry = proxy;
    }
    if (scene.sheets) checkSheets(scene.sheets, mesh.geometry);
    const [means, cameras, omega, triangles] = await Promise.all([
      Promise.all(clip ? [] : stillsOf(scene).map((still) => decodeMean(still, bytes))),
      readCameras(scene, bytes),
      clip ? clip.group.omega : readWeights(scene, bytes),
      readTriangles(scene, bytes),
    ]);
    const encoded = cameras.filter((_, i) => !scene.heldOut[i]);
    const places = Float64Array.from(encoded.flatMap((camera) => planeCoordinates(scene, camera.centre)));
    const weights = new ViewWeights(places, triangles, scene.extent[1] === 0);
    const sizeOf = ({ pieces: [first] }: Mean): [number, number] => [first?.picture.width ?? 1, first?.rows ?? 1];
    const meanSizes = clip ? stillsOf(scene).map(({ meanSize }): Size => meanSize ?? [1, 1]) : means.map(sizeOf);
    const info = sceneInfo(scene, cameras, meanSizes, weights.grid, this.fileBytes(), countsOf(mesh.geometry));
    const parts = { scene, info, meshes, meanSizes, omega, weights, clip };
    const source = clip ? new FilmTextures(scene, clip.films) : stillTextures(scene, bytes, means);
    gltf.userData["eigenfield"] = new EigenField(parts, source, this.options);
  }

  private openClip(scene: SceneDocument, timeline: Timeline, mesh: DecodedMesh): Promise<Clip> {
    const stream = this.options.stream!;
    return openClip(scene, timeline, mesh, ({ offset, length: size, file }, length) => {
      return file === null ? stream.readGroups!(offset, length) : stream.readFile!(file, size, length);
    });
  }

  private fileBytes(): number {
    const { groups = [], sound = null } = this.scene?.timeline ?? {};
    const beside = [...groups, ...(sound ? [sound] : [])].reduce((sum, one) => sum + (one.file ? one.length : 0), 0);
    if (this.options.stream) return this.options.stream.total + beside;
    const { extensions, json } = this.parser as unknown as {
      extensions: Record<string, { header?: { length?: number } } | undefined>;
      json: { buffers: { byteLength: number }[] };
    };
    return extensions["KHR_binary_glTF"]?.header?.length ?? json.buffers[0]?.byteLength ?? 0;
  }
}

/** Gives the first node of a file that shows other viewers nothing a mesh, for the coded one to take its place. */
function showEmptyMesh(json: GLTFParser["json"]): void {
  const [node] = json.nodes;
  if (node) node.mesh = 0;
  json.meshes = [{ primitives: [{ attributes: {}, material: 0 }] }];
  json.materials = [{ doubleSided: true }];
}

/** Every instance of the first primitive of mesh 0. */
function proxiesOf(gltf: GLTF, parser: GLTFParser): Mesh[] {
  const found: Mesh[] = [];
  gltf.scene.traverse((object: Object3D) => {
    const from = parser.associations.get(object);
    if (isMesh(object) && from?.meshes === 0 && (from.primitives ?? 0) === 0) found.push(object);
  });
  return found;
}

function isMesh(object: Object3D): object is Mesh {
  return (object as Partial<Mesh>).isMesh === true;
}
