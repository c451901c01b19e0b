// The built viewer as a test opens it: served with a configuration and the server's own policy.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { openPage, sceneBytes, serve, STATIC } from "./harness.mjs";

const POLICY =
  "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; media-src blob:; " +
  "connect-src 'self' blob:; base-uri 'none'; form-action 'none'";
const PLACE = 'id="eigenfield-config">{}<';

/**
 * Opens the viewer. scene: a file of the test scenes, or null. photographs: camera name to a picture's file there.
 * routes, hash, query, config and what `openPage` takes are optional. Returns what openPage does and the server's url.
 */
export async function openViewer(browser, scene, options = {}) {
  const { photographs = {}, routes = {}, hash = "", query = "", config = {}, ...rest } = options;
  const names = Object.keys(photographs);
  const glb = scene === null ? null : sceneBytes(scene);
  const settings = {
    ...(glb && { scene: "scene.glb", bytes: glb.length, title: scene.replace(".glb", "") }),
    photographs: Object.fromEntries(names.map((name, i) => [name, `photographs/${i}`])),
    ...config,
  };
  const html = readFileSync(join(STATIC, "index.html"), "utf8");
  assert.equal(html.split(PLACE).length, 2, "one place for the configuration");
  const json = JSON.stringify(settings).replaceAll("<", "\\u003c");
  const server = await serve({
    routes: {
      "/": {
        body: html.replace(PLACE, () => `id="eigenfield-config">${json}<`),
        type: "text/html; charset=utf-8",
        headers: { "Content-Security-Policy": POLICY },
      },
      ...(glb && { "/scene.glb": { body: glb } }),
      ...Object.fromEntries(names.map((name, i) => [`/photographs/${i}`, png(photographs[name])])),
      ...routes,
    },
    folders: [STATIC],
  });
  const opened = await openPage(browser, null, { width: 480, height: 360, ...rest });
  await opened.page.emulateMedia({ reducedMotion: options.glide ? "no-preference" : "reduce" });
  await opened.page.goto(`${server.url}/${query}${hash}`);
  await opened.page.waitForFunction(() => window.eigenfield || document.querySelector("[role=alert]:not([hidden])"));
  const close = async () => {
    try {
      await opened.close();
    } finally {
      await server.close();
    }
  };
  return { ...opened, server, close };
}

const png = (file) => ({ body: sceneBytes(file), type: "image/png" });

export const settled = (page) => page.evaluate(() => window.eigenfield.settled());

/** What the viewer shows, once it is still. */
export async function state(page) {
  await settled(page);
  return page.evaluate(() => window.eigenfield.state());
}

/** Sets options and waits. */
export async function set(page, options) {
  await page.evaluate((wish) => window.eigenfield.set(wish), options);
  return state(page);
}

/** The picture as { width, height, data } with 3 bytes a pixel. */
export async function picture(page) {
  await settled(page);
  const { width, height, base64 } = await page.evaluate(() => {
    const { width, height, data } = window.eigenfield.pixels();
    let text = "";
    for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
    return { width, height, base64: btoa(text) };
  });
  return { width, height, data: new Uint8Array(Buffer.from(base64, "base64")) };
}

/** Mean difference of two pictures in grey levels. */
export function apart(a, b) {
  assert.deepEqual([a.width, a.height], [b.width, b.height]);
  return a.data.reduce((sum, value, i) => sum + Math.abs(value - b.data[i]), 0) / a.data.length;
}

export const near = (a, b, slack) => assert.ok(Math.abs(a - b) <= slack, `${a} is not ${b} to ${slack}`);

/** Drops a file of the test scenes, or one of these bytes, on the page. */
export async function drop(page, name, bytes = sceneBytes(name)) {
  const data = bytes.toString("base64");
  await page.evaluate(
    ([text, file]) => {
      const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
      const transfer = new DataTransfer();
      transfer.items.add(new File([bytes], file));
      for (const kind of ["dragenter", "dragover", "drop"])
        document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
    },
    [data, name],
  );
}

/** Before the page's own scripts: a gamepad, which is `window.pad`. */
export function holdGamepad() {
  const pad = { axes: [0, 0, 0, 0], buttons: Array.from({ length: 16 }, () => ({ pressed: false })) };
  window.pad = pad;
  navigator.getGamepads = () => [pad];
}
