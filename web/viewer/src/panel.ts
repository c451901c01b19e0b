// The panel beside the picture.

import type { SceneInfo } from "eigenfield-three";
import { choice, menu, slider, tick } from "./controls";
import { button, element, ICONS, keyCaps } from "./dom";
import { briefly, createInfo } from "./info";
import { limitationWords, words } from "./language";
import { BACKGROUNDS } from "./options";
import { bytesWith, uvSsim } from "./scores";
import { bytes, shown } from "./text";
import type { Scene } from "./session";
import type { Viewer } from "./viewer";

const SHADES: readonly string[] = [words("black"), words("dark"), words("grey"), words("white")];

export interface Panel {
  readonly root: HTMLElement;
  update(): void;
  /** After a frame: what changes with every one. */
  tick(): void;
}

const cameraLabel = ({ names, heldOut }: SceneInfo, index: number): string =>
  `${names[index] ?? index}${heldOut[index] === true ? ` ○ ${words("heldOut")}` : ""}`;

export function createPanel(viewer: Viewer): Panel {
  const title = element("h1");
  const summary = element("p", { class: "quiet" });
  const brief = element("div", { class: "brief" });

  const view = choice(
    words("show"),
    [
      ["picture", words("showPicture")], ["mean", words("showMean")], ["eigen", words("showEigen")],
      ["error", words("showError")],
    ],
    (value) => viewer.set({ view: value }),
    "1 2 3 4",
  );
  const eigen = slider(words("eigenTexture"), (value) => viewer.set({ view: "eigen", eigen: value - 1 }));
  const count = slider(words("eigenTextures"), (value) => viewer.set({ count: value }), "− +");
  const cost = element("p", { class: "quiet figures" });
  const limitation = element("p", { class: "warning" });

  const camera = menu(words("capturedCamera"), (value) => {
    if (value === "") viewer.moving();
    else viewer.toCamera(Number(value));
  });
  const previous = button(words("previousCamera"), ICONS.previous, () => viewer.nextCamera(-1), "[");
  const next = button(words("nextCamera"), ICONS.next, () => viewer.nextCamera(1), "]");
  const nearest = button(words("nearestCamera"), ICONS.nearest, viewer.nearestCamera, "N");
  const flip = element("button", { type: "button", class: "wide", "aria-pressed": "false" });
  flip.addEventListener("click", () => viewer.showPhotograph(!viewer.photographShown()));
  const divide = element("button", { type: "button", class: "wide", "aria-pressed": "false" });
  divide.append(words("divider"), keyCaps("B"));
  divide.addEventListener("click", viewer.divide);
  const heldOut = element("p", { class: "quiet held" });
  const noPhotographs = element(
    "p", { class: "quiet" }, `${words("toCompare")} `, element("code", {}, "eigenfield view scene.glb CAPTURE"),
  );

  const mode = choice(
    words("move"), [["plane", words("onPlane")], ["orbit", words("orbit")]], (value) => viewer.setMode(value), "O",
  );
  const weights = choice(
    words("weightsOffPlane"),
    [["ray", words("eachRay")], ["eye", words("theEye")]],
    (value) => viewer.set({ weights: value }),
    "T",
  );
  const mixing = choice(
    words("betweenCameras"),
    [["delaunay", words("delaunay")], ["bilinear", words("bilinear")], ["nearest3", words("nearestThree")]],
    (value) => viewer.set({ mixing: value }),
  );
  const filter = choice(
    words("texels"),
    [["bilinear", words("bilinear")], ["bicubic", words("bicubic")]],
    (value) => viewer.set({ filter: value }),
  );
  const wireframe = tick(words("wireframe"), (on) => viewer.set({ wireframe: on }), "M");
  const background = choice(
    words("background"),
    BACKGROUNDS.map((colour, i) => [colour, SHADES[i] ?? colour] as const),
    (value) => viewer.set({ background: value }),
  );
  const drawing = element(
    "details", {},
    element("summary", {}, words("drawing")),
    weights.root, mixing.root, filter.root, background.root, wireframe.root,
  );
  const info = createInfo(viewer);
  const about = element("details", {}, element("summary", {}, words("aboutFile")), info.root);
  about.addEventListener("toggle", info.update);
  const rate = element("p", { class: "quiet rate", "aria-hidden": "true" });

  const cameras = element(
    "fieldset", { class: "control" },
    element("legend", {}, words("capturedCamera")),
    element("div", { class: "cameras" }, previous, camera.root, next, nearest), heldOut, flip, divide, noPhotographs,
  );
  const own = element(
    "div", { class: "own" },
    view.root, eigen.root, count.root, cost, limitation, cameras, mode.root,
  );
  const root = element(
    "aside", { class: "panel", "aria-label": words("panelLabel"), id: "panel" },
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
      summary.textContent = scene.lacks ?? words("plainGltf");
      brief.replaceChildren();
      return;
    }
    const { info: facts } = field;
    summary.textContent = [
      words("countCameras", { count: facts.names.length }),
      words("countTextures", { count: field.total }),
      bytes(facts.bytes.total),
    ].join(" · ");
    camera.fill([
      { label: null, entries: [["", words("freeView")]] },
      ...viewer.cameraOrder().map(({ label, indices }) => ({
        label, entries: indices.map((i): [string, string] => [String(i), cameraLabel(facts, i)]),
      })),
    ]);
    const held = facts.heldOut.filter(Boolean).length;
    heldOut.hidden = held === 0;
    heldOut.textContent = words("heldOutNote", { count: held });
    count.setRange(0, field.total);
    eigen.setRange(1, Math.max(field.total, 1));
    view.allow("eigen", field.total > 0, words("noEigenTextures"));
    mode.allow("plane", scene.plane !== null, words("noPlane"));
    mixing.allow("bilinear", facts.grid !== null, words("noGrid"));
    weights.enable(facts.facesPlane, words("noPlane"));
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
      view.allow("error", photographs, words("noPhotographs"));
      eigen.root.hidden = options.view !== "eigen";
      eigen.show(options.eigen + 1);
      eigen.say(words("outOf", { part: options.eigen + 1, whole: field.total }));
      const wanted = Math.min(options.count, field.total);
      const drawn = viewer.summed();
      count.show(wanted);
      count.say(words("outOf", { part: drawn, whole: drawn < wanted ? wanted : field.total }));
      const ssim = uvSsim(field.info, drawn); // a fitted scene has none
      cost.textContent = bytes(bytesWith(field.info, drawn)) + (ssim === null ? "" : ` · UV SSIM ${shown(ssim, 4)}`);
      limitation.hidden = field.limitation === null;
      limitation.textContent = limitationWords(field);
      const captured = viewer.captured();
      camera.show(captured === null ? "" : String(captured));
      flip.disabled = !photographs;
      flip.title = photographs ? "" : words("noPhotographs");
      const flipped = viewer.photographShown();
      flip.replaceChildren(words(flipped ? "showDrawing" : "showPhotograph"), keyCaps(words("keySpace")));
      const beside = viewer.beside()?.scene != null;
      divide.disabled = !photographs && !beside;
      divide.title = divide.disabled ? words("noPhotographs") : "";
      divide.setAttribute("aria-pressed", String((flipped || beside) && options.divider !== null));
      flip.setAttribute("aria-pressed", String(flipped));
      noPhotographs.hidden = photographs || viewer.player() !== null;
      flip.hidden = divide.hidden = viewer.player() !== null; // photographs would be of one instant
      mode.show(viewer.modeName());
      weights.show(options.weights);
      mixing.show(options.mixing);
      filter.show(options.filter);
    },
    tick: () => {
      const now = viewer.rate();
      const { scale, linear } = viewer.detail();
      const name = viewer.nearestName();
      const rests = name === null ? words("inFull") : words("inFullNear", { name });
      const { field } = viewer.scene() ?? {};
      if (field?.player && !root.hidden) brief.replaceChildren(briefly(field));
      const moves = scale < 1 ? "rateCoarser" : linear ? "rateLinear" : "rate";
      rate.textContent = now === null ? rests : words(moves, { rate: now.toFixed(0) });
    },
  };
}
