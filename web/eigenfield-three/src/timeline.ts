// When the frames of a clip are shown, in which groups they are coded, and where their textures lie in films, checked.

import { codecOf, type Codec } from "./codecs.js";
import { damaged } from "./errors.js";
import type { Value } from "./json.js";
import * as limits from "./limits.js";
import type { Picture, Plane } from "./planes.js";
import type { AudioJson, FilmJson, GroupJson, TimelineJson } from "./schema.js";

const FILM_STEP = 64; // sides of films are multiples of it
const PLACE_STEP = 16; // columns and rows at which textures begin
const OPUS = "audio/ogg";
const SOUND_FILE = "sound.opus";
const DIGEST = /^[0-9a-f]{64}$/;

/** A grey video in which textures lie side by side. */
export interface Film {
  codec: Codec<"film">;
  size: [number, number];
  opacity: boolean; // of sheets: codes 0 and 1023 are nothing and all; of others only 64 to 940 are used
  detail: boolean; // it holds eigen textures alone, without which there is something to show
  where: string;
}

/** Bytes in the chunk of groups, or of a file beside the clip's. */
export interface BytePlace {
  offset: number;
  length: number;
  file: string | null; // its name; null: the chunk
}

/** The first `length` bytes of a place, once they are there. Rejects with a SceneError. */
export type PlaceReader = (place: BytePlace, length: number) => Promise<ArrayBuffer>;

/** Frames that are decoded by themselves. */
export interface GroupPlace extends BytePlace {
  first: number; // frame
  frames: number;
  sha256: string;
  where: string;
}

/** The sound of a clip. */
export interface SoundPlace extends BytePlace {
  mimeType: string;
  first: number; // seconds, of its beginning
}

export interface Timeline {
  rate: number; // frames a second
  first: number; // seconds
  frames: number;
  films: Film[];
  groups: GroupPlace[];
  sound: SoundPlace | null;
}

/** The timeline of a clip; null: a scene of one instant. `opacity`: of sheets. Raises SceneError: `damaged`,
 * `codec-unknown`. */
export function readTimeline(
  value: Value<TimelineJson>,
  planes: Plane[],
  opacity: Picture | null,
): Timeline | null {
  const pictures = [...picturesOf(planes), ...(opacity ? [opacity] : [])];
  if (!value.exists) {
    const inFilm = pictures.find(({ part }) => part);
    if (inFilm) throw damaged(inFilm.where, "a texture in a film, and no timeline");
    return null;
  }
  const [numerator = 1, denominator = 1] = value.key("rate").numbers(2, 1, limits.MAX_RATE_TERM);
  const rate = numerator / denominator;
  const whole = Number.isInteger(numerator) && Number.isInteger(denominator);
  if (!whole || rate > limits.MAX_RATE || rate < 1 / limits.MAX_RATE) throw value.key("rate").wrong("no rate");
  const first = value.key("first");
  const films = value.key("films").items(limits.MAX_FILMS).map(readFilm);
  const frames = value.key("frames").integer(1, limits.MAX_FRAMES);
  checkPlaces(pictures, films);
  const needed = new Set([...planes.map(({ mean }) => mean), opacity].map((one) => films[one?.part?.film ?? -1]));
  for (const film of films) {
    film.opacity = film === films[opacity?.part?.film ?? -1];
    film.detail = !needed.has(film);
  }
  const groups = readGroups(value, frames);
  return { rate, first: first.exists ? first.number() : 0, frames, films, groups, sound: readSound(value, groups) };
}

function readSound(value: Value<TimelineJson>, groups: GroupPlace[]): SoundPlace | null {
  const sound = value.key("audio") as Value<AudioJson>;
  if (!sound.exists) return null;
  if (sound.key("mimeType").text(64) !== OPUS) throw sound.key("mimeType").wrong(`no ${OPUS}`);
  const last = groups.at(-1)!;
  const file = last.file === null ? null : SOUND_FILE;
  const offset = file ? 0 : offsetOf(sound.key("offset"), last.offset + last.length);
  const first = sound.key("first");
  const length = sound.key("length").integer(1, limits.MAX_AUDIO);
  return { mimeType: OPUS, first: first.exists ? first.number() : 0, offset, length, file };
}

