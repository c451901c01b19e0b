// Equations 7 and 8 on the surface of the proxy, one fragment at a time.
//
// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl.py and as GLSL ES 3.00 by the web viewer. Whoever
// includes it writes the #version line, the precisions, and
//   COUNT     eigen textures in the array, at least 1
//   CHANNELS  of each as stored: 3, or 1 that stands for all three
//   BICUBIC   where the finest level is read: 0 bilinear, 1 Catmull-Rom for the mean, 2 for the eigen textures too
// Four eigen textures share a texel: layer CHANNELS g + c of the array holds channel c of textures 4 g .. 4 g + 3, so
// that a channel of four is one read and one product with their weights (decision 13).
// Pixels of more than `finest` texels are left to the samplers and their mip maps.
// Colours are the photographs' own (sRGB-coded) numbers from end to end: no conversion, in or out.

#define GROUPS ((COUNT + 3) / 4)

uniform sampler2D meanTexture;
uniform vec3 meanScale;               // mean = stored * meanScale + meanBias, stored in 0..1
uniform vec3 meanBias;

uniform int count;                    // eigen textures to sum, 0 to COUNT
uniform sampler2DArray eigenTextures; // stored codes / 255; anything finite where there is no texture (yet)
uniform vec4 eigenScale[CHANNELS * GROUPS]; // 255 * scale, of each layer
uniform vec4 eigenBias[CHANNELS * GROUPS];  // -zero * scale

uniform bool rayWeights;              // look the weights up where the ray to the eye meets the view plane
uniform vec4 viewWeights[GROUPS];     // else these: weights 4 g .. 4 g + 3
uniform sampler2DArray weightMaps;    // layer g: weights 4 g .. 4 g + 3 over X, Y in -1..1, nodes on the edges

uniform float finest;                 // texels a pixel up to which the finest level is read: 1.5 times those a pixel
                                      // of the photographs covers, which holds no more than its own average
uniform float finestEigen;            // the same in texels of the eigen textures, which may be smaller than the mean
uniform vec3 eye;                     // capture's world, as all that follows
uniform vec3 planeOrigin;
uniform vec3 planeNormal;
uniform vec3 planeX;                  // right / extent[0], up / extent[1]; zero where the extent is
uniform vec3 planeY;

uniform mat3 toRGB;                   // channels as stored to R, G, B
uniform vec3 exposureScale;           // picture = RGB * exposureScale + exposureBias: 1 / gain and -offset / gain of a
uniform vec3 exposureBias;            // captured camera of a harmonised scene, else 1 and 0

// Where the ray from a point of the surface to the eye meets the view plane, as X, Y; where it does not (the eye is
// level with the point, or the point lies behind the cameras), where the eye itself stands.
vec2 viewCoordinates(vec3 place) {
  vec3 ray = eye - place;
  float along = dot(planeNormal, ray);
  float height = dot(planeNormal, planeOrigin - place);
  bool meets = along * height > 0.0 && abs(along) > 1e-5 * length(ray);
  vec3 offset = (meets ? place + ray * (height / along) : eye) - planeOrigin;
  return clamp(vec2(dot(offset, planeX), dot(offset, planeY)), -1.0, 1.0);
}

#if BICUBIC > 0
// Catmull-Rom's sixteen taps as nine bilinear ones: of the two middle taps of an axis one between them.
struct Taps {
  vec2 at[3];      // texture coordinates
  vec2 weight[3];
  vec2 across;     // what a pixel covers, in texture coordinates
  vec2 down;
  bool fine;       // false: that is too many texels, let the sampler filter
};

Taps makeTaps(vec2 uv, vec2 size, float most) {
  vec2 texel = clamp(uv * size, vec2(0.5), size - 0.5) - 0.5;
  vec2 base = floor(texel);
  vec2 f = texel - base;
  vec2 f2 = f * f, f3 = f2 * f;
  vec2 w0 = 0.5 * (2.0 * f2 - f3 - f), w1 = 0.5 * (3.0 * f3 - 5.0 * f2 + 2.0);
  vec2 w2 = 0.5 * (4.0 * f2 - 3.0 * f3 + f), w3 = 0.5 * (f3 - f2);
  Taps taps;
  taps.at[0] = (base - 0.5) / size;
  taps.at[1] = (base + 0.5 + w2 / (w1 + w2)) / size;
  taps.at[2] = (base + 2.5) / size;
  taps.weight[0] = w0;
  taps.weight[1] = w1 + w2;
  taps.weight[2] = w3;
  taps.across = dFdx(uv);
  taps.down = dFdy(uv);
  vec2 across = taps.across * size, down = taps.down * size;
  taps.fine = max(dot(across, across), dot(down, down)) <= most * most;
  return taps;
}

