// Eigen textures in three.js. In any app that uses GLTFLoader:
//
//   loader.register((parser) => new EigenfieldPlugin(parser));
//   const gltf = await loader.loadAsync("scene.glb");
//   scene.add(gltf.scene); // draws itself; gltf.userData.eigenfield is its EigenField

export { refuseAddresses } from "./addresses.js";
export { novelCamera, placeCamera, type Frame } from "./cameras.js";
export { SceneError, type SceneErrorCode } from "./errors.js";
export { EigenField, type FieldEvents } from "./field.js";
export type { CaptureCamera, Matrix3rows, SceneInfo, Vector, ViewPlane } from "./info.js";
export type { Json, JsonObject } from "./json.js";
export { loadEigenfield, type Loaded, type LoadOptions } from "./load.js";
export type { Filter } from "./material.js";
export { defaultMemory, type Reduction } from "./memory.js";
export type { ByteStream, EigenfieldOptions } from "./options.js";
export { Player, type Fallback, type PlayerEvents } from "./player.js";
export { EigenfieldPlugin } from "./plugin.js";
export type { Sound } from "./sound.js";
export { SHEETS } from "./sheet-stack.js";
export type { Mixing } from "./weights.js";
