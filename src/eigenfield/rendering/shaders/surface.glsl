// The composed texture (compose.glsl) on the surface of the proxy.
//
// This body is compiled as GLSL 3.30 by eigenfield/rendering/opengl.py and as GLSL ES 3.00 by the web viewer. Whoever
// includes it writes the #version line, the precisions, cubic.glsl before it, and
//   BICUBIC   how the finest level is read: 0 bilinear, 1 Catmull-Rom
// Pixels of more than `finest` texels are left to the sampler and its mip maps.

uniform sampler2D composed;
uniform float finest;       // texels a pixel up to which the finest level is read: 1.5 times those a pixel of the
                            // photographs covers, which holds no more than its own average
uniform vec3 exposureScale; // picture = RGB * exposureScale + exposureBias: 1 / gain and -offset / gain of a captured
uniform vec3 exposureBias;  // camera of a harmonised scene, else 1 and 0

#if BICUBIC == 1
// Sixteen taps as nine bilinear ones: of the two middle taps of an axis one between them.
vec3 surfaceValue(vec2 uv) {
  vec2 size = vec2(textureSize(composed, 0));
  vec3 plain = texture(composed, uv, -log2(finest)).rgb;
  vec2 across = dFdx(uv) * size, down = dFdy(uv) * size;
  if (max(dot(across, across), dot(down, down)) > finest * finest) return plain;
  vec2 texel = clamp(uv * size, vec2(0.5), size - 0.5) - 0.5;
  vec2 base = floor(texel);
  vec4 wx = catmullRom(texel.x - base.x), wy = catmullRom(texel.y - base.y);
  vec2 middle = vec2(wx[1] + wx[2], wy[1] + wy[2]);
  vec2 first = (base - 0.5) / size, second = (base + 0.5 + vec2(wx[2], wy[2]) / middle) / size;
  vec2 third = (base + 2.5) / size;
  float x[3] = float[3](first.x, second.x, third.x), y[3] = float[3](first.y, second.y, third.y);
  float wide[3] = float[3](wx[0], middle.x, wx[3]), high[3] = float[3](wy[0], middle.y, wy[3]);
  vec3 sum = vec3(0.0);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      sum += wide[column] * high[row] * textureLod(composed, vec2(x[column], y[row]), 0.0).rgb;
  return sum;
}
#else
vec3 surfaceValue(vec2 uv) { return texture(composed, uv, -log2(finest)).rgb; }
#endif

// What the surface shows at texture coordinates.
vec3 surfaceColour(vec2 uv) {
  return clamp(surfaceValue(uv) * exposureScale + exposureBias, 0.0, 1.0);
}
