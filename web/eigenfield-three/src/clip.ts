// A clip as its file has it: groups, films, and the first frame, which is there before anything plays.

import { keyPicture } from "./film-pictures.js";
import { FrameRing, type RingUser } from "./frame-ring.js";
import { Groups, setScales, type Group } from "./groups.js";
import type { SceneDocument } from "./document.js";
import type { DecodedMesh } from "./mesh-decoder.js";
import type { Codes } from "./pieces.js";
import { Sound } from "./sound.js";
import type { PlaceReader, Timeline } from "./timeline.js";

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
  const films = await Promise.all(timeline.films.map(({ size, where }, i) => keyPicture(group.units[0]![i]!, size, where)));
  const { sound: place } = timeline;
  const sound = place && ((changed: () => void) => new Sound(place, () => read(place, place.length), changed));
  return { timeline, group, films, mesh, ring: (user) => new FrameRing(timeline, groups, user), sound };
}
