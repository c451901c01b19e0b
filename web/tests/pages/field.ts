// What field.test.mjs tests, as one module for Node.

export { BufferAttribute, BufferGeometry, Mesh, PerspectiveCamera } from "three";
export { EigenField } from "../../eigenfield-three/src/field.js";
export { makePlan } from "../../eigenfield-three/src/memory.js";
export { stillTextures } from "../../eigenfield-three/src/still-textures.js";
export { ViewWeights } from "../../eigenfield-three/src/weights.js";
