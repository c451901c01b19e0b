// Sheets: drawn back to front into a target of their own, with a depth test within each sheet only, and from there into
// the picture, where the depth test is that of all other objects. Each sheet is drawn twice: its depth, and then what is
// nearest, once a pixel (the stencil). Depths of a sheet lie before those of all sheets behind it: nothing is cleared
// between sheets.

import {
  BufferAttribute,
  BufferGeometry,
  Camera,
  DepthStencilFormat,
  DepthTexture,
  GLSL3,
  HalfFloatType,
  Matrix4,
  Mesh,
  NearestFilter,
  RawShaderMaterial,
  Scene,
  UnsignedByteType,
  UnsignedInt248Type,
  Vector2,
  Vector4,
  WebGLRenderTarget,
  type WebGLRenderer,
} from "three";
import { ERROR, OVER, PRECISIONS, makeDepthMaterial, type SurfaceMaterial } from "./material.js";
import { within } from "./passes.js";

/** Name of the child of a mesh that draws its sheets: its geometry is the whole picture. */
export const SHEETS = "sheets";

const PIXEL_BYTES = 16; // half-floats of R, G, B and coverage; three bytes of depth and one that says so; depth and stencil

const SCREEN_VERTEX = `
precision highp float;
in vec3 position;
void main() { gl_Position = vec4(position, 1.0); }
`;

const SCREEN_FRAGMENT = `${PRECISIONS}${ERROR}
uniform sampler2D sheets;      // R, G, B times coverage, and coverage
uniform sampler2D solid;       // depth of what is at least half opaque
uniform sampler2D nearest;     // depth of the last sheet, within its slice
uniform float slices;
uniform vec2 corner;           // of the viewport in what is drawn into
uniform vec2 size;             // of the viewport
uniform mat4 toPlace;          // from clip space
out vec4 fragment;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy - corner);
  vec4 colour = texelFetch(sheets, at, 0);
  if (colour.a <= 0.0) discard;
  colour.rgb = clamp(colour.rgb, 0.0, 1.0);
  vec4 known = texelFetch(solid, at, 0);
  float depth = fract(texelFetch(nearest, at, 0).r * slices);
  if (known.a > 0.5) depth = dot(floor(255.0 * known.rgb + 0.5), vec3(65536.0, 256.0, 1.0)) / 16777215.0;
  if (shown == 3) {
    vec2 pixel = (gl_FragCoord.xy - corner) / size;
    vec4 place = toPlace * vec4(2.0 * vec3(pixel, depth) - 1.0, 1.0);
    colour.rgb = errorColour(min(colour.rgb / colour.a, 1.0), place.xyz / place.w) * colour.a;
  }
  gl_FragDepth = depth;
  fragment = colour;
}
`;

const viewport = new Vector4();

/** Draws the sheets of one geometry, of whichever mesh has it. */
export class SheetStack {
  private readonly scene = new Scene();
  private readonly camera = new Camera();
  private readonly sheets = new Mesh<BufferGeometry, RawShaderMaterial[]>();
  private readonly depth: RawShaderMaterial;
  private readonly screen: RawShaderMaterial;
  private readonly everywhere = new BufferGeometry(); // the whole picture
  private target: WebGLRenderTarget | null = null;

