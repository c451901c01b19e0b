// What the page holds at the moment: plain data that the parts of the viewer share and set.

import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import type { EigenField } from "eigenfield-three";
import { DEFAULTS, type Options } from "./options";
import type { OrbitMode, Surroundings } from "./orbit-mode";
import type { PlaneMode } from "./plane-mode";
import type { Source } from "./source";

export type ModeName = "plane" | "orbit";
export type Status = "empty" | "loading" | "ready" | "failed" | "lost";

export interface Scene {
  source: Source;
  gltf: GLTF;
  field: EigenField | null; // null: a plain glTF file, or a clip that this browser cannot decode
  lacks: string | null; // why it is none
  plane: PlaneMode | null; // null: its cameras do not face a plane
  orbit: OrbitMode;
  around: Surroundings;
}

export interface Progress {
  loaded: number;
  total: number | null;
}

export interface Message {
  text: string;
  code: string | null;
  detail: string | null; // what the plug-in said, where the text is a translation
}

export interface Session {
  scene: Scene | null;
  beside: { source: Source; scene: Scene | null } | null; // a second scene, right of the divider; null: it is on its way
  status: Status;
  message: Message | null;
  progress: Progress;
  arriving: boolean; // eigen textures are still to come
  mode: ModeName;
  captured: number | null; // the camera that is looked through
  photographShown: boolean;
  fades: boolean; // outside the captured views the picture is blurred, for guests; else it is what the file gives
  readonly options: Options;
}

export function emptySession(): Session {
  return {
    scene: null,
    beside: null,
    status: "empty",
    message: null,
    progress: { loaded: 0, total: null },
    arriving: false,
    mode: "plane",
    captured: null,
    photographShown: false,
    fades: false,
    options: { ...DEFAULTS },
  };
}
