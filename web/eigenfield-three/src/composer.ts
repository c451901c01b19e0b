// Equation 8 on the GPU: means and eigen textures, weighted and summed into one texture when the viewpoint moves.

import {
  Camera,
  Scene,
  Vector2,
  Vector3,
  type BufferGeometry,
  type DataArrayTexture,
  type Mesh,
  type RawShaderMaterial,
  type Texture,
  type WebGLRenderTarget,
  type WebGLRenderer,
} from "three";
import type { ViewPlane } from "./info.js";
import { gridsOf, smaller, type Size } from "./memory.js";
import type { Part } from "./parts.js";
import { FINER, FINER_OPACITY, LAYERS, SUM, makePlacing, makePlacingMaterial, makeQuad, makeTarget, within } from "./passes.js";
import type { Surface } from "./surface.js";

/** What is summed: everything that makes a difference to it. */
export interface Recipe {
  version: number; // of what is there
  mean: boolean;
  opacity: number; // version of that of sheets; 0: there is none
  only: number | null; // one eigen texture of each basis, as it is; else the first `count`, weighted
  count: number;
  weights: Float64Array; // of all textures of all bases
  eye: [number, number, number] | null; // X, Y, height: each texel looks its weights up in `maps`
  places: number; // version of the surface since which texels lie as they do; 0 where nothing depends on it
  maps: DataArrayTexture | null;
}

const STILL: Recipe = {
  version: 0,
  mean: true,
  opacity: 0,
  only: null,
  count: 0,
  weights: new Float64Array(0),
  eye: null,
  places: 0,
  maps: null,
};

type Quad = Mesh<BufferGeometry, RawShaderMaterial>;

/** A part's draw of some of its groups. */
interface Step {
  part: Part;
  first: number; // group
  groups: number;
  quad: Quad;
}

interface Places {
  target: WebGLRenderTarget;
  material: RawShaderMaterial;
  version: number; // of the surface
}

interface Grid {
  target: WebGLRenderTarget;
  scene: Scene;
  steps: Step[];
  places: Places | null; // where its texels lie, once that is needed
}

/** The opacity of sheets: summed into a target of its own, and from there brought to the atlas's size. */
interface OpacityPass {
  target: WebGLRenderTarget;
  sum: Scene;
  finer: Scene;
}

/** Sums means and eigen textures into one texture of the whole atlas, for one viewpoint after the other. */
export class Composer {
  private readonly grids: Grid[]; // that of the whole atlas last
  private composed: Recipe | null = null;
  private readonly opacity: OpacityPass | null;
  private opacityDrawn = 0; // its version
  private readonly camera = new Camera();

  /** `opacity`: of sheets; `down`: what is composed has the atlas's side over this; `snaps`: it has fewer texels than what
   * is stored, and those beside a chart take what is stored in it. */
  constructor(
    atlas: [number, number],
    parts: Part[],
    opacity: Part | null,
    down: number,
    private readonly snaps: boolean,
    private readonly surface: Surface,
    private readonly plane: ViewPlane,
  ) {
    const means = parts.filter(({ basis }) => !basis).map(({ grid }) => ({ size: grid }));
    const bases = parts.filter(({ basis }) => basis);
    const [own, ...coarser] = gridsOf({ atlas, means, bases });
    const make = (size: [number, number], mips: boolean): Grid => {
      const own = parts.filter(({ grid }) => grid.join() === size.join());
      const steps = own.flatMap((part) => stepsOf(part, snaps ? smaller(size, down) : null));
      const scene = new Scene();
      steps.forEach(({ quad }, i) => scene.add(Object.assign(quad, { renderOrder: i })));
      return { target: makeTarget(smaller(size, down), mips), scene, steps, places: null };
    };
    const whole = make(own ?? atlas, true);
    this.grids = coarser.map((size) => make(size, false));
    for (const { target } of this.grids) {
      const quad = makeQuad(FINER, [0, 0, 1, 1], { coarse: { value: target.texture } });
      whole.scene.add(Object.assign(quad, { renderOrder: whole.scene.children.length }));
    }
    this.grids.push(whole);
    this.opacity = opacity && opacityPass(opacity, down);
  }

