// Files that people bring: dropped on the page, chosen, or opened with the page where it is installed.

import { element } from "./dom";
import { words } from "./language";

/** Of the File Handling API, which Chromium has. */
declare global {
  interface Window {
    launchQueue?: { setConsumer(take: (launched: { files?: FileSystemFileHandle[] }) => void): void };
  }
}

export interface FileChooser {
  readonly root: HTMLInputElement;
  choose(): void;
}

export function takeFiles(take: (file: File) => void, hover: (over: boolean) => void): FileChooser {
  const accept = ".glb,model/gltf-binary";
  const input = element("input", { type: "file", accept, hidden: "", "aria-label": words("sceneFile") });
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    input.value = ""; // so that the same file can be chosen again
    if (file) take(file);
  });
  let inside = 0; // entered elements less left ones: moving over children leaves and enters
  const end = (): void => {
    inside = 0;
    hover(false);
  };
  addEventListener("dragenter", (event) => {
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    inside++;
    hover(true);
  });
  addEventListener("dragleave", () => {
    if (inside > 0 && --inside === 0) end();
  });
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    end();
    const file = event.dataTransfer?.files[0];
    if (file) take(file);
  });
  window.launchQueue?.setConsumer(({ files }) => void files?.[0]?.getFile().then(take));
  return { root: input, choose: () => input.click() };
}
