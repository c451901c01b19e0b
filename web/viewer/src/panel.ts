// The panel beside the picture.

import type { SceneInfo } from "eigenfield-three";
import { choice, menu, slider, tick } from "./controls";
import { button, element, ICONS } from "./dom";
import { briefly, createInfo } from "./info";
import { BACKGROUNDS } from "./options";
import { bytesWith, uvSsim } from "./scores";
import { bytes, shown } from "./text";
import type { Scene } from "./session";
import type { Viewer } from "./viewer";

const NO_PHOTOGRAPHS = "The photographs are not here. With the capture: eigenfield view scene.glb CAPTURE";
const NO_PLANE = "The cameras stand around the object: there is no plane that they look across.";
const SHADES: readonly string[] = ["black", "dark", "grey", "white"];

export interface Panel {
  readonly root: HTMLElement;
  update(): void;
  /** After a frame: what changes with every one. */
  tick(): void;
}

const cameraLabel = ({ names, heldOut }: SceneInfo, index: number): string =>
  `${names[index] ?? index}${heldOut[index] === true ? " ○ held out" : ""}`;

export function createPanel(viewer: Viewer): Panel {
  const title = element("h1");
  const summary = element("p", { class: "quiet" });
  const brief = element("div", { class: "brief" });

  const view = choice(
    "Show",
    [["picture", "Picture"], ["mean", "Mean"], ["eigen", "Eigen"], ["error", "Error ×5"]],
    (value) => viewer.set({ view: value }),
  );
  const eigen = slider("Eigen texture", (value) => viewer.set({ view: "eigen", eigen: value - 1 }));
  const count = slider("Eigen textures", (value) => viewer.set({ count: value }));
  const cost = element("p", { class: "quiet figures" });
  const limitation = element("p", { class: "warning" });

  const camera = menu("Captured camera", (value) => {
    if (value === "") viewer.moving();
    else viewer.toCamera(Number(value));
  });
  const previous = button("Previous camera  [", ICONS.previous, () => viewer.nextCamera(-1));
  const next = button("Next camera  ]", ICONS.next, () => viewer.nextCamera(1));
  const nearest = button("Nearest camera  N", ICONS.nearest, viewer.nearestCamera);
  const flip = element("button", { type: "button", class: "wide", "aria-pressed": "false" }, "Photograph");
  flip.addEventListener("click", () => viewer.showPhotograph(!viewer.photographShown()));
  const heldOut = element("p", { class: "quiet held" });
  const noPhotographs = element(
    "p", { class: "quiet" }, "To compare: ", element("code", {}, "eigenfield view scene.glb CAPTURE"),
  );

  const mode = choice(
    "Move", [["plane", "On the view plane"], ["orbit", "Orbit"]], (value) => viewer.setMode(value),
  );
  const weights = choice(
    "Weights off the plane", [["ray", "Each ray"], ["eye", "The eye"]], (value) => viewer.set({ weights: value }),
  );
  const mixing = choice(
    "Between cameras",
    [["delaunay", "Delaunay"], ["bilinear", "Bilinear"], ["nearest3", "Nearest 3"]],
    (value) => viewer.set({ mixing: value }),
  );
  const filter = choice(
    "Texels",
    [["bilinear", "Bilinear"], ["bicubic", "Bicubic"]],
    (value) => viewer.set({ filter: value }),
  );
  const wireframe = tick("Wireframe", (on) => viewer.set({ wireframe: on }));
  const background = choice(
    "Background",
    BACKGROUNDS.map((colour, i) => [colour, SHADES[i] ?? colour] as const),
    (value) => viewer.set({ background: value }),
  );
  const drawing = element(
    "details", {},
    element("summary", {}, "Drawing"),
    weights.root, mixing.root, filter.root, background.root, wireframe.root,
  );
  const info = createInfo(viewer);
  const about = element("details", {}, element("summary", {}, "About this file"), info.root);
  about.addEventListener("toggle", info.update);
  const rate = element("p", { class: "quiet rate", "aria-hidden": "true" });

  const cameras = element(
    "fieldset", { class: "control" },
    element("legend", {}, "Captured camera"),
    element("div", { class: "cameras" }, previous, camera.root, next, nearest), heldOut, flip, noPhotographs,
  );
  const own = element(
    "div", { class: "own" },
    view.root, eigen.root, count.root, cost, limitation, cameras, mode.root,
  );
  const root = element(
    "aside", { class: "panel", "aria-label": "Controls and information", id: "panel" },
    element("header", {}, title, summary, brief), own, drawing, about, rate,
  );

  let filled: Scene | null = null;
  const fill = (scene: Scene): void => {
    filled = scene;
    const field = scene.field;
    title.textContent = viewer.scene()?.source.name ?? "eigenfield";
    own.hidden = field === null;
    for (const control of [weights, mixing, filter]) control.root.hidden = field === null;
    if (!field) {
      summary.textContent = "A plain glTF file: no eigen textures.";
      brief.replaceChildren();
      return;
    }
    const { info: facts } = field;
    const parts = [`${facts.names.length} cameras`, `${field.total} eigen textures`, bytes(facts.bytes.total)];
    summary.textContent = parts.join(" · ");
    camera.fill([
      { label: null, entries: [["", "free view"]] },
      ...viewer.cameraOrder().map(({ label, indices }) => ({
        label, entries: indices.map((i): [string, string] => [String(i), cameraLabel(facts, i)]),
      })),
    ]);
    const held = facts.heldOut.filter(Boolean).length;
    heldOut.hidden = held === 0;
    heldOut.textContent = `${held} held out: the encoder never saw ${held === 1 ? "it" : "them"}.`;
    count.setRange(0, field.total);
    eigen.setRange(1, Math.max(field.total, 1));
    view.allow("eigen", field.total > 0, "The file has no eigen textures.");
    mode.allow("plane", scene.plane !== null, NO_PLANE);
    mixing.allow("bilinear", facts.grid !== null, "The cameras form no grid.");
    weights.enable(facts.facesPlane, NO_PLANE);
  };

  return {
    root,
    update: () => {
      const scene = viewer.scene();
      root.classList.toggle("empty", scene === null);
      if (!scene) {
        title.textContent = viewer.config.title ?? "eigenfield";
        summary.textContent = "";
        filled = null;
        return;
      }
      if (scene !== filled) fill(scene);
      const options = viewer.options();
      wireframe.show(options.wireframe);
      background.show(options.background);
      if (about.open) info.update();
      const { field } = scene;
      if (!field) return;
      brief.replaceChildren(briefly(field));
      const photographs = viewer.hasPhotograph();
      view.show(options.view);
      view.allow("error", photographs, NO_PHOTOGRAPHS);
      eigen.root.hidden = options.view !== "eigen";
      eigen.show(options.eigen + 1);
      eigen.say(`${options.eigen + 1} of ${field.total}`);
      const wanted = Math.min(options.count, field.total);
      const drawn = viewer.summed();
      count.show(wanted);
      count.say(drawn < wanted ? `${drawn} of ${wanted}` : `${wanted} of ${field.total}`);
      const ssim = uvSsim(field.info, drawn); // a fitted scene has none
      cost.textContent = bytes(bytesWith(field.info, drawn)) + (ssim === null ? "" : ` · UV SSIM ${shown(ssim, 4)}`);
      limitation.hidden = field.limitation === null;
      limitation.textContent = field.limitation;
      const captured = viewer.captured();
      camera.show(captured === null ? "" : String(captured));
      flip.disabled = !photographs;
      flip.title = photographs ? "Space" : NO_PHOTOGRAPHS;
      flip.textContent = viewer.photographShown() ? "Photograph – show the drawing" : "Show the photograph";
      flip.setAttribute("aria-pressed", String(viewer.photographShown()));
      noPhotographs.hidden = photographs;
      mode.show(viewer.modeName());
      weights.show(options.weights);
      mixing.show(options.mixing);
      filter.show(options.filter);
    },
    tick: () => {
      const now = viewer.rate();
      const { scale, linear } = viewer.detail();
      const drawn = scale < 1 ? ", coarser until it rests" : linear ? ", linear until it rests" : "";
      const near = viewer.nearestName();
      const rests = near === null ? "Drawn in full" : `Drawn in full, nearest camera ${near}`;
      rate.textContent = now === null ? rests : `${now.toFixed(0)} frames per second${drawn}`;
    },
  };
}