  /** R, G, B and the opacity of sheets, as half-floats with mips, v = 0 in row 0. */
  get texture(): Texture | null {
    return this.grids.at(-1)?.target.texture ?? null;
  }

  /** Fills `texture`, unless it holds that already. To be called before a draw by `camera`, or within one. */
  compose(renderer: WebGLRenderer, camera: Camera, recipe: Recipe): void {
    if (this.composed && isSame(this.composed, recipe)) return;
    this.composed = recipe;
    within(renderer, camera, () => {
      if (recipe.opacity > this.opacityDrawn) this.drawOpacity(renderer, recipe.opacity);
      for (const grid of this.grids) {
        const rays = recipe.eye !== null && grid.steps.some(({ part }) => part.basis);
        if (rays || this.snaps) this.findPlaces(renderer, grid, recipe.places);
        for (const step of grid.steps) setStep(step, grid.places?.target.texture ?? null, recipe);
        this.draw(renderer, grid.scene, grid.target, this.opacityDrawn > 0 && grid === this.grids.at(-1));
      }
    });
  }

  dispose(): void {
    for (const { target, places, scene } of this.grids) {
      target.dispose();
      places?.target.dispose();
      places?.material.dispose();
      freeQuads(scene);
    }
    this.opacity?.target.dispose();
    if (this.opacity) [this.opacity.sum, this.opacity.finer].forEach(freeQuads);
  }

  /** Opacity does not change from view to view: it is drawn when it comes, of a clip with each frame, and stays in the
   * alpha of what is composed. */
  private drawOpacity(renderer: WebGLRenderer, version: number): void {
    const [whole, own] = [this.grids.at(-1), this.opacity];
    if (!own || !whole) return;
    this.draw(renderer, own.sum, own.target);
    this.draw(renderer, own.finer, whole.target);
    this.opacityDrawn = version;
  }

  /** `version`: of the surface, from which on they are as they are now. */
  private findPlaces(renderer: WebGLRenderer, grid: Grid, version: number): void {
    if (grid.places && grid.places.version >= version) return;
    const target = grid.places?.target ?? makeTarget([grid.target.width, grid.target.height], false);
    const material = grid.places?.material ?? makePlacingMaterial(target);
    const placing = makePlacing(this.surface.geometry, this.plane, material);
    this.draw(renderer, new Scene().add(placing), target);
    placing.geometry.dispose();
    grid.places = { target, material, version: this.surface.version };
  }

  /** `keep`: what the target has in its alpha stays there. */
  private draw(renderer: WebGLRenderer, scene: Scene, target: WebGLRenderTarget, keep = false): void {
    renderer.setRenderTarget(target);
    renderer.state.buffers.color.setMask(true); // whatever the material before had
    const gl = renderer.getContext();
    if (keep) gl.colorMask(true, true, true, false);
    renderer.clear(true, false, false);
    if (keep) gl.colorMask(true, true, true, true);
    renderer.render(scene, this.camera);
  }
}

function opacityPass(part: Part, down: number): OpacityPass {
  const target = makeTarget(smaller(part.grid, down), false);
  const steps = stepsOf(part, null);
  for (const step of steps) setStep(step, null, STILL);
  const [sum, finer] = [new Scene(), new Scene()];
  sum.add(...steps.map(({ quad }) => quad));
  finer.add(makeQuad(FINER_OPACITY, [0, 0, 1, 1], { coarse: { value: target.texture } }));
  return { target, sum, finer };
}

function freeQuads(scene: Scene): void {
  for (const { geometry, material } of scene.children as Quad[]) {
    geometry.dispose();
    material.dispose();
  }
}

