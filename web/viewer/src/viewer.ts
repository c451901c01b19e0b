// One scene on the stage, and everything that can be done with it. The panel, the keys, the address and the embedding
// page all act through this; each of its parts is in a file of its own.

import type { Frame } from "eigenfield-three";
import { createBeside } from "./beside";
import { type CameraOrder } from "./camera-order";
import { createCaptured } from "./captured";
import type { Config } from "./config";
import { createFrames, type Frames } from "./frames";
import { words } from "./language";
import type { Mover } from "./loop";
import { clamp, type Mode } from "./mode";
import { createMovement } from "./movement";
import { createOpening } from "./opening";
import type { Options } from "./options";
import { createPhotographs } from "./photographs";
import { createPainter } from "./painter";
import { createPlayback, type Playback } from "./playback";
import { createPlaces } from "./places";
import {
  emptySession, type Message, type ModeName, type Progress, type Scene, type Session, type Status,
} from "./session";
import type { Source } from "./source";
import { createStage, type Stage } from "./stage";
import { createSway } from "./sway";
import { createWireframe } from "./wireframe";

export interface Viewer extends Omit<Frames, "changed" | "told" | "touch" | "rested">, Playback {
  readonly stage: Stage;
  readonly config: Config;
  scene(): Scene | null;
  /** What is beside it, right of the divider. */
  beside(): Session["beside"];
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
  /** The photograph or the second scene beside the drawing, with a divider between them; or no divider. */
  divide(): void;
  /** Nobody has moved or set anything yet, and the page shows its own first view. */
  untouched(): boolean;
  /** A hand lies on the picture: it no longer moves by itself. */
  hold(): void;
  /** The mode that is moved now; looking through a captured camera ends with it. */
  moving(): Mode | null;
  frame(): Frame;
  open(source: Source): Promise<void>;
  openBeside(source: Source): Promise<void>;
  /** Everything is loaded, drawn in full, and still. */
  settled(): Promise<void>;
}

/** pushed: what keys and sticks do in one frame; true while they do. */
export function createViewer(canvas: HTMLCanvasElement, config: Config, pushed: (seconds: number) => boolean): Viewer {
  const session = emptySession();
  const { options } = session;
  const stage = createStage(canvas);
  const movers: Mover[] = [{ step: pushed }];
  const plays = (): boolean => {
    const players = [session.scene, session.beside?.scene].map((scene) => scene?.field?.player);
    return players.some((player) => player?.playing || player?.waiting);
  };
  const frames = createFrames(session, stage, movers, plays, (detail) => painter.draw(detail));
  const { changed } = frames;

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
  const coarse = (): boolean => frames.detail().scale < 1;
  const sway = createSway(session, config.ownView, places.mode, movement.home, coarse);
  const glide = (seconds: number): boolean => session.captured === null && places.mode()?.step(seconds) === true;
  movers.push(sway, { step: glide });
  /** The same, and nothing moves by itself any more. */
  const moves = <Given extends unknown[], Made>(act: (...given: Given) => Made): ((...given: Given) => Made) => {
    return (...given) => {
      sway.end();
      return act(...given);
    };
  };
  const beside = createBeside(session, stage, config, { ...frames, say });
  const painter = createPainter(session, stage, places, captured, beside);

  const edges = createWireframe();
  const showEdges = (): void => {
    const { scene } = session;
    edges(options.wireframe && scene ? (scene.field?.mesh ?? scene.gltf.scene) : null);
  };
  const clips = createPlayback(session, frames.touch, frames.told);
  const opening = createOpening(session, stage, config, {
    changed,
    opened: () => {
      if (session.scene?.source.own !== true) beside.close();
      movement.home();
      showEdges();
      clips.opened();
    },
    closing: () => {
      edges(null);
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
    if (wish.wireframe !== undefined) showEdges();
    if (wish.divider != null) {
      options.divider = clamp(wish.divider, 0, 1);
      if (!session.beside) captured.showPhotograph(true);
    }
    if (options.view === "error") captured.findError();
    changed();
  };
  const settled = async (): Promise<void> => {
    await opening.done();
    await beside.done();
    sway.settle();
    await clips.stopped();
    await beside.stopped();
    await frames.rested(photographs.pending);
  };

  return {
    ...frames,
    stage,
    config,
    set: moves(set),
    say,
    settled,
    scene: () => session.scene,
    beside: () => session.beside,
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
      frames.touch();
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
    divide: moves(() => {
      const divided = (session.beside !== null || session.photographShown) && options.divider !== null;
      set({ divider: divided ? null : 0.5 });
    }),
    untouched: sway.untouched,
    hold: sway.stop,
    player: clips.player,
    playOrPause: moves(clips.playOrPause),
    toFrame: moves(clips.toFrame),
    scrub: moves(clips.scrub),
    letGo: clips.letGo,
    skip: moves(clips.skip),
    step: moves(clips.step),
    changeSpeed: clips.changeSpeed,
    setLoop: clips.setLoop,
    mute: clips.mute,
    moving: moves(() => {
      frames.touch();
      return movement.moving();
    }),
    frame: painter.frame,
    open: opening.open,
    openBeside: beside.open,
    suspend: () => {
      sway.end();
      captured.leave();
      frames.suspend();
    },
  };
}
