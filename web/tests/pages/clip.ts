// What clip.test.mjs tests, as one module for Node.

export { readDocument } from "../../eigenfield-three/src/document.js";
export { codesOf, partsOf } from "../../eigenfield-three/src/film-codes.js";
export { FrameRing } from "../../eigenfield-three/src/frame-ring.js";
export { Groups } from "../../eigenfield-three/src/groups.js";
export { unpacked } from "../../eigenfield-three/src/packed.js";
export { Player } from "../../eigenfield-three/src/player.js";
export { frameAt, groupOf, timeOf } from "../../eigenfield-three/src/timeline.js";
