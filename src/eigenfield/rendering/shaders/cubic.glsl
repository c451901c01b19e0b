// Weights of the texels -1, 0, 1 and 2 for a place between texels 0 and 1: Catmull-Rom, a = -1/2.
vec4 catmullRom(float f) {
  float f2 = f * f, f3 = f2 * f;
  return 0.5 * vec4(2.0 * f2 - f3 - f, 3.0 * f3 - 5.0 * f2 + 2.0, 4.0 * f2 - 3.0 * f3 + f, f3 - f2);
}
