// What a file may announce: docs/format.md, "Limits". Checked before anything is allocated.

export const EXTENSION = "EIGENFIELD_eigen_textures";

export const MAX_JSON = 64 * 2 ** 20; // bytes
export const MAX_DEPTH = 64;
export const MAX_CHUNKS = 64;
export const MAX_VIEWS = 16_384;
export const MAX_SIDE = 16_384;
export const MAX_STACKED = 32_768; // rows of a picture of stacked channels or textures
export const MAX_PRECISION_SIDE = 1_024;
export const MAX_TEXELS = 2 ** 27;
export const MAX_CHANNELS = 64;
export const MAX_PLANES = 16;
export const MAX_BASES = 64;
export const MAX_COMPONENTS = 4_096;
export const MAX_DECODED = 8 * 2 ** 30; // bytes: 4 for each number of a mean, 1 for those of textures, 2 of 10 bits
export const MAX_CAMERAS = 100_000;
export const MAX_CAMERA_SIDE = 65_535;
export const MAX_CAMERA_PIXELS = 2 ** 29;
export const MAX_NAME = 1_024;
export const MAX_NAMES = 2 ** 25; // bytes of coded names, inflated
export const MAX_VERTICES = 2 ** 26;
export const MAX_TRIANGLES = 2 ** 27;
export const MAX_SHEETS = 32;
export const MAX_WEIGHTS = 2 ** 28;
export const MAX_GAIN = 1_000;
export const MAX_OFFSET = 1_000;
export const MAX_NUMBER = 1e30;
export const ORTHONORMAL = 2e-4;
