// `npm run example`: a plain three.js page that draws a scene through the plug-in. Open it with `?scene=URL`.

import { fileURLToPath } from "node:url";
import { defineConfig } from "vite";

const path = (name: string) => fileURLToPath(new URL(name, import.meta.url));

export default defineConfig({
  root: path("example"),
  resolve: { alias: { "eigenfield-three": path("eigenfield-three/src/index.ts") } },
  server: { host: "127.0.0.1", fs: { allow: [path("..")] } },
});
