// The root extension in few bytes: its JSON deflated with a preset dictionary, then its streams. docs/format.md, "Packed".

import { readViews, type View } from "./accessors.js";
import { parseJson } from "./container.js";
import { checkVersion } from "./document.js";
import { damaged } from "./errors.js";
import { inflated } from "./inflate.js";
import { Value, type Json, type JsonObject } from "./json.js";
import * as limits from "./limits.js";
import type { PackedJson, SceneJson } from "./schema.js";

export const DICTIONARY = [
  '"names":["texts":["heldOut":[1,2,"lenses":[null,"harmonise":"gain","affine",',
  '"align":true,"residual":{"quality":40},"metresPerUnit":0.',
  '"sharedPicture","times","codec":"codedNames":{"bufferView":10,"count":20},"sizes":3,"colour":4,"times":[0,',
  '"residual":{"size":[512,512],"scale":[0.00,0.00],"full":true,"smooth":true,"order":3,"holdOut":"odd","every:',
  '"scores":{"psnr":{"mean":"ssim":{"mean":"captured":"heldOut":',
  '{"needs":["av1-10bit-2","cameras-2","codedNames","codedTriangles","codedWeights","mesh-2","namePattern",',
  '"precision","regions","stacks","toRGB"],"mesh":{"bufferView":5,"codec":"mesh-2"},',
  '"planes":[{"channels":1,"mean":{"bufferView":6,"size":[1024,768],"mimeType":"video/AV1","bits":10,',
  '"scale":[0.0009775171065493646],"zero":[0],"precision":{"bufferView":7,"size":[13,12]}},',
  '"bases":[{"size":[480,480],"codedWeights":8,"textures":[{"bufferView":11,"mimeType":"video/AV1","bits":10,"count":2,',
  '"scale":[0.0001],"zero":[341]}]},{"size":[64,464],"grid":[464,464],"corner":[0,0],"codedWeights":9,',
  '"picture":{"mimeType":"video/AV1","bits":10,"count":8,"scale":[0.0002],"zero":[341]},',
  '"textures":[{"bufferView":12},{"bufferView":13}]}]},',
  '{"channels":2,"mean":{"bufferView":9,"size":[512,384],"mimeType":"video/AV1","bits":10,',
  '"scale":[0.0004,0.0004],"zero":[341,341],"precision":{"bufferView":7,"size":[13,12]}},"bases":[]}],',
  '"toRGB":[1,-0.027444022,-0.9585462,1,-0.092323445,0.284937,1,0.9953508,0],',
  '"cameras":{"pattern":{"counts":[81,1],"parts":["image_",{"axis":0,"first":0,"step":1,"digits":3},',
  '".png",".jpg",".webp"]},"size":[640,480],"coded":{"bufferView":4,"codec":"cameras-2"}},',
  '"viewPlane":{"origin":[0,0,0],"right":[1,0,0],"up":[0,-1,0],"extent":[0.5,0.5],"codedTriangles":10},"reference":40,',
  '"settings":{"textures":2,"atlas":[1024,768],"density":1.3,"fit":"photographs",',
  '"fitted":{"quality":78,"psnr":{"luma":{"uncoded":50.0,"coded":40.0},"chroma":{"uncoded":50.0,"coded":40.0}}},',
  '"photographs":{"count":81,"bytes":10000000,"pixels":10000000}},"generator":"eigenfield 0.1.0","lengths":[',
].join("");
const HEAD = 4; // bytes of the length of the deflated JSON

/** Bytes of the binary chunk. */
export type ByteReader = (offset: number, length: number) => Promise<ArrayBuffer>;

/**
 * The JSON that a plain file would have, over the same binary chunk; the same if it is plain. Raises SceneError:
 * `version`, `needs`, `truncated`, `damaged`.
 */
export async function unpacked(json: JsonObject, read: ByteReader): Promise<JsonObject> {
  const root = new Value(json, "");
  const extension = root.key("extensions").key(limits.EXTENSION) as Value<PackedJson>;
  const packed = extension.key("packed");
  if (!packed.exists) return json;
  checkVersion(extension as Value as Value<SceneJson>);
  const views = readViews(root);
  const view = views[packed.integer(views.length - 1, views.length - 1)];
  if (!view || view.length < HEAD) throw packed.wrong("no length");
  const size = new DataView(await read(view.offset, HEAD)).getUint32(0, true);
  if (HEAD + size > view.length) throw packed.wrong(`JSON of ${size} bytes`);
  const text = await inflateJson(await read(view.offset + HEAD, size), packed.where);
  const { lengths, ...inner } = new Value(parseJson(text, packed.where), packed.where).object();
  const streams = streamViews(new Value(lengths, `${packed.where}/lengths`), view, HEAD + size);
  const { packed: _, ...outer } = extension.object();
  return {
    ...json,
    bufferViews: [...root.key("bufferViews").items(limits.MAX_VIEWS).slice(0, -1).map(({ raw }) => raw ?? null), ...streams],
    extensions: { ...root.key("extensions").object(), [limits.EXTENSION]: { ...outer, ...inner } },
  };
}

/** Buffer views of streams that lie one behind the other from byte `start` of a view, up to its end. */
function streamViews(lengths: Value, view: View, start: number): Json[] {
  let at = start;
  const streams = lengths.items(limits.MAX_VIEWS).map((item) => {
    const byteLength = item.integer(1, view.length);
    at += byteLength;
    return { buffer: 0, byteOffset: view.offset + at - byteLength, byteLength };
  });
  if (at !== view.length) throw lengths.wrong(`${at} bytes of ${view.length}`);
  return streams;
}

/** Browsers know no preset dictionary: it goes before the deflated bytes as a block that is stored. */
async function inflateJson(deflated: ArrayBuffer, where: string): Promise<string> {
  const before = new TextEncoder().encode(DICTIONARY);
  const [low, high] = [before.length & 255, before.length >> 8];
  const whole = new Uint8Array(5 + before.length + deflated.byteLength);
  whole.set([0, low, high, ~low, ~high]);
  whole.set(before, 5);
  whole.set(new Uint8Array(deflated), 5 + before.length);
  const found = await inflated(whole, "deflate-raw", before.length + limits.MAX_JSON, where);
  try {
    return new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(found.subarray(before.length));
  } catch {
    throw damaged(where, "its JSON is not UTF-8");
  }
}
