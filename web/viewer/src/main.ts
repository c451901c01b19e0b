// The page: makes the parts, ties them together, and opens what the page was made for.

import { createApi } from "./api";
import { createCameraMap } from "./camera-map";
import { createCompared } from "./compared";
import { readConfig, type Ui } from "./config";
import { confine, leadElsewhere } from "./confine";
import { createDivider } from "./divider";
import { button, element, ICONS } from "./dom";
import { downloadScene } from "./download";
import { createDraft } from "./draft";
import { takeFiles } from "./files";
import { createHelp } from "./help";
import { listenToGamepads, type Gamepads } from "./input-gamepad";
import { listenToKeys, type Keys } from "./input-keys";
import { listenToPointers } from "./input-pointer";
import { createTilt } from "./input-tilt";
import { createFullscreen } from "./fullscreen";
import { LANGUAGE, words } from "./language";
import { keepOffline } from "./offline";
import { createOverlays } from "./overlays";
import { createPanel } from "./panel";
import { createPlaybar } from "./playbar";
import { posterShown, takePoster } from "./poster";
import { saveScreenshot } from "./screenshot";
import { createShare } from "./share";
import { besideSource, namedSource } from "./source";
import { keepAddress } from "./url";
import { createViewer, type Viewer } from "./viewer";
import { createHeadset } from "./xr";

const SMALL = "(max-width: 720px), (max-height: 500px)"; // the panel would leave little of the picture
const RATIO_MS = 500; // between two looks at the device pixels a CSS pixel

