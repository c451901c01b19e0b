// One scene on the stage, and everything that can be done with it. The panel, the keys, the address and the embedding
// page all act through this; each of its parts is in a file of its own.

import type { Frame } from "eigenfield-three";
import { type CameraOrder } from "./camera-order";
import { createCaptured } from "./captured";
import type { Config } from "./config";
import { words } from "./language";
import { createLoop } from "./loop";
import { clamp, type Mode } from "./mode";
import { createMovement } from "./movement";
import { createOpening } from "./opening";
import type { Options } from "./options";
import { createPace, type Detail, FULL } from "./pace";
import { createPhotographs } from "./photographs";
import { createPainter } from "./painter";
import { createPlaces } from "./places";
import { emptySession, type Message, type ModeName, type Progress, type Scene, type Status } from "./session";
import type { Source } from "./source";
import { createStage, type Stage } from "./stage";
import { createSway } from "./sway";
import { createWireframe } from "./wireframe";

export interface Viewer {
  readonly stage: Stage;
  readonly config: Config;
  scene(): Scene | null;
  status(): Status;
  message(): Message | null;
  say(text: string): void;
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
  nearestCamera(): void;
  /** Name of the captured camera that is looked through, else of the nearest. */
  nearestName(): string | null;
  cameraOrder(): CameraOrder;
  /** X, Y of the eye: on the view plane, or dropped onto it. */
  coordinates(): { x: number; y: number };
  goTo(x: number, y: number): void;
  home(): void;
  /** From outside the captured views to the nearest place inside. */
  comeBack(): void;
  outside(): boolean;
  /** Whether the picture fades outside the captured views, into a blurred one. */
  setFading(on: boolean): void;
  hasPhotograph(): boolean;
  photographShown(): boolean;
  showPhotograph(shown: boolean): void;
  /** The photograph beside the drawing, with a divider between them; or no divider. */
  divide(): void;
  /** Nobody has moved or set anything yet, and the page shows its own first view. */
  untouched(): boolean;
  /** A hand lies on the picture: it no longer moves by itself. */
  hold(): void;
  /** The mode that is moved now; looking through a captured camera ends with it. */
  moving(): Mode | null;
  frame(): Frame;
  /** How the last frame was drawn: not in full while movement is too much for the machine. */
  detail(): Detail;
  request(): void;
  frames(): number;
  rate(): number | null;
  open(source: Source): Promise<void>;
  /** Everything is loaded, drawn in full, and still. */
  settled(): Promise<void>;
  /** Draws now and in full, for those who read the canvas. */
  drawNow(): void;
  /** A headset takes over, and hands back. */
  suspend(): void;
  resume(): void;
  onChange(listener: () => void): void;
  onDraw(listener: () => void): void;
}

