// What was loaded as a scene of the page: with its ways to move, and where its captured views are.

import { Vector2, Vector3 } from "three";
import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import type { Loaded } from "eigenfield-three";
import { createOrbitMode, type Surroundings } from "./orbit-mode";
import { createPlaneMode } from "./plane-mode";
import type { Scene } from "./session";
import type { Source } from "./source";
import { extentOf, surroundingsOf } from "./surroundings";

/** Of what is on the stage already, whose canvas has this aspect. lacks: why it has no eigen textures, if it has none. */
export function sceneOf(source: Source, { gltf, field }: Loaded, lacks: string | null, aspect: number): Scene {
  gltf.scene.updateWorldMatrix(true, true);
  const around = field ? surroundingsOf(field) : plainSurroundings(gltf);
  return {
    source, gltf, field, around, lacks,
    plane: field?.info.facesPlane ? createPlaneMode(field, aspect) : null,
    orbit: createOrbitMode(field?.mesh ?? gltf.scene, around),
  };
}

function plainSurroundings(gltf: GLTF): Surroundings {
  const { centre, radius } = extentOf(gltf.scene);
  const tangents = new Vector2(0.4, 0.4);
  return { up: new Vector3(0, 1, 0), centre, radius, tangents, focus: null, framed: false, beyond: () => 0 };
}
