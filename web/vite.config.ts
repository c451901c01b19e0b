// The viewer: one page, one script, one style sheet, by fixed names, into the Python package.

import { fileURLToPath } from "node:url";
import { defineConfig, type Plugin } from "vite";
import { plainShaders } from "./vite.shaders.ts";

const path = (name: string) => fileURLToPath(new URL(name, import.meta.url));

/** The two tags that Python looks for when it makes one file of the page, without what Vite adds to them. */
function plainTags(): Plugin {
  return {
    name: "plain-tags",
    transformIndexHtml: {
      order: "post",
      handler: (html) =>
        html
          .replace(/[ \t]*<(script|link)[^>]*(viewer\.js|viewer\.css)"[^>]*>(<\/script>)?\n?/g, "")
          .replace(
            "</head>",
            '  <link rel="stylesheet" href="viewer.css">\n' +
              '    <script type="module" src="viewer.js"></script>\n  </head>',
          ),
    },
  };
}

export default defineConfig({
  root: path("viewer"),
  base: "./",
  publicDir: path("viewer/public"),
  resolve: { alias: { "eigenfield-three": path("eigenfield-three/src/index.ts") } },
  plugins: [plainShaders(), plainTags()],
  server: { fs: { allow: [path("..")] } },
  build: {
    outDir: path("../src/eigenfield/viewer/static"),
    emptyOutDir: true,
    target: "es2022",
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    cssCodeSplit: false,
    reportCompressedSize: false,
    chunkSizeWarningLimit: 900,
    rolldownOptions: {
      output: {
        codeSplitting: false,
        comments: { legal: true, annotation: false, jsdoc: false },
        entryFileNames: "viewer.js",
        assetFileNames: "viewer[extname]",
      },
    },
  },
});
