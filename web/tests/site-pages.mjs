// What the walks through the site share: EIGENFIELD_SITE names its folder.

import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";

export const SITE = process.env.EIGENFIELD_SITE;
export const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
/** Decisions and indices are pages as the others are. */
export const PAGES = readdirSync(SITE, { recursive: true })
  .filter((path) => path.endsWith(".html") && !/^(_|scene|genindex|search|py-modindex|open)|\/0\d\d-/.test(path));
