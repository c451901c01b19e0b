// One scene on the stage, and everything that can be done with it. The panel, the keys, the address and the embedding
// page all act through this.

import { type PerspectiveCamera, Vector2, Vector3 } from "three";
import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { type EigenField, loadEigenfield, placeCamera, SceneError } from "eigenfield-three";
import type { Config } from "./config";
import { add, dot, scaled } from "./geometry";
import { createLoop } from "./loop";
import type { Frame, Mode } from "./mode";
import { DEFAULTS, type Options } from "./options";
import { createOrbitMode, type OrbitMode, type Surroundings } from "./orbit-mode";
import { createPhotographs, type Photographs } from "./photographs";
import { createPlaneMode, type PlaneMode } from "./plane-mode";
import type { Source } from "./source";
import { createStage, type Stage } from "./stage";
import { extentOf, surroundingsOf } from "./surroundings";
import { createWireframe } from "./wireframe";

export type ModeName = "plane" | "orbit";
export type Status = "empty" | "loading" | "ready" | "failed" | "lost";

export interface Scene {
  source: Source;
  gltf: GLTF;
  field: EigenField | null; // null: a plain glTF file
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
}

export interface Viewer {
  readonly stage: Stage;
  readonly config: Config;
  scene(): Scene | null;
  status(): Status;
  message(): Message | null;
  dismiss(): void;
  /** Eigen textures are still to come. */
  arriving(): boolean;
  /** How many are summed now: as many as are wanted, and here. */
  summed(): number;
  progress(): Progress;
  options(): Readonly<Options>;
  set(options: Partial<Options>): void;
  modeName(): ModeName;
  setMode(mode: ModeName): void;
  /** Index of the captured camera that is looked through, or null. */
  captured(): number | null;
  toCamera(index: number): void;
  nextCamera(step: number): void;
  /** X, Y of the eye: on the view plane, or dropped onto it. */
  coordinates(): { x: number; y: number };
  goTo(x: number, y: number): void;
  home(): void;
  /** From outside the captured views to the nearest place inside. */
  comeBack(): void;
  outside(): boolean;
  hasPhotograph(): boolean;
  photographShown(): boolean;
  showPhotograph(shown: boolean): void;
  /** The mode that is moved now; looking through a captured camera ends with it. */
  moving(): Mode | null;
  frame(): Frame;
  request(): void;
  frames(): number;
  rate(): number | null;
  open(source: Source): Promise<void>;
  settled(): Promise<void>;
  /** Draws now, for those who read the canvas. */
  drawNow(): void;
  /** A headset takes over, and hands back. */
  suspend(): void;
  resume(): void;
  onChange(listener: () => void): void;
  onDraw(listener: () => void): void;
}

const WHOLE: Frame = { left: 0, top: 0, width: 1, height: 1 };

