// Equations 7 and 8 on the surface of the proxy, one fragment at a time.
//
// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl.py and as GLSL ES 3.00 by the web viewer. Whoever
// includes it writes the #version line, the precisions, and
//   COUNT    eigen textures in the array, at least 1
//   BICUBIC  where the finest level is read: 0 bilinear, 1 Catmull-Rom for the mean, 2 for the eigen textures too
// Pixels of more than `finest` texels are left to the samplers and their mip maps.
// Colours are the photographs' own (sRGB-coded) numbers from end to end: no conversion, in or out.

#define GROUPS ((COUNT + 3) / 4)

uniform sampler2D meanTexture;
uniform vec3 meanScale;               // mean = stored * meanScale + meanBias, stored in 0..1
uniform vec3 meanBias;

uniform int count;                    // eigen textures to sum, 0 to COUNT
uniform sampler2DArray eigenTextures; // stored codes / 255, a layer each
uniform vec3 eigenScale[COUNT];       // 255 * scale, of each channel
uniform vec3 eigenBias[COUNT];        // -zero * scale

uniform bool rayWeights;              // look the weights up where the ray to the eye meets the view plane
uniform vec4 viewWeights[GROUPS];     // else these: weights 4 g .. 4 g + 3
uniform sampler2DArray weightMaps;    // layer g: weights 4 g .. 4 g + 3 over X, Y in -1..1, nodes on the edges

uniform float finest;                 // texels a pixel up to which the finest level is read: 1.5 times those a pixel
                                      // of the photographs covers, which holds no more than its own average
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

float levelBias() { return -log2(finest); }

#if BICUBIC > 0
// Catmull-Rom's sixteen taps as nine bilinear ones: of the two middle taps of an axis one between them.
struct Taps {
  vec2 at[3];      // texture coordinates
  vec2 weight[3];
  bool fine;       // false: a pixel covers too many texels, let the sampler filter
};

Taps makeTaps(vec2 uv, vec2 size) {
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
  vec2 across = dFdx(uv) * size, down = dFdy(uv) * size;
  taps.fine = max(dot(across, across), dot(down, down)) <= finest * finest;
  return taps;
}

vec3 readMean(Taps taps, vec2 uv) {
  vec3 plain = texture(meanTexture, uv, levelBias()).rgb;
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
vec3 readEigen(Taps taps, vec2 uv, int layer) {
  if (!taps.fine) return texture(eigenTextures, vec3(uv, float(layer)), levelBias()).rgb;
  vec3 sum = vec3(0.0);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      sum += taps.weight[column].x * taps.weight[row].y *
             textureLod(eigenTextures, vec3(taps.at[column].x, taps.at[row].y, float(layer)), 0.0).rgb;
  return sum;
}
#endif

vec4 weightsOf(int group, vec2 view) {
  if (!rayWeights) return viewWeights[group];
  vec2 nodes = vec2(textureSize(weightMaps, 0).xy);
  vec2 at = (0.5 + (0.5 + 0.5 * view) * (nodes - 1.0)) / nodes;
  return textureLod(weightMaps, vec3(at, float(group)), 0.0);
}

// The mean alone, as R, G, B.
vec3 meanColour(vec2 uv) {
#if BICUBIC > 0
  vec3 stored = readMean(makeTaps(uv, vec2(textureSize(meanTexture, 0))), uv);
#else
  vec3 stored = texture(meanTexture, uv, levelBias()).rgb;
#endif
  return toRGB * (stored * meanScale + meanBias);
}

// One eigen texture's values, which are signed.
vec3 eigenColour(vec2 uv, int layer) {
  return toRGB * (texture(eigenTextures, vec3(uv, float(layer)), levelBias()).rgb * eigenScale[layer] + eigenBias[layer]);
}

// mean + sum over j of w_j(view) E_j (equation 8) at texture coordinates uv of the surface point `place`.
vec3 surfaceColour(vec2 uv, vec3 place) {
  vec3 sum = vec3(0.0);
  vec2 view = rayWeights ? viewCoordinates(place) : vec2(0.0);
#if BICUBIC > 1
  Taps taps = makeTaps(uv, vec2(textureSize(eigenTextures, 0).xy));
#endif
  for (int group = 0; group < GROUPS; group++) {
    if (4 * group >= count) break;
    vec4 weights = weightsOf(group, view);
    for (int k = 0; k < 4; k++) {
      int j = 4 * group + k;
      if (j >= count) break;
#if BICUBIC > 1
      vec3 stored = readEigen(taps, uv, j);
#else
      vec3 stored = texture(eigenTextures, vec3(uv, float(j)), levelBias()).rgb;
#endif
      sum += weights[k] * (stored * eigenScale[j] + eigenBias[j]);
    }
  }
  vec3 colour = meanColour(uv) + toRGB * sum;
  return clamp(colour * exposureScale + exposureBias, 0.0, 1.0);
}
