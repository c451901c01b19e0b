// What coding.test.mjs tests, as one module for Node.

export { CODECS } from "../../eigenfield-three/src/codecs.js";
export { KNOWN_NEEDS } from "../../eigenfield-three/src/document.js";
