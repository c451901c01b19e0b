// The viewer in each of its languages: which one it takes, and that its texts have room.

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch, WEB } from "./harness.mjs";
import { openViewer, state } from "./viewer-page.mjs";

const FOLDER = join(WEB, "viewer/src/languages");
const CATALOGUES = Object.fromEntries(
  readdirSync(FOLDER).map((name) => [name.replace(".json", ""), JSON.parse(readFileSync(join(FOLDER, name), "utf8"))]),
);
let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

for (const [locale, query, tag, hint] of [
  ["de-CH", "", "de", CATALOGUES.de.hint],
  ["zh-TW", "", "zh-Hans", CATALOGUES.zh.hint],
  ["pt-BR", "", "en", "Drag to look around"],
  ["de", "?lang=ja", "ja", CATALOGUES.ja.hint],
  ["fr", "?lang=EN-gb", "en", "Drag to look around"],
  ["fr-CA", "?lang=constructor", "fr", CATALOGUES.fr.hint],
]) {
  test(`a browser of ${locale}${query && ` at ${query}`} reads ${tag}`, async () => {
    const { page, close } = await openViewer(browser, "scene.glb", { query, context: { locale } });
    await state(page);
    assert.equal(await page.locator("html").getAttribute("lang"), tag);
    assert.equal(await page.locator(".hint").innerText(), hint);
    await close();
  });
}

test("what the plug-in finds is said in the page's language, with the plug-in's own words below", async () => {
  const { page, close } = await openViewer(browser, "truncated.glb", { query: "?lang=de" });
  await page.waitForSelector(".message:not([hidden])");
  const [said, about] = await page.locator(".message p").allInnerTexts();
  assert.equal(said, CATALOGUES.de["plugin.truncated"]);
  assert.match(about, /^truncated · The file is cut off/);
  assert.equal((await state(page)).message.code, "truncated");
  await close();
});

for (const language of Object.keys(CATALOGUES)) {
  test(`${language}: no text is wider than its place, on a desk and on a phone`, async () => {
    const { page, close } = await openViewer(browser, "held-out.glb", {
      width: 1280, height: 800, query: `?lang=${language}`, context: { hasTouch: true },
    });
    await state(page);
    await page.evaluate(() => {
      for (const part of document.querySelectorAll("details, .cue, .tag")) Object.assign(part, { open: true, hidden: false });
      document.querySelector("dialog").showModal();
    });
    for (const [width, height] of [[1280, 800], [390, 844]]) {
      await page.setViewportSize({ width, height });
      const wide = await page.evaluate(() =>
        [...document.querySelectorAll("body *")]
          .filter((part) => part.checkVisibility() && part.closest(".panel, .cue, .hint, .tools, dialog"))
          .filter((part) => {
            const { left, right } = part.getBoundingClientRect();
            return right > innerWidth + 1 || left < -1 || (part.clientWidth > 0 && part.scrollWidth > part.clientWidth + 1);
          })
          .map((part) => part.textContent.slice(0, 80)),
      );
      assert.deepEqual(wide, [], `${width} pixels`);
    }
    await close();
  });
}