function start(): void {
  document.querySelector(".unscripted")?.remove();
  document.documentElement.lang = LANGUAGE;
  const address = new URL(location.href);
  const config = readConfig(document, address);
  document.body.dataset["ui"] = config.ui;
  if (!leadElsewhere([config.scene, address.searchParams.get("load"), config.poster])) confine(document);
  const name = (title: string): void => {
    document.title = config.ui === "full" ? `${title} – eigenfield` : title; // other pages are their owners'
  };
  if (config.title !== null) name(config.title);
  const canvas = element(
    "canvas", { class: "view", tabindex: "0", role: "application", "aria-label": words("canvas") },
  );
  const stageArea = element("main", { class: "stage" }, canvas);

  let keys: Keys | null = null;
  let gamepads: Gamepads | null = null;
  /** What keys and sticks that are held do in one frame. */
  const pushed = (seconds: number): boolean => {
    const wishes = [keys?.wish(), gamepads?.wish()].filter((wish) => wish != null);
    for (const wish of wishes) viewer.moving()?.push(wish, seconds);
    return wishes.length > 0;
  };
  let viewer: Viewer;
  try {
    viewer = createViewer(canvas, config, pushed);
  } catch {
    const said = element("div", { class: "message small", role: "alert" }, element("p", {}, words("noWebgl")));
    const title = element("p", { class: "title" }, element("span", {}, config.title ?? ""));
    const shown = takePoster(document, config.poster);
    document.body.append(element("main", { class: "stage" }, ...(shown ? [shown] : []), title, said));
    return;
  }

  const chooser = takeFiles((source) => void viewer.open(source), (over) => overlays.hover(over));
  const overlays = createOverlays(viewer, chooser.choose);
  const panel = createPanel(viewer);
  const map = createCameraMap(viewer);
  const divider = createDivider(viewer);
  const compared = createCompared(viewer);
  const playbar = createPlaybar(viewer);
  const help = createHelp(config.version);
  const headset = createHeadset(viewer, (inside) => {
    update();
    if (!inside) fit(); // the window may be another one by now
  });
  const draft = createDraft(viewer, headset.presenting);
  const tilt = createTilt(viewer, () => update());

  const showPanel = (shown: boolean): void => {
    panel.root.hidden = !shown;
    fold.setAttribute("aria-expanded", String(shown));
  };
  const fold = button(words("panel"), ICONS.panel, () => showPanel(panel.root.hidden !== false), "I");
  fold.setAttribute("aria-controls", "panel");
  const orbit = button(
    words("orbit"), ICONS.orbit, () => viewer.setMode(viewer.modeName() === "plane" ? "orbit" : "plane"), "O",
  );
  const lean = button(words("tilt"), ICONS.tilt, () => void tilt.toggle());
  const fullscreen = createFullscreen();
  let ui = config.ui;
  const laboratory = button(words("laboratory"), ICONS.info, () => showUi(ui === "full" ? "plain" : "full"));
  const shoot = button(words("savePicture"), ICONS.camera, () => saveScreenshot(viewer), "P");
  const share = createShare(viewer);
  const home = button(words("firstView"), ICONS.home, viewer.home, words("keyHome"));
  const download = button(words("download"), ICONS.download, () => {
    const source = viewer.scene()?.source;
    if (source) downloadScene(source);
  });
  const plain = [home, share.link, share.embed, download, fullscreen, headset.root, laboratory];
  for (const one of plain) one.classList.add("plain");
  const tools = element(
    "div", { class: "tools", role: "toolbar", "aria-label": words("tools") },
    home, orbit, lean, shoot, share.link, share.embed, download,
    button(words("openFile"), ICONS.open, chooser.choose), button(words("controls"), ICONS.help, help.toggle, "H"),
    fullscreen, headset.root, fold, laboratory,
  );
  const showUi = (next: Ui): void => {
    ui = next;
    document.body.dataset["ui"] = ui; // the style sheet hides what does not belong to it
    viewer.setFading(ui !== "full");
    canvas.setAttribute("aria-label", words(ui === "full" ? "canvas" : "canvasPlain"));
    laboratory.setAttribute("aria-pressed", String(ui === "full"));
    showPanel(ui === "full" && !matchMedia(SMALL).matches);
  };
  const poster = takePoster(document, config.poster);
  stageArea.append(...(poster ? [poster] : []), divider.root, ...compared.roots, ...overlays.roots, draft, share.said, map.root, playbar.root, tools);
  document.body.append(stageArea, panel.root, help.root, chooser.root);

  const update = (): void => {
    document.body.dataset["status"] = viewer.status();
    panel.update();
    overlays.update();
    compared.update();
    map.update();
    playbar.update();
    orbit.setAttribute("aria-pressed", String(viewer.modeName() === "orbit"));
    orbit.hidden = !viewer.scene()?.plane;
    lean.hidden = !tilt.possible || !viewer.scene()?.plane;
    lean.setAttribute("aria-pressed", String(tilt.on()));
    for (const one of [home, shoot, fold]) one.hidden = viewer.scene() === null;
    laboratory.hidden = !config.laboratory || viewer.status() === "empty";
    const { source, field } = viewer.scene() ?? {};
    share.link.hidden = !share.possible || !source || source.from !== named?.from; // an address leads to no other
    share.embed.hidden = share.link.hidden;
    download.hidden = !config.download || source?.own !== true || field?.info.inFiles === true;
    const title = viewer.scene()?.source.name;
    if (title !== undefined) name(title);
  };
  viewer.onChange(update);
  viewer.onDraw(() => {
    overlays.tick();
    divider.tick();
    playbar.tick();
    map.update();
    panel.tick();
    if (viewer.scene() !== null && (!viewer.arriving() || !viewer.untouched())) poster?.remove();
  });

  listenToPointers(viewer);
  keys = listenToKeys(viewer, {
    plain: () => ui !== "full",
    help: help.toggle,
    divide: viewer.divide,
    panel: () => showPanel(panel.root.hidden !== false),
    screenshot: () => saveScreenshot(viewer),
  });
  gamepads = listenToGamepads(viewer);
  keepAddress(viewer);
  showUi(ui);
  let ratio = devicePixelRatio; // that the canvas was made for
  const fit = (): void => {
    if (headset.presenting()) return; // the headset has its own size
    ratio = devicePixelRatio;
    viewer.stage.resize(stageArea.clientWidth, stageArea.clientHeight);
    viewer.drawNow(); // at once: a canvas that was resized is empty
    viewer.request();
  };
  new ResizeObserver(fit).observe(stageArea);
  setInterval(() => { // another monitor has other pixels, of which no event tells in every browser
    if (devicePixelRatio !== ratio) fit();
  }, RATIO_MS);
  window.eigenfield = createApi(viewer);

  viewer.stage.resize(stageArea.clientWidth, stageArea.clientHeight); // how far one may zoom out depends on it
  const named = namedSource(config, document, address);
  update();
  const opened = named && viewer.open(named);
  const other = named?.own ? besideSource(config, document) : null;
  if (other) void viewer.openBeside(other);
  if (config.worker !== null) keepOffline(config.worker, opened?.then(() => viewer.scene()?.source.from));
}

const waited = posterShown(document);
if (waited) void waited.then(start);
else start();