/** pushed: what keys and sticks do in one frame; true while they do. */
export function createViewer(canvas: HTMLCanvasElement, config: Config, pushed: (seconds: number) => boolean): Viewer {
  const session = emptySession();
  const { options } = session;
  const stage = createStage(canvas);
  const changeListeners: (() => void)[] = [];
  const drawListeners: (() => void)[] = [];
  const restWaiters: (() => void)[] = [];
  let wireframe: { dispose(): void } | null = null;
  let changePending = false;
  let suspended = false;
  let detail = FULL;

  const changed = (): void => {
    loop.request();
    if (changePending) return;
    changePending = true;
    queueMicrotask(() => {
      changePending = false;
      for (const listener of changeListeners) listener();
    });
  };
  const draw = (next: Detail): void => {
    detail = next;
    painter.draw(detail);
    for (const listener of drawListeners) listener();
  };
  const loop = createLoop(
    (seconds) => {
      const active = pushed(seconds);
      const swayed = sway.step(seconds);
      const moved = session.captured === null && places.mode()?.step(seconds) === true;
      return active || swayed || moved;
    },
    ({ now, moves, follows }) => draw(pace.frame(now, moves, follows)),
    () => {
      for (const done of restWaiters.splice(0)) done();
      for (const listener of drawListeners) listener();
    },
  );
  const pace = createPace(loop.request, () => options.filter, stage.ratio);
  const say = (text: string): void => {
    session.message = { text, code: null, detail: null };
    changed();
  };
  const photographs = createPhotographs(config.photographs, changed, (name) => {
    session.photographShown = false;
    say(words("photographLost", { name }));
  });
  const places = createPlaces(session, stage);
  const captured = createCaptured(session, places, photographs, changed);
  const movement = createMovement(session, stage, places, captured, config.start, changed);
  const coarse = (): boolean => detail.scale < 1;
  const sway = createSway(session, config.ownView, places.mode, movement.home, coarse);
  /** The same, and nothing moves by itself any more. */
  const moves = <Given extends unknown[], Made>(act: (...given: Given) => Made): ((...given: Given) => Made) => {
    return (...given) => {
      sway.end();
      return act(...given);
    };
  };
  const painter = createPainter(session, stage, places, captured);

  const removeWireframe = (): void => {
    wireframe?.dispose();
    wireframe = null;
  };
  const applyWireframe = (): void => {
    removeWireframe();
    const { scene } = session;
    if (options.wireframe && scene) wireframe = createWireframe(scene.field?.mesh ?? scene.gltf.scene);
  };
  const opening = createOpening(session, stage, config, {
    changed,
    opened: () => {
      movement.home();
      applyWireframe();
    },
    closing: () => {
      removeWireframe();
      photographs.forget();
    },
  });
  stage.setBackground(options.background);

  const set = (wish: Partial<Options>): void => {
    Object.assign(options, wish);
    const field = session.scene?.field;
    if (field) {
      options.eigen = Math.min(Math.max(Math.round(options.eigen), 0), Math.max(field.total - 1, 0));
      if (options.count >= field.total) options.count = Infinity;
      options.count = Math.max(Math.round(options.count), 0);
    }
    if (wish.background !== undefined) stage.setBackground(options.background);
    if (wish.wireframe !== undefined) applyWireframe();
    if (wish.divider != null) {
      options.divider = clamp(wish.divider, 0, 1);
      captured.showPhotograph(true);
    }
    if (options.view === "error") captured.findError();
    changed();
  };
  const settled = async (): Promise<void> => {
    await opening.done();
    sway.settle();
    do await new Promise<void>((done) => void (restWaiters.push(done), loop.request()));
    while (photographs.pending() || !loop.idle() || pace.waiting());
  };

  return {
    stage,
    config,
    set: moves(set),
    say,
    settled,
    scene: () => session.scene,
    status: () => session.status,
    message: () => session.message,
    dismiss: () => {
      session.message = null;
      changed();
    },
    arriving: () => session.arriving,
    summed: () => {
      const field = session.scene?.field;
      return field ? Math.min(options.count, field.total, field.usable, field.loaded) : 0;
    },
    progress: () => session.progress,
    options: () => options,
    modeName: () => session.mode,
    setMode: moves(movement.setMode),
    captured: () => session.captured,
    toCamera: moves(captured.to),
    nextCamera: moves(captured.next),
    nearestCamera: moves(captured.nearest),
    nearestName: captured.nearestName,
    cameraOrder: captured.order,
    coordinates: places.coordinates,
    goTo: moves((x, y) => {
      movement.goTo(x, y);
      loop.touch();
    }),
    home: moves(movement.home),
    comeBack: moves(movement.comeBack),
    outside: () => places.beyond() > 0,
    setFading: (on) => {
      session.fades = on;
      changed();
    },
    hasPhotograph: captured.hasPhotograph,
    photographShown: () => session.photographShown,
    showPhotograph: moves(captured.showPhotograph),
    divide: moves(() => set({ divider: session.photographShown && options.divider !== null ? null : 0.5 })),
    untouched: sway.untouched,
    hold: sway.stop,
    moving: moves(() => {
      loop.touch();
      return movement.moving();
    }),
    frame: painter.frame,
    detail: () => detail,
    request: loop.request,
    frames: loop.frames,
    rate: loop.rate,
    open: opening.open,
    drawNow: () => {
      if (!suspended) draw(FULL);
    },
    suspend: () => {
      suspended = true;
      sway.end();
      captured.leave();
      stage.setScale(FULL.scale);
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
