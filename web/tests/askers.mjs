// Files of strangers that would have whoever opens them ask another host.

import { readGlb, sceneBytes, writeGlb } from "./harness.mjs";

/** Their bytes, by what asks `host`. */
export function askers(host) {
  const [scene, plain] = [readGlb(sceneBytes("scene.glb")), readGlb(sceneBytes("plain.glb"))];
  const changed = ({ json, binary }, change) => {
    const made = structuredClone(json);
    change(made);
    return writeGlb({ json: made, binary });
  };
  const picture = (uri) => (json) => {
    (json.images ??= []).push({ uri });
    (json.textures ??= []).push({ source: json.images.length - 1 });
    (json.materials ??= []).push({ emissiveTexture: { index: json.textures.length - 1 } });
    json.meshes.push({ primitives: [{ ...json.meshes[0].primitives[0], material: json.materials.length - 1 }] });
    json.nodes.push({ mesh: json.meshes.length - 1 });
    json.scenes[0].nodes.push(json.nodes.length - 1);
  };
  const asking = changed(plain, picture(`${host}/chunk.png`));
  const [two, end] = [Buffer.from(writeGlb(plain)), 20 + asking.readUInt32LE(12)];
  const twice = Buffer.concat([two, asking.subarray(12, end)]); // three.js reads the last chunk of JSON
  twice.writeUInt32LE(twice.length, 8);
  return {
    "plain image": asking,
    "plain buffer": changed(plain, (json) => (json.buffers[0].uri = `${host}/plain.bin`)),
    "second JSON": twice,
    "extension": changed(plain, (json) => (json.extensions = { MAKER_holograms: { parts: [{ uri: `${host}/a` }] } })),
    "no scheme": changed(plain, picture(`${host.replace("http:", "")}/plain.png`)),
    "relative": changed(plain, picture("../viewer.css")),
    "blob": changed(plain, picture(`blob:${host}/1`)),
    "scene image": changed(scene, picture(`${host}/scene.png`)),
    "scene buffer": changed(scene, (json) => json.buffers.push({ byteLength: 4, uri: `${host}/scene.bin` })),
  };
}
