// The view in the address, after "#": a link shows what was seen. It is written quietly, without steps in the history.

import { Vector3 } from "three";
import { MIXINGS, oneOf, VIEWS } from "./options";
import type { Viewer } from "./viewer";

const PAUSE = 300; // milliseconds between two writings
const FURTHEST = 1e9; // of an eye on an axis: what is computed of it stays a number

export function keepAddress(viewer: Viewer): void {
  let timer: number | null = null;
  let written = location.hash;
  let read: unknown = null; // the source whose first view came from the address

  const write = (): void => {
    timer = null;
    if (viewer.scene()?.source !== read || viewer.status() !== "ready" || viewer.untouched()) return;
    const hash = hashOf(viewer);
    if (location.hash !== written) return; // changed by a person: `hashchange` is on its way
    if (hash === written) return;
    try {
      history.replaceState(history.state, "", hash);
      written = location.hash;
    } catch {
      // a page within a page, as in a notebook, has no address of its own
    }
  };
  viewer.onDraw(() => {
    timer ??= window.setTimeout(write, PAUSE);
  });
  viewer.onChange(() => {
    const scene = viewer.scene();
    if (!scene || scene.source === read) return;
    const first = read === null;
    read = scene.source;
    if (first) applyHash(viewer, written);
  });
  addEventListener("hashchange", () => {
    if (location.hash !== written) applyHash(viewer, (written = location.hash));
  });
}

const short = (value: number): string => String(Number(value.toFixed(4)));
const triple = (at: Vector3): string => at.toArray().map((value) => Number(value.toPrecision(5))).join();

export function hashOf(viewer: Viewer): string {
  const { scene, options } = { scene: viewer.scene(), options: viewer.options() };
  const parts = new URLSearchParams();
  const captured = viewer.captured();
  const name = captured === null ? undefined : scene?.field?.info.names[captured];
  if (name !== undefined) parts.set("camera", name);
  else if (viewer.modeName() === "plane" && scene?.plane) {
    const { x, y, zoom, dolly } = scene.plane.at();
    parts.set("x", short(x));
    parts.set("y", short(y));
    if (zoom !== 1) parts.set("zoom", short(zoom));
    if (dolly !== 0) parts.set("dolly", short(dolly));
  } else if (scene) {
    const { eye, target } = scene.orbit.pose();
    parts.set("eye", triple(eye));
    parts.set("at", triple(target));
  }
  const player = viewer.player();
  if (player && !player.playing) parts.set("t", short(player.time));
  if (scene?.plane) parts.set("mode", viewer.modeName());
  if (viewer.photographShown()) parts.set("photograph", "1");
  const divided = viewer.photographShown() || viewer.beside() !== null;
  if (divided && options.divider !== null) parts.set("divider", short(options.divider));
  if (Number.isFinite(options.count)) parts.set("n", String(options.count));
  if (options.view !== "picture") parts.set("view", options.view);
  if (options.view === "eigen") parts.set("eigen", String(options.eigen + 1));
  if (options.weights !== "ray") parts.set("weights", options.weights);
  if (options.mixing !== "delaunay") parts.set("mixing", options.mixing);
  if (options.wireframe) parts.set("wireframe", "1");
  return `#${parts.toString().replaceAll("%2C", ",")}`;
}

/** Sets what the address names and leaves the rest; what makes no sense is passed over. */
function applyHash(viewer: Viewer, hash: string): void {
  const scene = viewer.scene();
  if (!scene || hash.length < 2) return;
  const parts = new URLSearchParams(hash.slice(1));
  const number = (key: string): number | null => {
    const text = parts.get(key);
    return text === null || text.trim() === "" || !Number.isFinite(Number(text)) ? null : Number(text);
  };
  const place = (key: string): Vector3 | null => {
    const numbers = (parts.get(key) ?? "").split(",").map(Number);
    const [x, y, z] = numbers;
    if (x === undefined || y === undefined || z === undefined || !numbers.every((one) => Math.abs(one) <= FURTHEST)) return null;
    return new Vector3(x, y, z);
  };

  const mode = oneOf(["plane", "orbit"], parts.get("mode"));
  const [x, y] = [number("x"), number("y")];
  if (scene.plane && (x !== null || y !== null)) {
    viewer.goTo(x ?? 0, y ?? 0);
    scene.plane.setZoom(number("zoom") ?? 1);
    scene.plane.setDolly(number("dolly") ?? 0);
    scene.plane.step(10);
  }
  const [eye, target] = [place("eye"), place("at")];
  if (mode) viewer.setMode(mode);
  if (eye && target) {
    viewer.setMode("orbit");
    scene.orbit.set(eye, target);
  }
  const camera = scene.field?.info.names.indexOf(parts.get("camera") ?? "") ?? -1;
  if (camera >= 0) viewer.toCamera(camera);

  const [player, time] = [viewer.player(), number("t")];
  if (player && time !== null) {
    player.pause();
    void player.seek(time);
  }

  viewer.set({
    count: number("n") ?? Infinity,
    eigen: (number("eigen") ?? 1) - 1,
    weights: oneOf(["ray", "eye"], parts.get("weights")) ?? "ray",
    mixing: oneOf(MIXINGS, parts.get("mixing")) ?? "delaunay",
    wireframe: parts.get("wireframe") === "1",
    view: oneOf(VIEWS, parts.get("view")) ?? "picture",
  });
  const divider = number("divider");
  if (divider !== null) viewer.set({ divider });
  else if (parts.get("photograph") === "1") viewer.showPhotograph(true);
}
