// The proxy's edges over its surface.

import { SHEETS } from "eigenfield-three";
import { Mesh, MeshBasicMaterial, type Object3D } from "three";

/** Returns what shows the edges of an object, and no others; of null none. */
export function createWireframe(): (object: Object3D | null) => void {
  const material = new MeshBasicMaterial({
    color: 0xffffff, wireframe: true, transparent: true, opacity: 0.22, depthWrite: false,
  });
  let lines: Mesh[] = [];
  return (object) => {
    for (const line of lines) line.removeFromParent();
    material.dispose(); // three.js makes it anew when it is drawn
    const parents: Mesh[] = [];
    object?.traverse((part) => {
      if (part instanceof Mesh && part.name !== SHEETS) parents.push(part);
    });
    lines = parents.map((parent) => new Mesh(parent.geometry, material));
    lines.forEach((line, i) => parents[i]?.add(line));
  };
}