  /** `material`: of `makeMaterial`, for sheets. `setGeometry` says what is drawn. */
  constructor(private readonly material: SurfaceMaterial) {
    this.depth = makeDepthMaterial(material);
    this.depth.transparent = material.transparent = true; // or three.js would sort them by their materials
    this.sheets.frustumCulled = false;
    this.sheets.onBeforeRender = (renderer, _scene, _camera, _geometry, _material, group) => {
      const { materialIndex = 0 } = group as unknown as { materialIndex?: number };
      const count = this.sheets.material.length / 2;
      const before = count - 1 - (materialIndex >> 1); // sheets
      renderer.getContext().depthRange(before / count, (before + 1) / count);
    };
    this.scene.add(this.sheets);
    this.scene.matrixWorldAutoUpdate = this.camera.matrixWorldAutoUpdate = false;
    const { shown, photograph, toPhotograph } = material.uniforms;
    this.screen = new RawShaderMaterial({
      name: SHEETS,
      glslVersion: GLSL3,
      vertexShader: SCREEN_VERTEX,
      fragmentShader: SCREEN_FRAGMENT,
      uniforms: {
        shown,
        photograph,
        toPhotograph,
        sheets: { value: null },
        solid: { value: null },
        nearest: { value: null },
        slices: { value: 1 },
        corner: { value: new Vector2() },
        size: { value: new Vector2() },
        toPlace: { value: new Matrix4() },
      },
      transparent: true,
      ...OVER,
    });
    const corners = new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]);
    this.everywhere.setAttribute("position", new BufferAttribute(corners, 3));
  }

  /** Bytes on the GPU, once something was drawn. */
  get bytes(): number {
    return this.target ? PIXEL_BYTES * this.target.width * this.target.height : 0;
  }

  /** `faces`: of each sheet, back to front, in the order of the geometry. */
  setGeometry(geometry: BufferGeometry, faces: number[]): void {
    geometry.clearGroups();
    let start = 0;
    faces.forEach((count, sheet) => {
      for (const pass of [0, 1]) geometry.addGroup(start, 3 * count, 2 * sheet + pass);
      start += 3 * count;
    });
    this.sheets.geometry = geometry;
    this.sheets.material = faces.flatMap(() => [this.depth, this.material]);
    this.set("slices", faces.length);
    geometry.computeBoundingBox();
    geometry.computeBoundingSphere();
    const { boundingBox, boundingSphere } = geometry;
    Object.assign(this.everywhere, { boundingBox, boundingSphere }); // it is sorted and left out as the mesh would be
  }

  /** Has a mesh drawn by a child of its own, among the transparent objects; `prepare` is called before each draw. */
  attach(mesh: Mesh, prepare: (renderer: WebGLRenderer, camera: Camera) => void): void {
    for (const material of [mesh.material].flat()) material.visible = false;
    const shown = new Mesh(this.everywhere, this.screen);
    shown.name = SHEETS;
    shown.raycast = () => undefined;
    shown.onBeforeRender = (renderer, _scene, camera) => {
      prepare(renderer, camera);
      this.draw(renderer, camera, mesh);
    };
    mesh.add(shown);
  }

  private set(name: string, value: unknown): void {
    Object.assign(this.screen.uniforms[name] ?? {}, { value });
  }

  dispose(): void {
    this.target?.dispose();
    this.depth.dispose();
    this.screen.dispose();
  }

  private draw(renderer: WebGLRenderer, camera: Camera, mesh: Mesh): void {
    const eye = (camera as { viewport?: Vector4 }).viewport; // one of two
    const { x, y, z: width, w: height } = eye ?? renderer.getCurrentViewport(viewport);
    if (!width || !height) return;
    if (this.target?.width !== width || this.target.height !== height) {
      this.target?.dispose();
      this.target = makeTarget(width, height);
    }
    const { target } = this;
    this.sheets.matrixWorld.copy(mesh.matrixWorld);
    this.camera.matrixWorld.copy(camera.matrixWorld);
    this.camera.matrixWorldInverse.copy(camera.matrixWorldInverse);
    this.camera.projectionMatrix.copy(camera.projectionMatrix);
    within(renderer, camera, () => {
      renderer.setRenderTarget(target);
      renderer.state.buffers.color.setMask(true);
      renderer.clear(true, true, false);
      renderer.render(this.scene, this.camera);
    });
    renderer.getContext().depthRange(0, 1);
    const { uniforms } = this.screen;
    this.set("sheets", target.textures[0]);
    this.set("solid", target.textures[1]);
    this.set("nearest", target.depthTexture);
    uniforms["corner"]?.value.set(x, y);
    uniforms["size"]?.value.set(width, height);
    const toClip = uniforms["toPlace"]?.value as Matrix4;
    toClip.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(mesh.matrixWorld).invert();
    this.screen.uniformsNeedUpdate = true;
  }
}

function makeTarget(width: number, height: number): WebGLRenderTarget {
  const depthTexture = new DepthTexture(width, height, UnsignedInt248Type);
  depthTexture.format = DepthStencilFormat;
  const target = new WebGLRenderTarget(width, height, {
    count: 2,
    type: HalfFloatType,
    stencilBuffer: true,
    depthTexture,
    minFilter: NearestFilter,
    magFilter: NearestFilter,
  });
  const [, solid] = target.textures;
  if (solid) solid.type = UnsignedByteType;
  return target;
}
