// Weights of the texels -1, 0, 1 and 2 for a place between texels 0 and 1: Catmull-Rom, a = -1/2.
vec4 catmullRom(float f) {
  float f2 = f * f, f3 = f2 * f;
  return 0.5 * vec4(2.0 * f2 - f3 - f, 3.0 * f3 - 5.0 * f2 + 2.0, 4.0 * f2 - 3.0 * f3 + f, f3 - f2);
}

// A texture's finest level at `texel`, whole at texel centres, taps clamped to the border. Sixteen texels are read one
// by one: nine bilinear reads between them take longer where no hardware filters, and hardware keeps 8 bits of a weight.
vec4 readCubic(sampler2D source, vec2 texel) {
  ivec2 last = textureSize(source, 0) - 1;
  ivec2 base = ivec2(floor(texel));
  vec2 f = texel - vec2(base);
  vec4 across = catmullRom(f.x), down = catmullRom(f.y);
  vec4 sum = vec4(0.0);
  for (int row = 0; row < 4; row++) {
    vec4 line = vec4(0.0);
    for (int column = 0; column < 4; column++) {
      ivec2 at = clamp(base + ivec2(column, row) - 1, ivec2(0), last);
      line += across[column] * texelFetch(source, at, 0);
    }
    sum += down[row] * line;
  }
  return sum;
}
