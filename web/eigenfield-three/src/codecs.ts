// How each kind of stream may be coded: docs/coding.md. A new codec is a decoder, an entry here, and its name in the
// schema. The compiler wants an entry for each name there.

import { asAvif } from "./av1-picture.js";
import { decodeCameras, inflateCameras, type CodedCameras } from "./camera-decoder.js";
import { SceneError } from "./errors.js";
import { FilmDecoder } from "./film-decoder.js";
import type { Value } from "./json.js";
import * as limits from "./limits.js";
import { decodeMesh, decodeOldMesh, type DecodedMesh } from "./mesh-decoder.js";
import { Motion } from "./mesh-motion.js";
import { decodeNames } from "./name-decoder.js";
import { decodeTenBits } from "./pictures-10bit.js";
import { decodeBitmaps } from "./pictures-8bit.js";
import type { PictureDecoder, PictureFormat } from "./pieces.js";
import type * as schema from "./schema.js";
import { decodeTriangles, type CodedTriangles } from "./triangle-decoder.js";
import { decodeWeights, type CodedWeights } from "./weight-decoder.js";

/** What decodes each kind of stream; `where` is the place that a SceneError names. */
interface Decoders {
  mesh: (bytes: Uint8Array, where: string) => DecodedMesh;
  cameras: (bytes: Uint8Array, where: string) => CodedCameras | Promise<CodedCameras>;
  names: (bytes: Uint8Array, count: number, where: string) => Promise<string[]>;
  triangles: (bytes: Uint8Array, where: string) => CodedTriangles;
  weights: (bytes: Uint8Array, where: string) => CodedWeights;
  picture: PictureDecoder;
  film: (...given: ConstructorParameters<typeof FilmDecoder>) => FilmDecoder;
  motion: (...given: ConstructorParameters<typeof Motion>) => Motion;
}

interface Names {
  mesh: schema.MeshCodec;
  cameras: schema.CamerasCodec;
  names: schema.NamesCodec;
  triangles: schema.TrianglesCodec;
  weights: schema.WeightsCodec;
  picture: schema.PictureCodec;
  film: schema.FilmCodec;
  motion: schema.MotionCodec;
}

export type Kind = keyof Decoders;

interface StreamCodec<K extends Kind> {
  kind: K;
  decode: Decoders[K];
  needs: schema.Feature | null; // what a file that uses it names in `needs`; null: readers of 1.0 know it
  limits: (keyof typeof limits & `MAX_${string}`)[]; // what it checks before it takes memory
}

interface BitmapCodec extends StreamCodec<"picture">, PictureFormat {
  mimeType: schema.MimeType;
  bits: schema.Bits;
  bitmaps: typeof decodeBitmaps; // as `decode`, in eight bits
}

export type Codec<K extends Kind> = K extends "picture" ? BitmapCodec : StreamCodec<K>;

function eightBits(mimeType: schema.MimeType): BitmapCodec {
  const [decode, bitmaps] = [decodeBitmaps, decodeBitmaps];
  const limits: BitmapCodec["limits"] = ["MAX_SIDE", "MAX_STACKED", "MAX_TEXELS"];
  return { kind: "picture", decode, bitmaps, needs: null, limits, mimeType, bits: 8 };
}

/** Every codec but those of a residual, which this plug-in does not draw. */
export const CODECS: { readonly [K in Kind as Names[K]]: Codec<K> } = {
  "mesh-1": { kind: "mesh", decode: decodeOldMesh, needs: "codedMesh", limits: ["MAX_VERTICES", "MAX_TRIANGLES"] },
  "mesh-2": { kind: "mesh", decode: decodeMesh, needs: "mesh-2", limits: ["MAX_VERTICES", "MAX_TRIANGLES"] },
  "cameras-1": { kind: "cameras", decode: decodeCameras, needs: "codedCameras", limits: ["MAX_CAMERAS"] },
  "cameras-2": { kind: "cameras", decode: inflateCameras, needs: "cameras-2", limits: ["MAX_CAMERAS"] },
  "names-1": { kind: "names", decode: decodeNames, needs: "codedNames", limits: ["MAX_NAMES", "MAX_CAMERAS"] },
  "triangles-1": { kind: "triangles", decode: decodeTriangles, needs: "codedTriangles", limits: ["MAX_CAMERAS"] },
  "weights-1": { kind: "weights", decode: decodeWeights, needs: "codedWeights", limits: ["MAX_WEIGHTS"] },
  "film-1": {
    kind: "film",
    decode: (...given) => new FilmDecoder(...given),
    needs: "film-1",
    limits: ["MAX_FILM_SIDE", "MAX_FILM_PIXELS"],
  },
  "motion-1": {
    kind: "motion",
    decode: (...given) => new Motion(...given),
    needs: "motion-1",
    limits: ["MAX_GROUP_FRAMES", "MAX_MOTION"],
  },
  png: eightBits("image/png"),
  webp: eightBits("image/webp"),
  avif: eightBits("image/avif"),
  jpeg: eightBits("image/jpeg"),
  "av1-10bit-1": { ...eightBits("image/avif"), bits: 10, decode: decodeTenBits, needs: "bits" },
  "av1-10bit-2": {
    ...eightBits("video/AV1"),
    bits: 10,
    decode: (bytes, picture, size) => decodeTenBits(asAvif(bytes, picture.where), picture, size),
    bitmaps: (bytes, picture, size) => decodeBitmaps(asAvif(bytes, picture.where), picture, size),
    needs: "av1-10bit-2",
  },
};

/** The codec of a stream that names none; that of a picture follows from its type. */
export const USUAL: { readonly [K in Exclude<Kind, "film" | "motion" | "picture">]: Names[K] } = {
  mesh: "mesh-1",
  cameras: "cameras-1",
  names: "names-1",
  triangles: "triangles-1",
  weights: "weights-1",
};

/** The codec that `named` names, or `usual` where nothing is named. Raises SceneError `codec-unknown`. */
export function codecOf<K extends Kind>(kind: K, named: Value, usual: Names[Kind]): Codec<K> {
  const name = named.exists ? named.text(limits.MAX_NAME) : usual;
  const codec = Object.hasOwn(CODECS, name) ? CODECS[name as Names[Kind]] : null;
  if (codec?.kind === kind) return codec as Codec<K>;
  const text = `A ${kind} stream has the codec "${name.slice(0, 60)}", which this viewer does not know`;
  throw new SceneError("codec-unknown", `${text}; take a newer viewer.`, named.where);
}

/** The name of the codec of pictures of this type and so many bits, or of any, if there is one. */
export function pictureCodec(mimeType: string, bits?: number): schema.PictureCodec | undefined {
  const names = Object.keys(CODECS) as Names[Kind][];
  const fits = (name: Names[Kind]): name is schema.PictureCodec => {
    const codec = CODECS[name];
    return codec.kind === "picture" && codec.mimeType === mimeType && (bits ?? codec.bits) === codec.bits;
  };
  return names.find(fits);
}
