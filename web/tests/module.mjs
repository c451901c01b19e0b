// TypeScript of ours as a module for Node, built by Vite.

import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { build } from "vite";

/** Builds a file of tests/pages. Returns { module, folder, close }: `folder` is the caller's too, until `close`. */
export async function buildModule(name) {
  const folder = await mkdtemp(join(tmpdir(), "eigenfield-module-"));
  await build({
    configFile: false,
    logLevel: "error",
    build: {
      outDir: join(folder, "built"),
      target: "es2022",
      minify: false,
      lib: {
        entry: fileURLToPath(new URL(`pages/${name}.ts`, import.meta.url)),
        formats: ["es"],
        fileName: () => `${name}.mjs`,
      },
    },
  });
  const module = await import(pathToFileURL(join(folder, `built/${name}.mjs`)));
  return { module, folder, close: () => rm(folder, { recursive: true, force: true }) };
}
