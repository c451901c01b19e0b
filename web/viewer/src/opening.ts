// Opening a scene, what arrives of it and when, and its end; a graphics context that is lost and comes back.

import { type EigenField, type Loaded, loadEigenfield, SceneError } from "eigenfield-three";
import type { Config } from "./config";
import { addressOf, confine } from "./confine";
import { pluginWords, words } from "./language";
import { sceneOf } from "./scene-of";
import type { Message, Session } from "./session";
import type { Source } from "./source";
import type { Stage } from "./stage";

export interface Opening {
  open(source: Source): Promise<void>;
  /** The scene that is being opened is here, or will not come. */
  done(): Promise<void>;
}

export interface Events {
  changed(): void;
  /** A scene is here: mesh and mean can be drawn. */
  opened(): void;
  /** A scene goes. */
  closing(): void;
}

export function createOpening(session: Session, stage: Stage, config: Config, events: Events): Opening {
  const { changed } = events;
  const openings: AbortController[] = []; // of the scene that is open and of those that may follow it, oldest first
  let opened: Promise<void> = Promise.resolve();
  let gone = (): void => undefined; // of the scene that is open

  const close = (): void => {
    if (!session.scene) return;
    events.closing();
    session.scene.field?.dispose();
    stage.clear();
    gone();
    Object.assign(session, { scene: null, captured: null, photographShown: false });
  };
  const put = (source: Source, { gltf, field, error }: Loaded): void => {
    close();
    stage.put(gltf.scene, field !== null);
    const said = error && described(error, null);
    const scene = sceneOf(source, { gltf, field, error }, said?.text ?? null, stage.aspect());
    if (field && config.metresPerUnit !== null && source.own) field.info.metresPerUnit = config.metresPerUnit;
    Object.assign(session, { scene, status: "ready", mode: scene.plane ? "plane" : "orbit" });
    session.message = said;
    events.opened();
    const divider = session.beside ? 0.5 : null;
    Object.assign(session.options, { eigen: 0, count: Infinity, view: "picture", divider });
    scene.plane?.step(10);
    changed();
  };
  const follow = async (field: EigenField): Promise<void> => {
    session.arriving = true;
    field.addEventListener("texture", () => {
      if (!document.querySelector(".poster")) changed(); // under a poster each would be drawn and not be seen
    });
    field.addEventListener("limited", changed);
    const failed = (error: unknown): void => {
      if (session.scene?.field !== field) return; // it was disposed of
      session.message = described(error, null);
      changed();
    };
    field.addEventListener("error", ({ error }) => failed(error));
    await field.complete.catch(failed); // which may have been before anyone listened
  };

  const open = async (source: Source): Promise<void> => {
    const mine = new AbortController();
    openings.push(mine);
    const stale = (): boolean => mine.signal.aborted;
    const latest = (): boolean => openings.at(-1) === mine;
    Object.assign(session, { status: "loading", arriving: false, message: null });
    session.progress = { loaded: 0, total: source.bytes };
    changed();
    try {
      const loaded = await loadEigenfield(source.from, {
        renderer: stage.renderer,
        signal: mine.signal,
        memory: config.memory ?? undefined,
        files: source.files,
        onBytes: (loaded, total) => {
          confine(document, source.from); // the answer has come, and nothing of the file is read yet
          if (!latest()) return;
          session.progress = { loaded, total: total ?? source.bytes };
          changed();
        },
      });
      const { field } = loaded;
      if (stale()) {
        field?.dispose();
        return;
      }
      while (openings[0] !== mine) openings.shift()?.abort();
      put(source, loaded);
      if (!field) return;
      await follow(field);
      if (session.scene?.field !== field) return;
      session.arriving = false;
      changed();
    } catch (error) {
      if (stale()) return;
      const last = latest();
      openings.splice(openings.indexOf(mine), 1);
      if (!last) return; // another one is on its way
      const field = session.scene?.field;
      const said = described(error, source);
      const text = session.scene ? words("cannotOpen", { name: source.name, reason: said.text }) : said.text;
      session.message = { ...said, text };
      session.status = session.scene ? "ready" : "failed"; // an open scene stays
      session.arriving = field ? field.loaded < field.usable : false;
      changed();
    }
  };

  stage.canvas.addEventListener("webglcontextlost", () => {
    session.status = "lost";
    session.message = { text: words("contextLost"), code: null, detail: null };
    changed();
  });
  stage.canvas.addEventListener("webglcontextrestored", () => {
    const { scene, options } = session;
    session.message = null;
    session.status = scene ? "ready" : openings.length > 0 ? "loading" : "empty";
    stage.setBackground(options.background); // which the new context does not know
    const closed = new Promise<void>((resolve) => (gone = resolve));
    if (scene?.field) opened = Promise.race([ended(scene.field), closed]); // it brings its textures back itself
    changed();
  });

  return {
    open: (source) => (opened = open(source)),
    done: async () => {
      let before: unknown = null;
      while (before !== opened) {
        before = opened;
        await opened;
      }
    },
  };
}

/** The eigen textures are all here, or one of them never will be. */
function ended(field: EigenField): Promise<void> {
  return new Promise((resolve) => {
    field.addEventListener("complete", () => resolve());
    field.addEventListener("error", () => resolve());
  });
}

/** `source`: what could not be opened, where nothing of it arrived. */
export function described(error: unknown, source: Source | null): Message {
  const message = error instanceof Error ? error.message : String(error);
  if (!(error instanceof SceneError)) return { text: message, code: null, detail: null };
  const { code } = error;
  const asked = typeof source?.from === "string" ? source.from : "";
  const site = error.cause && error.where === asked ? otherSite(asked) : null; // the fetch itself failed
  if (site !== null) return { text: words("otherSite", { site }), code, detail: null };
  const text = pluginWords(code, message);
  return { text, code, detail: text === message ? null : message };
}

/** The host of a URL that is not this page's. A browser says not why a fetch from there failed. */
function otherSite(url: string): string | null {
  const { origin, host } = addressOf(url) ?? location;
  return origin === location.origin ? null : host;
}
