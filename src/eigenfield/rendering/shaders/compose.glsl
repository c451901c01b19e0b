// Equations 7 and 8, texel by texel: means and eigen textures, weighted and summed into one texture of the whole atlas,
// which surface.glsl then draws (decision 15).
//
// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl/composer.py and as GLSL ES 3.00 by the web viewer. Whoever
// includes it writes the #version line, the precisions, cubic.glsl before it, and a main for each of four passes. All
// draw into textures whose row 0 is v = 0. All but the first add R, G, B and opacity to what is there, which is cleared
// to zeros before:
//   placeOf       once, the mesh laid out by its texture coordinates: where each texel lies
//   sumTextures   for each mean and basis, a rectangle of a grid: its textures, weighted, as R, G, B
//   finerValue    for each grid coarser than the atlas, all of the atlas: what the grid holds there
//   finerOpacity  in a scene with sheets, once for all of the atlas: the opacity of the sheets
// Four numbers share a texel of what is stored: one channel of four eigen textures (decision 13), or four channels of a
// mean. In `words` a layer is one channel of one texture, and has the two bytes of its codes. Colours are the photographs'
// own (sRGB-coded) numbers from end to end: no conversion, in or out.

#define LAYERS 64  // most that one draw sums
#define LEVEL 1e-4 // a height of no more than this is as good as none
#define MOST 6e4   // halves end at 65504
#define REACH 2    // texels beside a chart, each way, that the widest filter reads

uniform sampler2DArray stored; // codes / 255, or values; anything finite where there is no texture (yet)
uniform int firstLayer;
uniform int sharing;           // 1: each of `entries` has a layer; 4: four channels of a mean share one
uniform bool words;
uniform int channels;
uniform int entries;           // entry e is channel e % channels, of group (in words: of texture) e / channels;
                               // at most LAYERS
uniform vec4 scale[LAYERS];    // value = stored * scale + bias, of each entry: 0 for textures that are not summed
uniform vec4 bias[LAYERS];
uniform vec3 colours[LAYERS];  // R, G, B of the value 1 of each channel

uniform bool rayWeights;       // look weights up where the ray to the eye meets the view plane; else they are in `scale`
uniform sampler2DArray weightMaps; // layer g: weights 4 g .. 4 g + 3 over X, Y in -1..1, nodes on the edges
uniform int firstGroup;
uniform sampler2D places;      // of each texel that is drawn, as `placeOf` makes them; w is 0 where there is no surface
uniform vec2 beside;           // a texel of the target in `own`, if texels beside a chart take what is stored in it; else 0
uniform vec3 eye;              // X, Y and height above the view plane

uniform sampler2D coarse;      // a grid's sum; or the opacity, in the first channel, at a density of its own

// A point of the surface, given as X, Y and height above the view plane, as it is seen from the plane: X, Y and 1 over
// the height. Halves keep that well enough for points near and far.
vec4 placeOf(vec3 point) {
  float height = point.z < 0.0 ? min(point.z, -LEVEL) : max(point.z, LEVEL);
  return vec4(clamp(vec3(point.xy, 1.0) / height, -MOST, MOST), 1.0);
}

// Where the ray from a point of the surface to the eye meets the view plane, as X, Y; where it does not (the eye is
// level with the point, or the point lies behind the cameras) and where there is no surface, where the eye itself stands.
vec2 viewCoordinates(vec4 place) {
  float part = 1.0 - eye.z * place.z;
  bool meets = place.w > 0.0 && part > 1e-5;
  return clamp(meets ? (eye.xy - eye.z * place.xy) / part : eye.xy, -1.0, 1.0);
}

// What `beside` adds to the w of a place that lies so many texels beside its chart; and those texels.
float codeOf(vec2 shift) { return shift.x + float(REACH) + float(2 * REACH + 1) * (shift.y + float(REACH)); }
vec2 shiftOf(vec4 place) {
  int code = int(place.w + 0.5) - 1;
  return code < 0 ? vec2(0.0) : vec2(code % (2 * REACH + 1) - REACH, code / (2 * REACH + 1) - REACH);
}

// The sum of a mean's or a basis's textures at `own` texture coordinates of theirs, as R, G, B.
vec4 sumTextures(vec2 own) {
  vec2 nodes = vec2(textureSize(weightMaps, 0).xy);
  vec4 place = rayWeights || beside.x > 0.0 ? texelFetch(places, ivec2(gl_FragCoord.xy), 0) : vec4(0.0);
  vec2 view = rayWeights ? viewCoordinates(place) : vec2(0.0);
  own -= beside * shiftOf(place);
  vec2 at = (0.5 + (0.5 + 0.5 * view) * (nodes - 1.0)) / nodes;
  vec4 four = vec4(1.0), weights = four;
  vec3 sum = vec3(0.0);
  int entry = 0;
  for (int group = 0; entry < entries; group++) {
    if (rayWeights && (!words || group % 4 == 0)) {
      four = textureLod(weightMaps, vec3(at, float(firstGroup + (words ? group / 4 : group))), 0.0);
    }
    weights = words ? vec4(four[group % 4]) : four;
    for (int channel = 0; channel < channels; channel++) {
      vec4 read = textureLod(stored, vec3(own, float(firstLayer + entry / sharing)), 0.0) * scale[entry] + bias[entry];
      sum += colours[channel] * dot(weights, read);
      entry++;
    }
  }
  return vec4(sum, 0.0);
}

// The value of the grid `coarse` at texture coordinates of the atlas.
vec4 finerValue(vec2 uv) { return readCubic(coarse, uv * vec2(textureSize(coarse, 0)) - 0.5); }

// The opacity in `coarse` at texture coordinates of the atlas.
vec4 finerOpacity(vec2 uv) { return vec4(vec3(0.0), finerValue(uv).r); }
