// The picture outside the captured views: more blurred the further out, and continued where no surface was seen.
//
// A drawing with its coverage gets mip maps. What a level does not cover is filled from the next coarser one, which is
// push and pull (Gortler et al., The Lumigraph, 1996, section 3.3.4).

import {
  type Camera, Color, GLSL3, LinearFilter, LinearMipmapLinearFilter, Mesh, PlaneGeometry, Scene,
  ShaderMaterial, Vector2, WebGLRenderTarget, type WebGLRenderer,
} from "three";

const PARTS = 24; // of the picture's smaller side: the size of what is still seen apart where it is most blurred
const BLACK = new Color(0);
const SAMPLES = 4; // a pixel, as the canvas has them

export interface Blur {
  /** amount: 0 the scene as it is, 1 most blurred. */
  draw(renderer: WebGLRenderer, scene: Scene, camera: Camera, amount: number): void;
}

export function createBlur(): Blur {
  const target = new WebGLRenderTarget(1, 1, {
    samples: SAMPLES, generateMipmaps: true, minFilter: LinearMipmapLinearFilter, magFilter: LinearFilter,
  });
  const uniforms = {
    picture: { value: target.texture },
    amount: { value: 0 },
    coarsest: { value: 0 }, // level where it is most blurred
    ground: { value: new Color() },
  };
  const material = new ShaderMaterial({
    glslVersion: GLSL3,
    depthTest: false,
    depthWrite: false,
    uniforms,
    vertexShader: `
      out vec2 at;
      void main() {
        at = uv;
        gl_Position = vec4(position.xy, 0.0, 1.0);
      }`,
    fragmentShader: `
      uniform sampler2D picture; // R, G, B times coverage, and coverage
      uniform float amount, coarsest;
      uniform vec3 ground;
      in vec2 at;
      out vec4 colour;
      vec4 softly(float level) { // bilinear texels of coarse levels would be seen as squares
        vec2 texel = 0.75 * exp2(level) / vec2(textureSize(picture, 0));
        vec4 sum = vec4(0.0);
        for (int i = 0; i < 4; i++)
          sum += textureLod(picture, at + texel * vec2(i % 2 == 0 ? -1 : 1, i < 2 ? -1 : 1), level);
        return 0.25 * sum;
      }
      void main() {
        vec4 sharp = textureLod(picture, at, 0.0);
        float first = amount * coarsest;
        float last = log2(float(max(textureSize(picture, 0).x, textureSize(picture, 0).y)));
        vec4 sum = first < 0.1 ? sharp : softly(first);
        for (float level = floor(first) + 1.0; level <= last && sum.a < 0.996; level++)
          sum += (1.0 - sum.a) * softly(level);
        vec3 blurred = sum.a > 0.0 ? sum.rgb / sum.a : ground;
        colour = vec4(mix(sharp.rgb + (1.0 - sharp.a) * ground, blurred, min(4.0 * amount, 1.0)), 1.0);
      }`,
  });
  const quad = new Mesh(new PlaneGeometry(2, 2), material);
  quad.frustumCulled = false;
  const stage = new Scene().add(quad);
  const size = new Vector2();

  return {
    draw: (renderer, scene, camera, amount) => {
      renderer.getDrawingBufferSize(size);
      target.setSize(size.x, size.y);
      uniforms.amount.value = amount;
      uniforms.coarsest.value = Math.max(Math.log2(Math.min(size.x, size.y) / PARTS), 0);
      renderer.getClearColor(uniforms.ground.value);
      renderer.setClearColor(BLACK, 0);
      renderer.setRenderTarget(target);
      renderer.clear();
      renderer.render(scene, camera);
      renderer.setRenderTarget(null);
      renderer.setClearColor(uniforms.ground.value, 1);
      renderer.render(stage, camera);
    },
  };
}
