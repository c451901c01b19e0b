// The passes of packing.ts.

/** Codes at p = 1 that a stored 1 stands for: 1023 at the smallest p, 1/256, is still a half-float. */
export const FINE = 4;

const BESIDE = 3; // texels beside a chart that get its values: the filters of the sums and of the surface reach as far

/** All of the viewport. */
export const TRIANGLE = `#version 300 es
void main() {
  gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0);
}
`;

/** Codes as they are, which most are: where software draws, PACK takes ten times as long, as both sides of a branch run. */
export const COPY = `#version 300 es
precision highp float;
uniform highp sampler2D picture;
uniform vec4 factors;
uniform int first; // row of the picture with which the texture begins
out vec4 stored;
void main() {
  stored = vec4(dot(texelFetch(picture, ivec2(gl_FragCoord.xy) - ivec2(0, first), 0), factors));
}
`;

/** What is stored of a picture. Where it becomes smaller, a texel is the mean of those in charts among the texels that it
 * takes the place of, or of all where none is; the second component says whether one is. */
export const PACK = `#version 300 es
precision highp float;
precision highp int;
#define EDGE 1e-3 // of a texel: less is rounding
uniform highp sampler2D picture;
uniform highp sampler2D precisions;
uniform highp sampler2D covered; // texels of the grid that lie in charts
uniform vec4 factors;
uniform ivec2 size; // of the picture
uniform ivec2 made; // of what is stored
uniform int first; // row of the picture with which the texture begins
uniform ivec2 corner; // of the picture in its grid
uniform ivec2 nodes; // columns and rows of the precisions that are used; 0: codes are stored as they are
uniform float zero;
out vec4 stored;
float nodeAt(ivec2 at) {
  return texelFetch(precisions, clamp(at, ivec2(0), nodes - 1), 0).r;
}
float precisionAt(vec2 uv) {
  vec2 at = uv * vec2(nodes) - 0.5;
  ivec2 low = ivec2(floor(at));
  vec2 part = at - vec2(low);
  float upper = mix(nodeAt(low), nodeAt(low + ivec2(1, 0)), part.x);
  float lower = mix(nodeAt(low + ivec2(0, 1)), nodeAt(low + ivec2(1, 1)), part.x);
  return (255.0 * mix(upper, lower, part.y) + 1.0) / 256.0;
}
float valueAt(ivec2 texel) {
  float code = dot(texelFetch(picture, texel - ivec2(0, first), 0), factors);
  if (nodes.x == 0) return code;
  float fine = precisionAt((vec2(texel) + 0.5) / vec2(size));
  return clamp((code - zero) / fine / ${FINE}.0, -65504.0, 65504.0);
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  if (made == size) {
    stored = vec4(valueAt(at));
    return;
  }
  vec2 ratio = vec2(size) / vec2(made), low = vec2(at) * ratio, high = low + ratio;
  vec2 charts = vec2(0.0), all = vec2(0.0);
  for (int y = int(low.y); float(y) < high.y - EDGE; y++) {
    for (int x = int(low.x); float(x) < high.x - EDGE; x++) {
      vec2 part = min(high, vec2(x + 1, y + 1)) - max(low, vec2(x, y));
      vec2 one = part.x * part.y * vec2(valueAt(ivec2(x, y)), 1.0);
      all += one;
      charts += one * texelFetch(covered, corner + ivec2(x, y), 0).r;
    }
  }
  vec2 sum = charts.y > EDGE ? charts : all;
  stored = vec4(sum.x / sum.y, step(EDGE, charts.y), 0.0, 0.0);
}
`;

/** A smaller texture: beside charts what lies nearest in them. */
export const SPREAD = `#version 300 es
precision highp float;
precision highp int;
uniform highp sampler2D picture; // values, and whether they are of a chart
uniform ivec2 size; // as much of it as is used
out vec4 stored;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 own = texelFetch(picture, at, 0).rg;
  vec2 sum = vec2(own.r * own.g, own.g);
  for (int far = 1; far <= ${BESIDE} && sum.y == 0.0; far++) {
    for (int y = -far; y <= far; y++) {
      for (int x = -far; x <= far; x++) {
        vec2 near = texelFetch(picture, clamp(at + ivec2(x, y), ivec2(0), size - 1), 0).rg;
        sum += vec2(near.r * near.g, near.g);
      }
    }
  }
  stored = vec4(sum.y > 0.0 ? sum.x / sum.y : own.r);
}
`;

/** The charts of a mesh, by its texture coordinates. */
export const CHARTS = [
  `#version 300 es
in vec2 uv;
void main() { gl_Position = vec4(2.0 * uv - 1.0, 0.0, 1.0); }
`,
  `#version 300 es
precision mediump float;
out vec4 covered;
void main() { covered = vec4(1.0); }
`,
] as const;
