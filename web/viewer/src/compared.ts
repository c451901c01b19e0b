// What the two scenes beside each other are: their names, bytes and scores.

import type { EigenField } from "eigenfield-three";
import { element } from "./dom";
import { shortly } from "./info";
import type { Viewer } from "./viewer";

export interface Compared {
  readonly roots: HTMLElement[];
  update(): void;
}

export function createCompared(viewer: Viewer): Compared {
  const left = element("p", { class: "compared left", hidden: "" });
  const right = element("p", { class: "compared right", hidden: "" });
  const show = (label: HTMLElement, name: string, field: EigenField | null): void => {
    const [title, facts] = [element("strong", {}, name), element("span", {}, field ? shortly(field.info) : "")];
    label.replaceChildren(title, facts);
  };
  return {
    roots: [left, right],
    update: () => {
      const [first, beside] = [viewer.scene(), viewer.beside()];
      const names = viewer.config.beside?.names;
      for (const label of [left, right]) label.hidden = !beside?.scene || !first || !names;
      if (!beside?.scene || !first || !names) return;
      show(left, names[0], first.field);
      show(right, names[1], beside.scene.field);
    },
  };
}
