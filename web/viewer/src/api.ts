// `window.eigenfield`: what an embedding page, and our tests, may do with the viewer.
//
//   field                the EigenField of eigenfield-three, or null: nothing loaded, or a plain glTF file
//   state()              a copy of everything that is shown now
//   goTo(x, y)           the eye to view-plane coordinates, -1..1
//   goToCamera(name)     through a captured camera; false if there is none of that name
//   set({...})           any of State's options: view, eigen (from 0), count, weights, mixing, filter, wireframe,
//                        background; also mode ("plane", "orbit") and photograph (boolean)
//   open(file)           another scene: a Blob or a URL (of its own server alone in what `export` writes: confine.ts)
//   settled()            when everything is loaded, drawn in full, and still
//   pixels()             the picture now, in full: width, height, and RGBA rows from the top
//   eyes()               where the eye is, or in a headset both are: x, y, z in the capture's world

import { Vector3 } from "three";
import type { EigenField, Frame } from "eigenfield-three";
import { words } from "./language";
import type { Options } from "./options";
import type { Detail } from "./pace";
import { bytesWith, uvSsim } from "./scores";
import type { Message, ModeName, Status } from "./session";
import type { Viewer } from "./viewer";

export interface State extends Options {
  status: Status;
  message: Message | null;
  title: string | null;
  mode: ModeName;
  camera: string | null;
  photograph: boolean;
  x: number;
  y: number;
  zoom: number;
  dolly: number;
  outside: boolean;
  frame: Frame; // where the captured picture lies in the canvas
  detail: Detail; // how the last frame was drawn: coarser while movement is too much for the machine
  frames: number; // drawn since the page opened
  loaded: number; // eigen textures on the GPU
  total: number; // in the file
  bytes: number | null; // of the file with as many eigen textures as are summed now
  uvSsim: number | null;
  time: number | null; // of the frame of a clip, in seconds; null: it is none
  playing: boolean;
}

export interface Embedded {
  readonly field: EigenField | null;
  state(): State;
  goTo(x: number, y: number): void;
  goToCamera(name: string): boolean;
  set(options: Partial<Options> & { mode?: ModeName; photograph?: boolean }): void;
  open(from: string | Blob, name?: string): Promise<void>;
  settled(): Promise<void>;
  pixels(): { width: number; height: number; data: Uint8Array };
  eyes(): [number, number, number][];
}

declare global {
  interface Window {
    eigenfield?: Embedded;
  }
}

export function createApi(viewer: Viewer): Embedded {
  return {
    get field() {
      return viewer.scene()?.field ?? null;
    },
    state: () => {
      const scene = viewer.scene();
      const field = scene?.field;
      const captured = viewer.captured();
      const total = field?.total ?? 0;
      const count = Math.min(viewer.options().count, total);
      return {
        ...viewer.options(),
        count,
        status: viewer.status(),
        message: viewer.message(),
        title: scene?.source.name ?? null,
        mode: viewer.modeName(),
        camera: captured === null ? null : (field?.info.names[captured] ?? null),
        photograph: viewer.photographShown(),
        ...viewer.coordinates(),
        zoom: scene?.plane?.at().zoom ?? 1,
        dolly: scene?.plane?.at().dolly ?? 0,
        outside: viewer.outside(),
        frame: viewer.frame(),
        detail: viewer.detail(),
        frames: viewer.drawn(),
        loaded: field?.loaded ?? 0,
        total,
        bytes: field ? bytesWith(field.info, viewer.summed()) : null,
        uvSsim: field ? uvSsim(field.info, viewer.summed()) : null,
        time: field?.player?.time ?? null,
        playing: field?.player?.playing ?? false,
      };
    },
    goTo: viewer.goTo,
    goToCamera: (name) => {
      const index = viewer.scene()?.field?.info.names.indexOf(name) ?? -1;
      if (index < 0) return false;
      viewer.toCamera(index);
      return true;
    },
    set: ({ mode, photograph, ...options }) => {
      if (mode !== undefined) viewer.setMode(mode);
      viewer.set(options);
      if (photograph !== undefined) viewer.showPhotograph(photograph);
    },
    open: (from, name = words("scene")) =>
      viewer.open({ name, from, bytes: typeof from === "string" ? null : from.size, own: false }),
    settled: viewer.settled,
    pixels: () => {
      viewer.drawNow();
      return viewer.stage.pixels();
    },
    eyes: () => {
      const mesh = viewer.scene()?.field?.mesh;
      const { renderer, camera } = viewer.stage;
      const cameras = renderer.xr.isPresenting ? renderer.xr.getCamera().cameras : [camera];
      if (!mesh) return [];
      return cameras.map((one) => mesh.worldToLocal(new Vector3().setFromMatrixPosition(one.matrixWorld)).toArray());
    },
  };
}
