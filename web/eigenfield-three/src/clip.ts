// A clip as its file has it: groups, films, and the first frame, which is there before anything plays.

import { asAvif } from "./av1-picture.js";
import { grownCodes } from "./film-codes.js";
import { FrameRing, type RingUser } from "./frame-ring.js";
import { Groups, setScales, type Group } from "./groups.js";
import type { SceneDocument } from "./document.js";
import type { DecodedMesh } from "./mesh-decoder.js";
import { decodeTenBits } from "./pictures-10bit.js";
import { closePieces, type Codes } from "./pieces.js";
import { Sound } from "./sound.js";
import type { Film, PlaceReader, Timeline } from "./timeline.js";

const FORMAT = { mimeType: "video/AV1", bits: 10 };

export interface Clip {
  timeline: Timeline;
  group: Group; // the first, as far as its first frame
  films: Codes[]; // of the first frame
  mesh: DecodedMesh; // of groups that have none of their own
  ring: (user: RingUser) => FrameRing;
  sound: ((changed: () => void) => Sound) | null; // null: it is silent
}

/** Decodes the first frame of a clip, once it is there. Raises SceneError. */
export async function openClip(
  scene: SceneDocument,
  timeline: Timeline,
  mesh: DecodedMesh,
  read: PlaceReader,
): Promise<Clip> {
  const groups = new Groups(scene, timeline, mesh, read);
  const group = await groups.begin();
  group.motion?.read(0);
  setScales(scene, group);
  const films = await Promise.all(timeline.films.map((film, i) => keyPicture(group.units[0]![i]!, film)));
  const { sound: place } = timeline;
  const sound = place && ((changed: () => void) => new Sound(place, () => read(place, place.length), changed));
  return { timeline, group, films, mesh, ring: (user) => new FrameRing(timeline, groups, user), sound };
}

/** The codes of the first unit of a group, which is a picture by itself: no decoder of videos is needed for it. */
async function keyPicture(unit: Uint8Array, { size, where }: Film): Promise<Codes> {
  const picture = { view: -1, codec: FORMAT, textures: 1, pieces: 1, where };
  const pieces = await decodeTenBits(asAvif(unit.slice().buffer, where), picture, size);
  const found = pieces[0]!.picture;
  if ("data" in found) return found;
  const context = new OffscreenCanvas(...size).getContext("2d")!;
  context.drawImage(found, 0, 0);
  closePieces(pieces);
  return grownCodes(context.getImageData(0, 0, ...size).data, 4 * size[0], 4, size);
}