vec3 readMean(Taps taps, vec2 uv) {
  vec3 plain = texture(meanTexture, uv, -log2(finest)).rgb;
  if (!taps.fine) return plain;
  vec3 sum = vec3(0.0);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      sum += taps.weight[column].x * taps.weight[row].y *
             textureLod(meanTexture, vec2(taps.at[column].x, taps.at[row].y), 0.0).rgb;
  return sum;
}
#endif

#if BICUBIC > 1
Taps eigenTaps; // of this fragment; whoever reads layers makes them first

vec4 readLayer(vec2 uv, int layer) {
  if (!eigenTaps.fine) { // the next fragment's may be: no derivatives here
    vec2 across = eigenTaps.across / finestEigen, down = eigenTaps.down / finestEigen;
    return textureGrad(eigenTextures, vec3(uv, float(layer)), across, down);
  }
  vec4 sum = vec4(0.0);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      sum += eigenTaps.weight[column].x * eigenTaps.weight[row].y *
             textureLod(eigenTextures, vec3(eigenTaps.at[column].x, eigenTaps.at[row].y, float(layer)), 0.0);
  return sum;
}

void readyTaps(vec2 uv) { eigenTaps = makeTaps(uv, vec2(textureSize(eigenTextures, 0).xy), finestEigen); }
#else
vec4 readLayer(vec2 uv, int layer) {
  return texture(eigenTextures, vec3(uv, float(layer)), -log2(finestEigen));
}

void readyTaps(vec2 uv) {}
#endif

// One channel of four eigen textures, weighted and summed.
float sumLayer(vec2 uv, int layer, vec4 weights) {
  return dot(weights, readLayer(uv, layer) * eigenScale[layer] + eigenBias[layer]);
}

vec3 sumGroup(vec2 uv, int group, vec4 weights) {
#if CHANNELS == 1
  return vec3(sumLayer(uv, group, weights));
#else
  int layer = 3 * group;
  return vec3(sumLayer(uv, layer, weights), sumLayer(uv, layer + 1, weights), sumLayer(uv, layer + 2, weights));
#endif
}

vec4 weightsOf(int group, vec2 view) {
  if (!rayWeights) return viewWeights[group];
  vec2 nodes = vec2(textureSize(weightMaps, 0).xy);
  vec2 at = (0.5 + (0.5 + 0.5 * view) * (nodes - 1.0)) / nodes;
  return textureLod(weightMaps, vec3(at, float(group)), 0.0);
}

// The mean alone, as R, G, B.
vec3 meanColour(vec2 uv) {
#if BICUBIC > 0
  vec3 stored = readMean(makeTaps(uv, vec2(textureSize(meanTexture, 0)), finest), uv);
#else
  vec3 stored = texture(meanTexture, uv, -log2(finest)).rgb;
#endif
  return toRGB * (stored * meanScale + meanBias);
}

// One eigen texture's values, which are signed.
vec3 eigenColour(vec2 uv, int j) {
  readyTaps(uv);
  return toRGB * sumGroup(uv, j / 4, vec4(equal(ivec4(j % 4), ivec4(0, 1, 2, 3))));
}

// mean + sum over j of w_j(view) E_j (equation 8) at texture coordinates uv of the surface point `place`.
vec3 surfaceColour(vec2 uv, vec3 place) {
  vec3 sum = vec3(0.0);
  vec2 view = rayWeights ? viewCoordinates(place) : vec2(0.0);
  readyTaps(uv);
  for (int group = 0; group < GROUPS; group++) {
    if (4 * group >= count) break;
    vec4 summed = vec4(lessThan(ivec4(4 * group) + ivec4(0, 1, 2, 3), ivec4(count))); // 0 from `count` on
    sum += sumGroup(uv, group, weightsOf(group, view) * summed);
  }
  vec3 colour = meanColour(uv) + toRGB * sum;
  return clamp(colour * exposureScale + exposureBias, 0.0, 1.0);
}