/** `target`: its size, if texels beside a chart take what is stored in it. */
function stepsOf(part: Part, target: Size | null): Step[] {
  const [left, top, right, bottom] = part.rectangle;
  const beside = target && new Vector2(1 / ((right - left) * target[0]), 1 / ((bottom - top) * target[1]));
  const channels = part.colours.length;
  const [all, fitting] = [part.scale.length / (4 * channels), Math.floor(LAYERS / channels)];
  const most = part.words ? 4 * Math.floor(fitting / 4) : fitting; // maps of weights have four to a layer
  const steps: Step[] = [];
  for (let first = 0; first < all; first += most) {
    const colours = Array.from({ length: LAYERS }, (_, i) => new Vector3(...(part.colours[i] ?? [0, 0, 0])));
    const sharing = part.basis || part.words ? 1 : 4;
    const quad = makeQuad(SUM, part.rectangle, {
      stored: { value: part.stored },
      firstLayer: { value: Math.floor((first * channels) / sharing) },
      sharing: { value: sharing },
      words: { value: part.words },
      channels: { value: channels },
      entries: { value: 0 },
      scale: { value: new Float32Array(4 * LAYERS) },
      bias: { value: new Float32Array(4 * LAYERS) },
      colours: { value: colours },
      rayWeights: { value: false },
      weightMaps: { value: null },
      firstGroup: { value: (part.basis?.group ?? 0) + (part.words ? first / 4 : first) },
      places: { value: null },
      beside: { value: beside ?? new Vector2() },
      eye: { value: new Vector3() },
    });
    steps.push({ part, first, groups: Math.min(most, all - first), quad });
  }
  return steps;
}

/** Gives a step the numbers of what is to be summed; those of other textures are zero. */
function setStep({ part, first, groups, quad }: Step, places: Texture | null, recipe: Recipe): void {
  const { basis, colours, words } = part;
  const { uniforms } = quad.material;
  const set = (name: string, value: unknown): void => {
    const uniform = uniforms[name];
    if (uniform) uniform.value = value;
  };
  const rays = basis !== null && recipe.eye !== null && recipe.only === null;
  const each = words ? 1 : 4; // textures of a group
  const factors = Array.from({ length: each * groups }, (_, i) => factorOf(basis, each * first + i, recipe, rays));
  const used = Math.ceil((factors.findLastIndex((factor) => factor !== 0) + 1) / each);
  const [scale, bias] = [uniforms["scale"]?.value as Float32Array, uniforms["bias"]?.value as Float32Array];
  const channels = colours.length;
  for (let i = 0; i < 4 * channels * used; i++) {
    const factor = factors[each * Math.floor(i / (4 * channels)) + (i % each)] ?? 0;
    scale[i] = factor * (part.scale[4 * channels * first + i] ?? 0);
    bias[i] = factor * (part.bias[4 * channels * first + i] ?? 0);
  }
  set("entries", channels * used);
  set("rayWeights", rays);
  set("weightMaps", rays ? recipe.maps : null);
  set("places", places);
  if (recipe.eye) (uniforms["eye"]?.value as Vector3).set(...recipe.eye);
  quad.visible = used > 0;
  quad.material.uniformsNeedUpdate = true;
}

/** What texture j of a part is multiplied with before its values are made: 0 if it is not summed. */
function factorOf(basis: Part["basis"], j: number, recipe: Recipe, rays: boolean): number {
  if (!basis) return recipe.mean ? 1 : 0;
  if (!basis.ready[j]) return 0;
  if (recipe.only !== null) return j === recipe.only ? 1 : 0;
  if (j >= recipe.count) return 0;
  return rays ? 1 : (recipe.weights[basis.column + j] ?? 0);
}

function isSame(one: Recipe, other: Recipe): boolean {
  const { weights, eye, ...rest } = one;
  const same = Object.entries(rest).every(([name, value]) => other[name as keyof Recipe] === value);
  if (!same || (eye === null) !== (other.eye === null)) return false;
  if (one.only !== null) return true; // as it is, wherever the eye
  if (eye) return eye.every((value, i) => value === other.eye?.[i]);
  return weights.every((value, i) => value === other.weights[i]);
}
