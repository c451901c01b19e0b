// Shaders go without their comments into what is built.

import type { Plugin } from "vite";

export function plainShaders(): Plugin {
  return {
    name: "plain-shaders",
    transform: {
      filter: { id: /\.glsl\?raw$/ },
      handler: (code) => code.replace(/ *\/\/.*?(?=\\n)/g, "").replace(/(\\n)+/g, "\\n"),
    },
  };
}
