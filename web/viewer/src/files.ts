// Files that people bring: dropped on the page, chosen, or opened with the page where it is installed.

import { element } from "./dom";
import { words } from "./language";
import { fileSource, folderSource, type Source } from "./source";

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

export function takeFiles(open: (source: Source) => void, hover: (over: boolean) => void): FileChooser {
  const take = (file: File): void => open(fileSource(file));
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
    const [entry, file] = [event.dataTransfer?.items[0]?.webkitGetAsEntry(), event.dataTransfer?.files[0]];
    if (entry && isFolder(entry)) void takeFolder(entry);
    else if (file) take(file);
  });
  const takeFolder = async (folder: FileSystemDirectoryEntry): Promise<void> => {
    const source = folderSource(folder.name, new Map(await filesOf(folder)));
    if (source) open(source);
  };
  window.launchQueue?.setConsumer(({ files }) => void files?.[0]?.getFile().then(take));
  return { root: input, choose: () => input.click() };
}

const isFolder = (entry: FileSystemEntry): entry is FileSystemDirectoryEntry => entry.isDirectory;
const isFile = (entry: FileSystemEntry): entry is FileSystemFileEntry => entry.isFile;

/** The files of a folder and of those in it, by their paths. A clip has no deeper ones. */
async function filesOf(folder: FileSystemDirectoryEntry, within = ""): Promise<[string, File][]> {
  const reader = folder.createReader();
  const found: [string, File][] = [];
  for (;;) { // a reader tells of some at a time
    const some = await new Promise<FileSystemEntry[]>((done, fail) => reader.readEntries(done, fail));
    if (!some.length) return found;
    for (const entry of some) {
      if (isFile(entry)) found.push([within + entry.name, await new Promise<File>((done, fail) => entry.file(done, fail))]);
      else if (isFolder(entry) && within === "") found.push(...(await filesOf(entry, `${entry.name}/`)));
    }
  }
}
