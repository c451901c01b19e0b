// The proxy's edges over its surface.

import { Mesh, MeshBasicMaterial, type Object3D } from "three";

export function createWireframe(object: Object3D): { dispose(): void } {
  const material = new MeshBasicMaterial({
    color: 0xffffff, wireframe: true, transparent: true, opacity: 0.22, depthWrite: false,
  });
  const lines: Mesh[] = [];
  object.traverse((part) => {
    if (part instanceof Mesh) lines.push(new Mesh(part.geometry, material));
  });
  const parents: Mesh[] = [];
  object.traverse((part) => {
    if (part instanceof Mesh) parents.push(part);
  });
  parents.forEach((parent, i) => {
    const line = lines[i];
    if (line) parent.add(line);
  });
  return {
    dispose: () => {
      for (const line of lines) line.removeFromParent();
      material.dispose();
    },
  };
}
