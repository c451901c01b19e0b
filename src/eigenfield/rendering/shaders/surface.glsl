// The composed texture (compose.glsl) on the surface of the proxy.
//
// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl/renderer.py and as GLSL ES 3.00 by the web viewer. Whoever
// includes it writes the #version line, the precisions, cubic.glsl before it, and
//   BICUBIC   how the finest level is read: 0 bilinear, 1 Catmull-Rom
// Pixels of more than `finest` texels are left to the sampler and its mip maps.

uniform sampler2D composed;
uniform float finest;       // texels a pixel up to which the finest level is read: 1.5 times those a pixel of the
                            // photographs covers, which holds no more than its own average
uniform vec3 exposureScale; // picture = RGB * exposureScale + exposureBias: 1 / gain and -offset / gain of a captured
uniform vec3 exposureBias;  // camera of a harmonised scene, else 1 and 0

// R, G, B and opacity at texture coordinates; nothing is cut off.
vec4 surfaceValue(vec2 uv) {
  vec4 plain = texture(composed, uv, -log2(finest));
#if BICUBIC == 1
  vec2 size = vec2(textureSize(composed, 0));
  vec2 across = dFdx(uv) * size, down = dFdy(uv) * size;
  bool fine = max(dot(across, across), dot(down, down)) <= finest * finest;
  if (fine) return readCubic(composed, clamp(uv * size, vec2(0.5), size - 0.5) - 0.5);
#endif
  return plain;
}

// What is seen of a value of the surface.
vec3 seenColour(vec4 value) { return value.rgb * exposureScale + exposureBias; }

// What an opaque surface shows at texture coordinates.
vec3 surfaceColour(vec2 uv) { return clamp(seenColour(surfaceValue(uv)), 0.0, 1.0); }

// What a sheet adds to the sheets behind it at texture coordinates: R, G, B times its opacity, and its opacity. It is
// blended with the factors ONE and ONE_MINUS_SRC_ALPHA. Colours are not cut off: those of all sheets together count.
vec4 sheetColour(vec2 uv) {
  vec4 value = surfaceValue(uv);
  float opacity = clamp(value.a, 0.0, 1.0);
  return vec4(seenColour(value) * opacity, opacity);
}
