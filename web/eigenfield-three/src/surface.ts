// The surface that a field draws: the meshes of a scene, which share a geometry, their material, and sheets if it has them.

import { FrontSide, type BufferGeometry, type Camera, type Mesh, type WebGLRenderer } from "three";
import { medianFootprint } from "./footprint.js";
import type { CaptureCamera } from "./info.js";
import { makeMaterial, type SurfaceMaterial } from "./material.js";
import { SheetStack } from "./sheet-stack.js";
import { checkSheets } from "./sheets.js";

/** Called before each draw of a mesh. */
type Prepare = (renderer: WebGLRenderer, camera: Camera, mesh: Mesh) => void;

export class Surface {
  readonly mesh: Mesh;
  readonly material: SurfaceMaterial;
  version = 0; // grows when it has another shape
  laid = 0; // version at which it got its texture coordinates
  detail = 0; // of an atlas, along a side of the photographs' pixels
  private readonly stack: SheetStack | null; // null: one opaque surface

  /** `faces`: of each sheet; null: one opaque surface. `reference`: whose pixels `detail` is measured by. */
  constructor(
    private readonly meshes: Mesh[],
    private faces: number[] | null,
    private readonly reference: CaptureCamera | undefined,
    prepare: Prepare,
  ) {
    const [mesh] = meshes;
    if (!mesh) throw new Error("a field needs a mesh");
    this.mesh = mesh;
    const doubleSided = [mesh.material].flat().some((material) => material.side !== FrontSide);
    this.material = makeMaterial(doubleSided, faces !== null);
    this.stack = faces && new SheetStack(this.material);
    for (const each of meshes) {
      const own = (renderer: WebGLRenderer, camera: Camera): void => prepare(renderer, camera, each);
      if (this.stack) this.stack.attach(each, own);
      else {
        each.material = this.material;
        each.onBeforeRender = (renderer, _scene, camera) => own(renderer, camera);
      }
    }
    this.show(faces);
  }

  get geometry(): BufferGeometry {
    return this.mesh.geometry;
  }

  /** Bytes on the GPU of what sheets are drawn into. */
  get bytes(): number {
    return this.stack?.bytes ?? 0;
  }

  /** Another shape, or the same one whose vertices have moved. `faces`: of each sheet; as many as before unless said.
   * Raises TypeError, or SceneError `damaged` unless the sheets divide it. */
  setGeometry(geometry: BufferGeometry, faces = this.faces): void {
    const before = this.geometry;
    if (before !== geometry) {
      const { index, attributes } = geometry;
      if (!index || !attributes["position"] || !attributes["uv"]) {
        throw new TypeError("A surface needs position, uv and an index.");
      }
      if (this.stack && faces) checkSheets({ faces, where: "the geometry" }, geometry);
      before.dispose();
    }
    for (const mesh of this.meshes) mesh.geometry = geometry;
    geometry.boundingBox = geometry.boundingSphere = null; // three.js makes them anew
    this.faces = faces;
    this.version += 1;
    if (before !== geometry) this.laid = this.version;
    this.show(faces);
  }

  private show(faces: number[] | null): void {
    if (faces) this.stack?.setGeometry(this.geometry, faces);
    this.detail = this.reference ? medianFootprint(this.geometry, this.reference, [1, 1]) : 0;
  }

  dispose(): void {
    this.stack?.dispose();
    this.material.dispose();
    this.geometry.dispose();
  }
}
