// The viewer's catalogues: the same keys in every language, none that the page does not use, and no text beside them.
// Needs Node.js alone.

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const SOURCES = fileURLToPath(new URL("../viewer/src", import.meta.url));
const PLUGIN = fileURLToPath(new URL("../eigenfield-three/src/errors.ts", import.meta.url));
const ONE_FORM = ["ja", "zh"]; // languages whose nouns do not change with their number

const files = readdirSync(SOURCES).filter((name) => name.endsWith(".ts"));
const sources = files.map((name) => readFileSync(join(SOURCES, name), "utf8"));
const catalogues = new Map(
  readdirSync(join(SOURCES, "languages")).map((name) => [
    name.replace(".json", ""), JSON.parse(readFileSync(join(SOURCES, "languages", name), "utf8")),
  ]),
);
const { en, ...others } = Object.fromEntries(catalogues);

test("every catalogue has English's keys in its order, and a sentence for each code of the plug-in", () => {
  const codes = [...readFileSync(PLUGIN, "utf8").matchAll(/^ {2}\| "([\w-]+)"/gm)].map(([, code]) => `plugin.${code}`);
  assert.ok(codes.length >= 9);
  assert.deepEqual(Object.keys(others).sort(), ["de", "fr", "ja", "zh"]);
  for (const [language, texts] of Object.entries(others)) {
    const own = Object.keys(texts).filter((key) => key.startsWith("plugin."));
    const limited = ["", ".count", ".bits", ".scale", ".mean"].map((kind) => `plugin.limited${kind}`);
    assert.deepEqual(own.sort(), [...codes, ...limited].sort(), language);
    assert.deepEqual(Object.keys(texts).filter((key) => !key.startsWith("plugin.")), Object.keys(en), language);
  }
});

test("the page uses every key", () => {
  const unused = Object.keys(en).filter((key) => !sources.some((text) => text.includes(`"${key}"`)));
  assert.deepEqual(unused, []);
});

test("no text that people read stands in the sources", () => {
  const read = /(?:"(?:aria-label|title|alt)": |textContent = |\bsay\(|\bbutton\(|\}, |\btext: )(["`])(?=[^"`]*\p{L}{3})[^"`]+\1/gu;
  const found = sources.flatMap((text, i) => [...text.matchAll(read)].map(([part]) => `${files[i]}: ${part}`));
  assert.deepEqual(found, ['panel.ts: }, "eigenfield view scene.glb CAPTURE"', 'screenshot.ts: }, "image/png"']);
  assert.match('element("p", {}, "It stays here.")', read, "such a text would be found");
});

test("texts are whole: the same {names} in each form, a form for each number, nothing left in English", () => {
  const names = (form) => [...form.matchAll(/\{(\w+)\}/g)].map(([, name]) => name).sort();
  for (const [language, texts] of catalogues) {
    for (const [key, text] of Object.entries(texts)) {
      const forms = text.split("|");
      assert.ok(forms.length <= (ONE_FORM.includes(language) ? 1 : 2), `${language} ${key}: ${forms.length} forms`);
      for (const form of forms) {
        assert.ok(form.trim() === form && form !== "", `${language} ${key}`);
        assert.deepEqual(names(form), names((en[key] ?? text).split("|")[0]), `${language} ${key}`);
      }
      if (forms.length > 1) assert.ok(names(text).includes("count"), `${language} ${key}: two forms need a {count}`);
    }
  }
  for (const [language, texts] of Object.entries(others)) {
    const sentences = Object.keys(en).filter((key) => key !== "units" && en[key].split(" ").length > 3);
    assert.ok(sentences.length > 30);
    assert.deepEqual(sentences.filter((key) => texts[key] === en[key]), [], language);
  }
});