/** pushed: what keys and sticks do in one frame; true while they do. */
export function createViewer(canvas: HTMLCanvasElement, config: Config, pushed: (seconds: number) => boolean): Viewer {
  const stage = createStage(canvas);
  const options: Options = { ...DEFAULTS };
  const changeListeners: (() => void)[] = [];
  const drawListeners: (() => void)[] = [];
  const restWaiters: (() => void)[] = [];
  let scene: Scene | null = null;
  let status: Status = "empty";
  let message: Message | null = null;
  let progress: Progress = { loaded: 0, total: null };
  let mode: ModeName = "plane";
  let captured: number | null = null;
  let photographShown = false;
  let frame = WHOLE;
  let wireframe: { dispose(): void } | null = null;
  let opening: AbortController | null = null;
  let opened: Promise<void> = Promise.resolve();
  let changePending = false;
  let suspended = false;
  let arriving = false;

  const changed = (): void => {
    loop.request();
    if (changePending) return;
    changePending = true;
    queueMicrotask(() => {
      changePending = false;
      for (const listener of changeListeners) listener();
    });
  };
  const loop = createLoop(
    (seconds) => {
      const active = pushed(seconds);
      const moved = captured === null && scene !== null && current(scene).step(seconds);
      return active || moved;
    },
    () => draw(),
    () => {
      for (const done of restWaiters.splice(0)) done();
      for (const listener of drawListeners) listener();
    },
  );
  const photographs: Photographs = createPhotographs(config.photographs, changed, (name) => {
    const text = `The photograph of ${name} could not be loaded: is \`eigenfield view\` still running?`;
    message = { text, code: null };
    photographShown = false;
    changed();
  });

  const current = (of: Scene): Mode => (mode === "plane" && of.plane ? of.plane : of.orbit);
  const nameOf = (index: number | null): string | null =>
    index === null ? null : (scene?.field?.info.names[index] ?? null);
  const hasPhotograph = (index = captured ?? nearestCamera()): boolean => {
    const name = nameOf(index);
    return name !== null && scene?.source.own === true && photographs.has(name);
  };

  const draw = (): void => {
    const { camera } = stage;
    const aspect = stage.aspect();
    let over = null;
    frame = WHOLE;
    if (scene) {
      const { field } = scene;
      const view = captured === null ? undefined : field?.info.cameras[captured];
      frame = field && view ? placeCamera(field, camera, view, aspect) : current(scene).place(camera, aspect);
      const name = nameOf(captured);
      const wanted = name !== null && hasPhotograph() && (photographShown || options.view === "error");
      const picture = wanted ? photographs.get(name) : null;
      if (photographShown) over = picture;
      if (field) {
        field.camera = captured;
        field.exposure = captured;
        field.count = options.count;
        field.eigen = options.eigen;
        field.mixing = options.mixing;
        field.filter = options.filter;
        field.photograph = picture;
        field.view = options.view === "error" && !picture ? "picture" : options.view;
        // On the plane both ways mean the same; one set of weights needs no map and is the paper's to the last digit.
        const onPlane = mode === "plane" && scene.plane?.at().dolly === 0;
        field.weightMode = onPlane || !field.info.facesPlane ? "eye" : options.weights;
      }
    }
    // Beside the frame the surface was seen by few cameras, and ends raggedly.
    stage.draw(frame === WHOLE ? null : frame, over);
    for (const listener of drawListeners) listener();
  };

  const eye = (): Vector3 | null => {
    const field = scene?.field;
    return field ? field.mesh.worldToLocal(new Vector3().setFromMatrixPosition(stage.camera.matrixWorld)) : null;
  };
  const dropped = (x: number, y: number, z: number): { x: number; y: number } => {
    const plane = scene?.field?.info.viewPlane;
    if (!plane) return { x: 0, y: 0 };
    const offset = add([x, y, z], scaled(plane.origin, -1));
    const [width, height] = plane.extent;
    return {
      x: width > 0 ? dot(offset, plane.right) / width : 0,
      y: height > 0 ? dot(offset, plane.up) / height : 0,
    };
  };
  const coordinates = (): { x: number; y: number } => {
    const at = eye();
    if (captured === null && mode === "plane" && scene?.plane) {
      const { x, y } = scene.plane.at();
      return { x, y };
    }
    return at ? dropped(at.x, at.y, at.z) : { x: 0, y: 0 };
  };
  const nearestCamera = (): number | null => {
    const at = eye();
    const cameras = scene?.field?.info.cameras ?? [];
    if (!at) return null;
    const away = cameras.map(({ centre }) => at.distanceToSquared(new Vector3(...centre)));
    return away.length === 0 ? null : away.indexOf(Math.min(...away));
  };

  /** What is shown of a captured camera ends when the eye leaves it. */
  const leaveCamera = (): void => {
    photographShown = false;
    captured = null;
    if (options.view === "error") options.view = "picture";
  };
  const placeAtCamera = (of: Scene, index: number): PerspectiveCamera => {
    const view = of.field?.info.cameras[index];
    if (of.field && view) placeCamera(of.field, stage.camera, view, stage.aspect());
    return stage.camera;
  };
  const toCamera = (index: number): void => {
    const view = scene?.field?.info.cameras[index];
    if (!scene || !view) return;
    captured = index;
    const { x, y } = dropped(...view.centre);
    scene.plane?.goTo(x, y, true);
    scene.plane?.setDolly(0);
    scene.plane?.setZoom(1);
    scene.plane?.step(10);
    if (!hasPhotograph()) {
      photographShown = false;
      if (options.view === "error") options.view = "picture";
    }
    changed();
  };
  const moving = (): Mode | null => {
    if (!scene) return null;
    if (captured !== null) {
      const index = captured;
      leaveCamera();
      if (current(scene) === scene.orbit) scene.orbit.enter(placeAtCamera(scene, index), new Vector2());
      changed();
    }
    loop.request();
    return current(scene);
  };
  const home = (): void => {
    if (!scene) return;
    leaveCamera();
    const { field, plane, orbit, around } = scene;
    if (!field) {
      const away = new Vector3(0.35, 0.25, 1).setLength(around.radius / Math.sin(Math.atan(around.tangents.y)));
      orbit.set(around.centre.clone().add(away), around.centre);
    } else if (plane) {
      mode = "plane";
      const { x, y } = dropped(...(field.info.cameras[field.info.reference]?.centre ?? field.info.viewPlane.origin));
      plane.goTo(x, y);
      plane.setDolly(0);
      plane.setZoom(1);
    } else {
      orbit.enter(placeAtCamera(scene, field.info.reference), new Vector2());
    }
    changed();
  };
  const setMode = (next: ModeName): void => {
    if (!scene || (next === "plane" && !scene.plane)) return;
    if (next === mode && captured === null) return;
    const { x, y } = coordinates();
    if (next === "orbit") {
      if (captured !== null) placeAtCamera(scene, captured);
      scene.orbit.enter(stage.camera, new Vector2());
    } else if (mode === "orbit") {
      scene.plane?.goTo(x, y, true);
      scene.plane?.setDolly(0);
    }
    leaveCamera();
    mode = next;
    changed();
  };

  const open = async (source: Source): Promise<void> => {
    opening?.abort();
    const mine = (opening = new AbortController());
    const { signal } = mine;
    const stale = (): boolean => opening !== mine;
    status = "loading";
    arriving = false;
    message = null;
    progress = { loaded: 0, total: source.bytes };
    changed();
    try {
      const { gltf, field } = await loadEigenfield(source.from, {
        renderer: stage.renderer,
        signal,
        onBytes: (loaded, total) => {
          if (stale()) return;
          progress = { loaded, total: total ?? source.bytes };
          changed();
        },
      });
      if (stale()) {
        field?.dispose();
        return;
      }
      closeScene();
      stage.put(gltf.scene, field !== null);
      gltf.scene.updateWorldMatrix(true, true);
      const around = field ? surroundingsOf(field) : plainSurroundings(gltf);
      scene = {
        source, gltf, field, around,
        plane: field?.info.facesPlane ? createPlaneMode(field) : null,
        orbit: createOrbitMode(field?.mesh ?? gltf.scene, around),
      };
      if (field && config.metresPerUnit !== null && source.own) field.info.metresPerUnit = config.metresPerUnit;
      status = "ready";
      mode = scene.plane ? "plane" : "orbit";
      options.eigen = 0;
      options.count = Infinity;
      options.view = "picture";
      home();
      scene.plane?.step(10);
      applyWireframe();
      changed();
      if (!field) return;
      arriving = true;
      field.addEventListener("texture", changed);
      field.addEventListener("limited", changed);
      field.addEventListener("error", ({ error }) => {
        message = { text: error.message, code: error.code };
        changed();
      });
      await field.complete.catch(() => undefined); // the event has told
      if (stale()) return;
      arriving = false;
      changed();
    } catch (error) {
      if (stale()) return;
      message = described(error);
      status = "failed";
      closeScene();
      changed();
    }
  };
  const closeScene = (): void => {
    if (!scene) return;
    wireframe?.dispose();
    wireframe = null;
    scene.field?.dispose();
    stage.clear();
    photographs.forget();
    scene = null;
    captured = null;
    photographShown = false;
  };
  const applyWireframe = (): void => {
    wireframe?.dispose();
    wireframe = options.wireframe && scene ? createWireframe(scene.field?.mesh ?? scene.gltf.scene) : null;
  };

  canvas.addEventListener("webglcontextlost", () => {
    status = "lost";
    message = { text: "The graphics system took its memory back. Waiting until it can draw again …", code: null };
    changed();
  });
  canvas.addEventListener("webglcontextrestored", () => {
    message = null;
    status = scene ? "ready" : "empty";
    stage.setBackground(options.background); // which the new context does not know
    if (scene?.field) opened = ended(scene.field); // it brings its textures back itself
    changed();
  });
  stage.setBackground(options.background);

  return {
    stage,
    config,
    scene: () => scene,
    status: () => status,
    message: () => message,
    dismiss: () => {
      message = null;
      changed();
    },
    arriving: () => arriving,
    summed: () => {
      const field = scene?.field;
      return field ? Math.min(options.count, field.total, field.usable, field.loaded) : 0;
    },
    progress: () => progress,
    options: () => options,
    set: (wish) => {
      Object.assign(options, wish);
      const field = scene?.field;
      if (field) {
        options.eigen = Math.min(Math.max(Math.round(options.eigen), 0), Math.max(field.total - 1, 0));
        if (options.count >= field.total) options.count = Infinity;
        options.count = Math.max(Math.round(options.count), 0);
      }
      if (wish.background !== undefined) stage.setBackground(options.background);
      if (wish.wireframe !== undefined) applyWireframe();
      if (options.view === "error") {
        photographShown = false;
        if (captured === null) {
          const nearest = nearestCamera();
          if (nearest !== null && hasPhotograph(nearest)) toCamera(nearest);
        }
        if (!hasPhotograph()) options.view = "picture";
      }
      changed();
    },
    modeName: () => mode,
    setMode,
    captured: () => captured,
    toCamera,
    nextCamera: (step) => {
      const total = scene?.field?.info.cameras.length ?? 0;
      const from = captured ?? nearestCamera();
      if (total > 0 && from !== null) toCamera(captured === null ? from : (from + step + total) % total);
    },
    coordinates,
    goTo: (x, y) => {
      const field = scene?.field;
      if (!scene || !field) return;
      leaveCamera();
      if (scene.plane) {
        mode = "plane";
        scene.plane.goTo(x, y);
      } else {
        const away = field.info.cameras.map(({ centre }) => {
          const at = dropped(...centre);
          return Math.hypot(at.x - x, at.y - y);
        });
        toCamera(away.indexOf(Math.min(...away)));
      }
      changed();
    },
    home,
    comeBack: () => {
      if (scene?.plane) setMode("plane");
      else {
        const nearest = nearestCamera();
        if (scene?.field && nearest !== null) scene.orbit.enter(placeAtCamera(scene, nearest), new Vector2());
        changed();
      }
    },
    outside: () => status === "ready" && scene?.field != null && captured === null && current(scene).outside(),
    hasPhotograph: () => hasPhotograph(),
    photographShown: () => photographShown,
    showPhotograph: (shown) => {
      if (shown && captured === null) {
        const nearest = nearestCamera();
        if (nearest !== null) toCamera(nearest);
      }
      photographShown = shown && captured !== null && hasPhotograph();
      changed();
    },
    moving,
    frame: () => frame,
    request: loop.request,
    frames: loop.frames,
    rate: loop.rate,
    open: (source) => (opened = open(source)),
    settled: async () => {
      let before: unknown = null;
      while (before !== opened) {
        before = opened;
        await opened;
      }
      do await new Promise<void>((done) => void (restWaiters.push(done), loop.request()));
      while (photographs.pending() || !loop.idle());
    },
    drawNow: () => {
      if (!suspended) draw();
    },
    suspend: () => {
      suspended = true;
      leaveCamera();
      loop.pause();
      changed();
    },
    resume: () => {
      suspended = false;
      loop.resume();
      changed();
    },
    onChange: (listener) => void changeListeners.push(listener),
    onDraw: (listener) => void drawListeners.push(listener),
  };
}

/** The eigen textures are all here, or one of them never will be. */
function ended(field: EigenField): Promise<void> {
  return new Promise((resolve) => {
    field.addEventListener("complete", () => resolve());
    field.addEventListener("error", () => resolve());
  });
}

function plainSurroundings(gltf: GLTF): Surroundings {
  const { centre, radius } = extentOf(gltf.scene);
  return { up: new Vector3(0, 1, 0), centre, radius, tangents: new Vector2(0.4, 0.4), outside: () => false };
}

function described(error: unknown): Message {
  if (error instanceof SceneError) return { text: error.message, code: error.code };
  return { text: error instanceof Error ? error.message : String(error), code: null };
}
