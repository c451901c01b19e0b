// The proxy's edges over its surface.

import { SHEETS } from "eigenfield-three";
import { Mesh, MeshBasicMaterial, type Object3D } from "three";

export function createWireframe(object: Object3D): { dispose(): void } {
  const material = new MeshBasicMaterial({
    color: 0xffffff, wireframe: true, transparent: true, opacity: 0.22, depthWrite: false,
  });
  const parents: Mesh[] = [];
  object.traverse((part) => {
    if (part instanceof Mesh && part.name !== SHEETS) parents.push(part);
  });
  const lines = parents.map((parent) => {
    const line = new Mesh(parent.geometry, material);
    parent.add(line);
    return line;
  });
  return {
    dispose: () => {
      for (const line of lines) line.removeFromParent();
      material.dispose();
    },
  };
}
