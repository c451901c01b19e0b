// A headset: the scene is put where its wearer is, so that the eyes start in the middle of the array, and scaled so
// that the array keeps its real size. Each eye is drawn with weights of its own; the plug-in sees to that.

import { Matrix4, Quaternion, Vector3 } from "three";
import { button, ICONS } from "./dom";
import { scaled, add } from "./geometry";
import { words } from "./language";
import { SKIP } from "./playback";
import { extentOf } from "./surroundings";
import type { Viewer } from "./viewer";

const HALF_WIDTH = 0.25; // metres of an array whose size nobody knows
const PACE = 0.6; // view-plane units a second under a full stick
const DEAD = 0.15;
const NEAR = 0.03; // metres
const [TRIGGER, SQUEEZE, FIRST] = [0, 1, 4]; // buttons; the last is A, X

export interface Headset {
  readonly root: HTMLButtonElement;
  presenting(): boolean;
  enter(): Promise<void>;
}

export function createHeadset(viewer: Viewer, entered: (inside: boolean) => void): Headset {
  const { renderer, camera, root: stageRoot } = viewer.stage;
  const root = button(words("enterVr"), ICONS.headset, () => void enter());
  root.hidden = true;
  renderer.xr.setReferenceSpaceType("local");
  let session: XRSession | null = null;
  const shift = { x: 0, y: 0 }; // where sticks have moved the eye, view-plane units
  let base: Matrix4 | null = null; // scene to room, before `shift`; null until the head is known
  let pressed = new Set<string>(); // buttons, each with its hand
  let last = 0;

  const showIfPossible = async (): Promise<void> => {
    const possible = await navigator.xr?.isSessionSupported("immersive-vr").catch(() => false);
    root.hidden = possible !== true || !viewer.scene()?.field;
  };
  navigator.xr?.addEventListener("devicechange", () => void showIfPossible());
  viewer.onChange(() => void showIfPossible());

  const metres = (): number => {
    const info = viewer.scene()?.field?.info;
    if (!info) return 1;
    const half = Math.max(...info.viewPlane.extent);
    return info.metresPerUnit ?? (half > 0 ? HALF_WIDTH / half : 1);
  };
  /** The wearer's head, level, onto the place from which the capture is seen. */
  const place = (head: XRRigidTransform): Matrix4 => {
    const field = viewer.scene()?.field;
    if (!field) return new Matrix4();
    const { viewPlane, cameras, reference, facesPlane } = field.info;
    const toGltf = new Matrix4().copy(stageRoot.matrixWorld).invert().multiply(field.mesh.matrixWorld);
    const view = cameras[reference];
    const start = facesPlane || !view ? viewPlane.origin : view.centre;
    const eye = new Vector3(...start).applyMatrix4(toGltf);
    const forward = new Vector3(0, 0, -1);
    if (!facesPlane && view) forward.set(...(row3(view.R[2]))).transformDirection(toGltf);
    const { x, y, z, w } = head.orientation;
    const facing = new Vector3(0, 0, -1).applyQuaternion(new Quaternion(x, y, z, w));
    const turn = Math.atan2(-facing.x, -facing.z) - Math.atan2(-forward.x, -forward.z);
    const at = head.position;
    return new Matrix4()
      .makeTranslation(at.x, at.y, at.z)
      .multiply(new Matrix4().makeRotationY(turn))
      .multiply(new Matrix4().makeScale(metres(), metres(), metres()))
      .multiply(new Matrix4().makeTranslation(-eye.x, -eye.y, -eye.z));
  };
  const followHands = (seconds: number): void => {
    let reset = false;
    const now = new Set<string>();
    for (const { handedness, gamepad } of session?.inputSources ?? []) {
      const axes = gamepad?.axes ?? [];
      const stick = (index: number): number => {
        const value = axes[index] ?? 0;
        return Math.abs(value) < DEAD ? 0 : value;
      };
      shift.x += stick(2) * PACE * seconds;
      shift.y -= stick(3) * PACE * seconds;
      reset ||= gamepad?.buttons[FIRST]?.pressed === true;
      const fresh = (index: number): boolean => {
        const name = `${handedness} ${index}`;
        if (gamepad?.buttons[index]?.pressed === true) now.add(name);
        return now.has(name) && !pressed.has(name);
      };
      if (fresh(TRIGGER)) viewer.playOrPause();
      if (fresh(SQUEEZE)) viewer.skip(handedness === "left" ? -SKIP : SKIP);
    }
    pressed = now;
    shift.x = Math.min(Math.max(shift.x, -1), 1);
    shift.y = Math.min(Math.max(shift.y, -1), 1);
    if (!reset) return;
    Object.assign(shift, { x: 0, y: 0 });
    base = null; // the head's place now is the middle again
  };
  const frame = (now: number, xr?: XRFrame): void => {
    const field = viewer.scene()?.field;
    const space = renderer.xr.getReferenceSpace();
    const head = xr && space ? xr.getViewerPose(space) : undefined;
    if (!field || !head) return;
    field.player?.update(now); // the page itself has no frames now
    followHands(Math.min((now - last) / 1000, 0.1));
    last = now;
    base ??= place(head.transform);
    const { right, up, extent } = field.info.viewPlane;
    const moved = add(scaled(right, shift.x * extent[0]), scaled(up, shift.y * extent[1]));
    // What the eye does to the right the scene does to the left.
    const offset = new Vector3(...moved).applyQuaternion(field.mesh.getWorldQuaternion(new Quaternion()));
    const own = new Vector3().setFromMatrixScale(base).x;
    offset.applyQuaternion(stageRoot.getWorldQuaternion(new Quaternion()).invert());
    stageRoot.matrixAutoUpdate = false;
    stageRoot.matrix.copy(base).multiply(new Matrix4().makeTranslation(offset.multiplyScalar(-1)));
    stageRoot.updateMatrixWorld(true);
    camera.near = NEAR;
    camera.far = Math.max(100, 4 * own * extentOf(field.mesh).radius);
    field.camera = null;
    field.exposure = null;
    field.photograph = null;
    if (field.view === "error") field.view = "picture";
    field.filter = "bilinear"; // two eyes, ninety times a second
    field.coarser = 1;
    field.weightMode = field.info.facesPlane ? viewer.options().weights : "eye";
    viewer.stage.draw(null, 0);
  };
  const ended = (): void => {
    session = null;
    renderer.setAnimationLoop(null);
    renderer.xr.enabled = false;
    stageRoot.matrixAutoUpdate = true;
    stageRoot.matrix.identity();
    stageRoot.matrix.decompose(stageRoot.position, stageRoot.quaternion, stageRoot.scale);
    stageRoot.updateMatrixWorld(true);
    entered(false);
    viewer.resume();
  };
  const enter = async (): Promise<void> => {
    if (session) {
      await session.end();
      return;
    }
    if (!navigator.xr || !viewer.scene()?.field) return;
    let own: XRSession | null = null;
    try {
      own = session = await navigator.xr.requestSession("immersive-vr");
      viewer.suspend();
      base = null;
      Object.assign(shift, { x: 0, y: 0 });
      renderer.xr.enabled = true;
      renderer.setAnimationLoop(frame);
      await renderer.xr.setSession(own);
      entered(true);
    } catch (error) {
      await own?.end().catch(() => undefined); // which may be why
      viewer.say(words("vrRefused", { reason: error instanceof Error ? error.message : String(error) }));
    }
  };
  renderer.xr.addEventListener("sessionend", ended); // three.js has given the canvas its size back then
  return { root, presenting: () => session !== null, enter };
}

const row3 = (numbers: readonly number[] | undefined): [number, number, number] => [
  numbers?.[0] ?? 0, numbers?.[1] ?? 0, numbers?.[2] ?? -1,
];
