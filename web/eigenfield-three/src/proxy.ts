// The geometry that is drawn: what three.js has made of the file's mesh, checked, or the coded mesh in its place.

import { BufferAttribute, BufferGeometry } from "three";
import type { Stream, ViewBytes } from "./accessors.js";
import type { SceneDocument } from "./document.js";
import { SceneError, damaged } from "./errors.js";
import { MAX_NUMBER } from "./limits.js";
import type { DecodedMesh } from "./mesh-decoder.js";

const SHORT = 65535; // vertices up to which indices have 16 bits: index 65535 itself begins a new strip

export function checkGeometry(geometry: BufferGeometry, shown: NonNullable<SceneDocument["shown"]>): void {
  const position = geometry.getAttribute("position");
  const uv = geometry.getAttribute("uv");
  const { index } = geometry;
  if (!index) throw new SceneError("damaged", "The proxy mesh has no triangles; make or download the file again.");
  if (uv.count !== position.count) throw damaged(shown.uv.where, `${uv.count} for ${position.count} vertices`);
  for (let i = 0; i < position.count; i++) {
    const largest = Math.max(Math.abs(position.getX(i)), Math.abs(position.getY(i)), Math.abs(position.getZ(i)));
    if (!(largest <= MAX_NUMBER)) throw damaged(shown.position.where, `vertex ${i} is not finite`);
    if (!(Math.max(Math.abs(uv.getX(i)), Math.abs(uv.getY(i))) <= MAX_NUMBER)) {
      throw damaged(shown.uv.where, `texture coordinates of vertex ${i} are not finite`);
    }
  }
  for (const vertex of index.array) {
    if (vertex >= position.count) throw damaged(shown.indices.where, `no vertex ${vertex}`);
  }
}

/** The proxy of a scene whose glTF mesh is a coarse one, for viewers that know nothing of ours. */
export async function readCodedMesh({ view, codec, where }: Stream<"mesh">, bytes: ViewBytes): Promise<DecodedMesh> {
  const mesh = codec.decode(new Uint8Array(await bytes(view)), where);
  if (!mesh.indices.length) throw damaged(where, "a mesh without faces");
  return mesh;
}

export function geometryOf({ positions, uv, indices }: DecodedMesh): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions.slice(), 3)); // those of a clip move
  geometry.setAttribute("uv", new BufferAttribute(uv, 2));
  const short = positions.length / 3 <= SHORT;
  geometry.setIndex(new BufferAttribute(short ? Uint16Array.from(indices) : indices, 1));
  return geometry;
}

export function countsOf(geometry: BufferGeometry): { vertices: number; triangles: number } {
  return { vertices: geometry.getAttribute("position").count, triangles: (geometry.index?.count ?? 0) / 3 };
}
