// The built site in Firefox or WebKit (EIGENFIELD_ENGINE): each page in a frame of a desk's and of a phone's size.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import * as engines from "./engines.mjs";
import { serve } from "./harness.mjs";
import { AXE, PAGES, SITE } from "./site-pages.mjs";

const RIGHT = "\uE014"; // WebDriver's name of the key
const FRAME = { body: '<!doctype html><meta charset="utf-8"><title>walk</title><iframe style="border: 0"></iframe>', type: "text/html; charset=utf-8" };

let engine;
let site;
before(async () => {
  site = await serve({ folders: [SITE], routes: { "/walk": FRAME, "/axe.js": { body: AXE, type: "text/javascript" } } });
  engine = await engines[process.env.EIGENFIELD_ENGINE]();
  await engine.open(`${site.url}/walk`);
});
after(async () => {
  await engine?.close();
  await site.close();
});

/** Shows a page in the frame. */
const show = (path, width, height = 844) =>
  engine.evaluate(
    async ([path, width, height]) => {
      const frame = document.querySelector("iframe");
      Object.assign(frame, { width, height });
      const loaded = new Promise((resolve) => frame.addEventListener("load", resolve, { once: true }));
      frame.src = `/${path}`;
      await loaded;
    },
    [path, width, height],
  );

/** The scene of the first page, when it is drawn. */
const seen = () =>
  engine.evaluate(async () => {
    for (;;) {
      const state = frames[0].document.querySelector(".scene iframe").contentWindow.eigenfield?.state();
      if (state?.status === "ready") return { x: state.x, y: state.y };
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  });

test("the first page: the scene is above the fold, is drawn, and follows the keys", async () => {
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    await show("index.html", width, height);
    const before = await seen();
    const { y, bottom } = await engine.evaluate(() => {
      const scene = frames[0].document.querySelector(".scene");
      scene.querySelector("iframe").contentWindow.focus();
      return scene.getBoundingClientRect().toJSON();
    });
    assert.ok(y >= 0 && bottom <= height, `the scene ends at ${bottom} of ${height}`);
    await engine.press(RIGHT);
    let { x } = before;
    for (const end = Date.now() + 10_000; x === before.x && Date.now() < end; ) x = (await seen()).x; // drawn when it can be
    assert.ok(x > before.x, `${before.x} became ${x}`);
  }
});

test("the page that opens files draws its sample", async () => {
  await show("open/index.html?load=samples/jar.glb", 1280, 800);
  const { status, message } = await engine.evaluate(async () => {
    while (frames[0].eigenfield?.state().status !== "ready") await new Promise((resolve) => setTimeout(resolve, 50));
    return frames[0].eigenfield.state();
  });
  assert.deepEqual([status, message], ["ready", null]);
});

test("pages can be read by everybody, and fit a phone", async () => {
  assert.ok(PAGES.length > 15, `${PAGES.length} pages`);
  const found = [];
  for (const width of [1280, 390]) {
    for (const path of PAGES) {
      await show(path, width);
      const { wide, passes, violations } = await engine.evaluate(async () => {
        const { document, innerWidth } = frames[0];
        const script = document.createElement("script");
        const ready = new Promise((resolve) => script.addEventListener("load", resolve));
        script.src = "/axe.js";
        document.head.append(script);
        await ready;
        const options = { iframes: false, runOnly: ["wcag2a", "wcag2aa", "wcag21aa"], rules: { "heading-order": { enabled: true } } };
        const { passes, violations } = await frames[0].axe.run({ exclude: [".sig dl"] }, options);
        return {
          wide: document.scrollingElement.scrollWidth - innerWidth,
          passes: passes.length,
          violations: violations.map(({ id, nodes }) => `${id}: ${nodes[0].target} ${nodes[0].failureSummary}`),
        };
      });
      assert.ok(passes > 10, `${path}: ${passes} rules looked at`);
      if (wide > 0) found.push(`${path} at ${width}: ${wide} pixels too wide`);
      found.push(...violations.map((violation) => `${path} at ${width}: ${violation}`));
    }
  }
  assert.deepEqual(found, []);
});