function readFilm(value: Value<FilmJson>): Film {
  const codec = codecOf("film", value.key("codec"), "film-1");
  const [width = 0, height = 0] = value.key("size").numbers(2, FILM_STEP, limits.MAX_FILM_SIDE);
  if (width % FILM_STEP || height % FILM_STEP || width * height > limits.MAX_FILM_PIXELS) {
    throw value.key("size").wrong(`a film of ${width} x ${height}`);
  }
  return { codec, size: [width, height], opacity: false, detail: false, where: value.where };
}

function offsetOf(value: Value<number>, least: number): number {
  const offset = value.integer(least, Number.MAX_SAFE_INTEGER);
  if (offset % 4) throw value.wrong("no multiple of 4");
  return offset;
}

function readGroups(value: Value<TimelineJson>, frames: number): GroupPlace[] {
  let [first, end] = [0, 0];
  const files = value.key("groupFiles");
  if (files.exists && files.raw !== true) throw files.wrong("not true");
  const groups = value.key("groups").items(limits.MAX_GROUPS).map((group: Value<GroupJson>, i): GroupPlace => {
    const file = files.exists ? `groups/${String(i).padStart(5, "0")}.eftg` : null;
    const count = group.key("frames").integer(1, limits.MAX_GROUP_FRAMES);
    const length = group.key("length").integer(1, limits.MAX_GROUP);
    const offset = file ? 0 : offsetOf(group.key("offset"), end);
    const sha256 = group.key("sha256").text(64);
    if (!DIGEST.test(sha256)) throw group.key("sha256").wrong("no SHA-256");
    [first, end] = [first + count, offset + length];
    return { first: first - count, frames: count, offset, length, file, sha256, where: group.where };
  });
  if (first !== frames) throw value.key("groups").wrong(`${first} frames in groups, and ${frames} in all`);
  return groups;
}

function picturesOf(planes: Plane[]): Picture[] {
  return planes.flatMap(({ mean, bases }) => [mean, ...bases.flatMap((basis) => basis.pictures)]);
}

/** Raises SceneError `damaged` unless all textures lie in films, each in a place of its own. */
function checkPlaces(pictures: Picture[], films: Film[]): void {
  const taken = films.map(({ size }) => new Uint8Array((size[0] * size[1]) / PLACE_STEP ** 2));
  for (const { part, where } of pictures) {
    const film = part && films[part.film];
    if (!part || !film) throw damaged(where, "it lies in no film");
    const [columns, cells] = [film.size[0] / PLACE_STEP, taken[part.film]!];
    const [width, height] = part.size.map((side) => Math.ceil(side / PLACE_STEP)) as [number, number];
    for (const [left, top] of part.at) {
      const inside = left + part.size[0] <= film.size[0] && top + part.size[1] <= film.size[1];
      if (left % PLACE_STEP || top % PLACE_STEP || !inside) throw damaged(where, `a texture at ${left}, ${top} of its film`);
      for (let row = top / PLACE_STEP; row < top / PLACE_STEP + height; row++) {
        const own = cells.subarray(row * columns + left / PLACE_STEP, row * columns + left / PLACE_STEP + width);
        if (own.includes(1)) throw damaged(where, `two textures at ${left}, ${top} of a film`);
        own.fill(1);
      }
    }
  }
}

/** The number of the frame that is nearest to a time in seconds, within the clip. */
export function frameAt({ rate, first, frames }: Timeline, seconds: number): number {
  return Math.min(Math.max(Math.floor((seconds - first) * rate + 0.5), 0), frames - 1);
}

export function timeOf({ rate, first }: Timeline, frame: number): number {
  return first + frame / rate;
}

/** The index of the group that has a frame. */
export function groupOf({ groups }: Timeline, frame: number): number {
  let [low, high] = [0, groups.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if ((groups[middle]?.first ?? Infinity) <= frame) low = middle;
    else high = middle - 1;
  }
  return low;
}
