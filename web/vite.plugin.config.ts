// The plug-in as an ES module of its own: `three` and its add-ons stay imports.

import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";
import { plainShaders } from "./vite.shaders.ts";

const path = (name: string) => fileURLToPath(new URL(name, import.meta.url));

export default defineConfig({
  root: path("eigenfield-three"),
  publicDir: false,
  plugins: [plainShaders()],
  build: {
    outDir: path("../src/eigenfield/viewer/static"),
    emptyOutDir: false,
    target: "es2022",
    reportCompressedSize: false,
    lib: { entry: path("eigenfield-three/src/index.ts"), formats: ["es"], fileName: () => "eigenfield-three.js" },
    rolldownOptions: { external: [/^three($|\/)/] },
  },
});
