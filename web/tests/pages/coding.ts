// What coding.test.mjs tests, as one module for Node.

export { decodeCameras } from "../../eigenfield-three/src/camera-decoder.js";
export { decodeMesh } from "../../eigenfield-three/src/mesh-decoder.js";
export { decodeNames } from "../../eigenfield-three/src/name-decoder.js";
export { decodeTriangles } from "../../eigenfield-three/src/triangle-decoder.js";
export { decodeWeights } from "../../eigenfield-three/src/weight-decoder.js";
