// A renderer and a graphics context that draw nothing and remember what they were asked for.

globalThis.WebGL2RenderingContext = class {};
globalThis.WebGLTexture = class {};

const NUMBERS = { MAX_TEXTURE_SIZE: 4096, MAX_ARRAY_TEXTURE_LAYERS: 256, VIEWPORT: [0, 0, 1, 1], COLOR_WRITEMASK: [] };

/** `puts`: what came into which component of which layer of which texture. `lose`: it is gone from then on. */
function makeContext() {
  const puts = [];
  let lost = false;
  let [array, layer, component, picture] = [null, 0, 0, null];
  const known = {
    getParameter: (name) => NUMBERS[name] ?? 0,
    getError: () => "NO_ERROR",
    getExtension: () => ({}),
    isContextLost: () => lost,
    createTexture: () => new WebGLTexture(),
    bindTexture: (target, texture) => (array = target === "TEXTURE_2D_ARRAY" && texture ? texture : array),
    texSubImage3D: (...given) => puts.push({ texture: array, layer: 0, component: 0, picture: given.at(-1).name }),
    texSubImage2D: (...given) => (picture = given.at(-1).name),
    framebufferTextureLayer: (_target, _attachment, texture, _level, to) => ([array, layer] = [texture, to]),
    colorMask: (...mask) => (component = mask.indexOf(true)),
    drawArrays: () => puts.push({ texture: array, layer, component, picture }),
  };
  const gl = new Proxy(new WebGL2RenderingContext(), {
    get: (_target, name) => known[name] ?? (/^[A-Z0-9_]+$/.test(String(name)) ? name : () => null),
  });
  return { gl, puts, lose: () => (lost = true) };
}

/** `drawn`: of each draw its scene, what it was drawn into, and what that showed then. */
export function makeRenderer() {
  const { gl, puts, lose } = makeContext();
  const drawn = [];
  let target = null;
  const renderer = {
    domElement: new EventTarget(),
    info: { render: { frame: 0 }, autoReset: true },
    xr: { enabled: false },
    shadowMap: { autoUpdate: false },
    state: { buffers: { color: { setMask() {} } } },
    getContext: () => gl,
    getCurrentViewport: (none) => none, // of no size: sheets are prepared, and not drawn
    getRenderTarget: () => target,
    setRenderTarget: (next) => (target = next),
    getActiveCubeFace: () => 0,
    getActiveMipmapLevel: () => 0,
    getClearAlpha: () => 0,
    getClearColor() {},
    setClearColor() {},
    clear() {},
    render: (scene) => drawn.push({ scene, target, shown: scene.children.map(shownBy) }),
  };
  return { renderer, puts, drawn, lose };
}

/** Where the mesh lies in a pass that lays it out; else the factors of a sum, and whether each texel looks weights up. */
function shownBy({ geometry, material: { uniforms }, visible }) {
  if (geometry.attributes.onPlane) return { places: [...geometry.attributes.onPlane.array] };
  if (!uniforms.scale) return { finer: true };
  const { entries, scale, rayWeights } = uniforms;
  return { visible, rays: rayWeights.value, scale: [...scale.value.slice(0, 4 * entries.value)] };
}
