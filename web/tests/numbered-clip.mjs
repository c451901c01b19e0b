// A clip of support.viewer_clips, whose frame n shows n by its mean and by its textures, and its group by their strength.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { scenePath } from "./harness.mjs";

export const facts = JSON.parse(readFileSync(scenePath("clip.json"), "utf8"));
const { groups, strengths, bits, textures, front } = facts;
export const FRAMES = groups.reduce((a, b) => a + b);
export const STARTS = groups.map((_, i) => groups.slice(0, i).reduce((a, b) => a + b, 0));
export const groupOf = (frame) => STARTS.findLastIndex((start) => start <= frame);

/** Loads a clip on the page of a lab as `window.field`; `window.read` draws and tells the number of the player, that of the mean, that of the
 * textures, the strength of theirs, and where there are sheets the number of the opacity; `window.played` collects that of each frame, `window.errors` what the field says. */
export async function openNumbered(lab, name = "clip.glb", { memory, ...options } = {}) {
  const opened = await lab.open(options);
  await opened.page.evaluate(
    async ([url, bits, textures, front, memory]) => {
      const { gltf, field } = await window.lab.loadEigenfield(url, { memory });
      const { lab } = window;
      lab.show(gltf);
      field.camera = field.info.cameras.length - 1;
      const view = () => lab.drawView(field, field.info.cameras[field.camera]);
      view();
      await field.complete;
      const places = [
        ...Array.from({ length: bits }, (_, bit) => [(bit + 0.5) / bits, 0.25]),
        ...Array.from({ length: textures }, (_, index) => [(index + 0.5) / textures, 0.75]),
        ...Array.from({ length: field.info.sheets ? bits : 0 }, (_, bit) => [(bit + 0.5) / bits, front]),
      ];
      const numberOf = (shades) => shades.reduce((sum, shade, bit) => sum + (shade > 128 ? 2 ** bit : 0), 0);
      window.field = field;
      window.read = () => {
        view();
        const shades = lab.greens(lab.pixelsOf(field, places));
        const strengths = shades.slice(bits, bits + textures).map((shade) => (shade - 128) / 127);
        const byMean = numberOf(shades.slice(0, bits));
        const byOpacity = field.info.sheets ? numberOf(shades.slice(bits + textures)) : null;
        const strongest = strengths.reduce((best, own) => (Math.abs(own) > Math.abs(best) ? own : best));
        return [field.player.frame, byMean, strengths.indexOf(strongest), strongest, shades.join(), byOpacity];
      };
      window.errors = [];
      field.addEventListener("error", ({ error }) => window.errors.push(error.code));
      window.played = [];
      field.player.addEventListener("frame", () => window.played.push(window.read()));
    },
    [name, bits, textures, front, memory],
  );
  return opened;
}

/** What `window.read` told is one frame, and that of its group. */
export function assertSame([frame, byMean, texture, strength, shades, byOpacity]) {
  const shown = `frame ${frame} shows ${byMean}, ${texture}, ${strength}, ${byOpacity}: ${shades}`;
  assert.deepEqual([byMean, texture, byOpacity ?? frame], [frame, frame % textures, frame], shown);
  const nearest = strengths.toSorted((a, b) => Math.abs(a - strength) - Math.abs(b - strength))[0];
  assert.equal(nearest, strengths[groupOf(frame)], shown);
}

/** Plays until so many frames were shown and the first followed the last; what was shown. */
export async function playThrough(page, pace, frames) {
  await page.evaluate((pace) => {
    window.field.player.speed = pace;
    window.field.player.play();
  }, pace);
  const turned = (frames) => {
    const { played } = window;
    return played.length >= frames && played.some(([frame], i) => i && frame < played[i - 1][0]);
  };
  await page.waitForFunction(turned, frames, { timeout: 60_000 });
  await page.evaluate(() => window.field.player.pause());
  await page.waitForFunction(() => window.field.player.open === 0);
  return page.evaluate(() => ({ played: window.played, errors: window.errors }));
}
