// A second scene beside the first, seen by the same eye: right of the divider, where the first is left of it.
//
// Two scenes of one capture share its world, and so the camera. Of different captures, the eye has the same place on
// each array, or the same direction to each surface.

import { Matrix4, type PerspectiveCamera, Vector3 } from "three";
import { type Frame, loadEigenfield, type Player, type SceneInfo } from "eigenfield-three";
import type { Config } from "./config";
import { words } from "./language";
import { reducedMotion, WHOLE } from "./mode";
import { described } from "./opening";
import { sceneOf } from "./scene-of";
import type { Scene, Session } from "./session";
import type { Source } from "./source";
import type { Stage } from "./stage";

const APART = 0.02; // of the array's size, and of rotations' entries, up to which two cameras are the same
const SHARED = 0.5; // of the cameras of the scene that has fewer, from which on two scenes are of one capture
const OUT_OF_STEP = 0.3; // seconds by which a clip that plays may be ahead of the other

export interface SecondScene {
  open(source: Source): Promise<void>;
  close(): void;
  /** It is here, with all of its textures, or will not come. */
  done(): Promise<void>;
  /** Puts a camera where it sees the second scene as the stage's sees the first, whose picture lies in `frame`. */
  place(camera: PerspectiveCamera, frame: Frame): Frame;
  /** A clip shows the time of the first one. */
  keepStep(): void;
  /** It stands still there. */
  stopped(): Promise<void>;
}

export interface BesideEvents {
  changed(): void;
  /** A frame is to be drawn. */
  request(): void;
  /** The same, of something that moves. */
  touch(): void;
  /** A line for people. */
  say(text: string): void;
}

export function createBeside(session: Session, stage: Stage, config: Config, events: BesideEvents): SecondScene {
  const { changed, request, touch, say } = events;
  let opened: Promise<void> = Promise.resolve();
  let agreed: { first: Scene; same: boolean } | null = null;

  const shares = (first: Scene, second: Scene): boolean => {
    if (agreed?.first !== first) {
      const same = !!first.field && !!second.field && sameCameras(first.field.info, second.field.info);
      agreed = { first, same };
      if (!same) say(words("camerasDiffer"));
    }
    return agreed.same;
  };
  const open = async (source: Source): Promise<void> => {
    const mine = { source, scene: null as Scene | null };
    session.beside = mine;
    try {
      const loaded = await loadEigenfield(source.from, { renderer: stage.renderer, memory: config.memory ?? undefined });
      const { field } = loaded;
      if (session.beside !== mine) return field?.dispose();
      stage.setBeside(loaded.gltf.scene);
      mine.scene = sceneOf(source, loaded, null, stage.aspect());
      const player = field?.player;
      player?.addEventListener("frame", touch);
      if (player && !reducedMotion()) player.play();
      if (player?.sound) player.sound.muted = true;
      field?.addEventListener("texture", request);
      changed();
      await field?.complete;
    } catch (error) {
      if (session.beside === mine) say(words("cannotOpen", { name: source.name, reason: described(error, source).text }));
    }
  };
  const place = (camera: PerspectiveCamera, frame: Frame): Frame => {
    const [first, second] = [session.scene, session.beside?.scene];
    if (!first || !second) return WHOLE;
    if (first.field && second.field && shares(first, second)) {
      camera.copy(stage.camera, false);
      const moved = new Matrix4().copy(first.field.mesh.matrixWorld).invert().premultiply(second.field.mesh.matrixWorld);
      moved.multiply(stage.camera.matrixWorld).decompose(camera.position, camera.quaternion, new Vector3());
      camera.updateMatrixWorld(true);
      return frame;
    }
    if (session.mode === "plane" && first.plane && second.plane) {
      const { x, y, zoom, dolly } = first.plane.at();
      second.plane.goTo(x, y, true);
      second.plane.setZoom(zoom);
      second.plane.setDolly(dolly);
      second.plane.step(10);
      return second.plane.place(camera, stage.aspect());
    }
    const eye = new Vector3().setFromMatrixPosition(stage.camera.matrixWorld);
    const target = new Vector3(0, 0, -1).transformDirection(stage.camera.matrixWorld);
    target.multiplyScalar(eye.distanceTo(first.around.centre)).add(eye);
    const [from, to] = [first.around, second.around];
    const turn = frontOf(second).multiply(frontOf(first).transpose());
    for (const point of [eye, target]) {
      point.sub(from.centre).multiplyScalar(to.radius / from.radius).applyMatrix4(turn).add(to.centre);
    }
    second.orbit.set(eye, target);
    return second.orbit.place(camera, stage.aspect());
  };

  const players = (): (Player | null | undefined)[] => [session.scene?.field?.player, session.beside?.scene?.field?.player];
  const keepStep = (): void => {
    const [first, second] = players();
    if (first && second) follow(second, first);
  };

  return {
    open: (source) => (opened = open(source)),
    done: () => opened,
    place,
    close: () => {
      session.beside?.scene?.field?.dispose();
      session.beside = null;
      agreed = null;
      stage.setBeside(null);
    },
    keepStep,
    stopped: async () => {
      keepStep();
      const [, second] = players();
      if (second?.waiting) await second.toFrame(second.sought);
    },
  };
}

/** The axes of a scene's surface: upright, with z towards the camera of the first view. */
function frontOf({ field, around }: Scene): Matrix4 {
  const view = field?.info.cameras[field.info.reference];
  if (!field || !view) return new Matrix4();
  const towards = new Vector3(...view.centre).applyMatrix4(field.mesh.matrixWorld).sub(around.centre);
  const right = new Vector3().crossVectors(around.up, towards).normalize();
  if (right.lengthSq() === 0) return new Matrix4(); // it looks straight down
  return new Matrix4().makeBasis(right, around.up, new Vector3().crossVectors(right, around.up));
}

function follow(second: Player, first: Player): void {
  if (second.speed !== first.speed) second.speed = first.speed;
  if (second.loop !== first.loop) second.loop = first.loop;
  if (second.playing !== first.playing) {
    if (first.playing) second.play();
    else second.pause();
  }
  const wanted = first.sought / first.rate;
  const apart = Math.abs(wanted - second.sought / second.rate);
  const most = first.playing ? OUT_OF_STEP : 0.5 / second.rate;
  if (apart > most && apart < first.duration - most && !second.waiting && wanted < second.duration) void second.seek(second.first + wanted);
}

/** Whether two scenes were made of the same cameras, in one world. */
export function sameCameras(first: SceneInfo, second: SceneInfo): boolean {
  const slack = APART * Math.max(...first.viewPlane.extent);
  const own = new Map(first.cameras.map((camera) => [camera.name, camera]));
  const pairs = second.cameras.flatMap((camera) => {
    const other = own.get(camera.name);
    return other ? [[other, camera] as const] : [];
  });
  if (pairs.length < SHARED * Math.min(first.cameras.length, second.cameras.length)) return false;
  return pairs.every(([a, b]) =>
    Math.hypot(...a.centre.map((value, i) => value - (b.centre[i] ?? NaN))) <= slack &&
    a.R.flat().every((value, i) => Math.abs(value - (b.R.flat()[i] ?? NaN)) <= APART));
}
