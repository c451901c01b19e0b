// Generated from docs/schema/EIGENFIELD_eigen_textures.schema.json
// by `npm run schema` in web/: change the schema, not this file.

import type { JsonObject } from "./json.js";

/** A light field as eigen textures: planes, cameras and weights. Unknown keys are allowed everywhere. */
export interface SceneJson {
  /** The first version of the format that has everything the file uses. */
  version: string;
  /** Features without which drawing would be wrong. */
  needs?: Feature[];
  /** The proxy, coded. */
  mesh?: CodedMeshJson;
  /** Parts of the proxy that are drawn one over the other, and their opacity. */
  sheets?: SheetsJson;
  /** Channels that share a mean and bases. */
  planes: PlaneJson[];
  /** The matrix from the channels of all planes to R, G and B, row by row. */
  toRGB?: number[];
  /** Every camera of the capture. */
  cameras: CamerasJson;
  /** The least-squares plane through the camera centres. */
  viewPlane: ViewPlaneJson;
  /** Index of the reference camera. */
  reference: number;
  /** Photographs of the encoded cameras minus what is drawn of them. */
  residual?: ResidualJson;
  /** When the frames of a clip are shown, the films that their textures lie in, and their groups. */
  timeline?: TimelineJson;
  /** How the scene was made. Free form, but for the keys named here. */
  settings?: JsonObject;
  /** What the scene's pictures were measured at. Free form. */
  scores?: JsonObject;
  /** Program and version that made the scene. */
  generator?: string;
}

/** The root extension of a packed file; what it holds is then as this schema says. */
export interface PackedJson {
  version: string;
  /** More is in what is packed. */
  needs: "packed"[];
  /** Index of a buffer view. */
  packed: number;
}

/** What `needs` may name. */
export type Feature =
  | "av1-10bit-2"
  | "bits"
  | "cameras-2"
  | "codedCameras"
  | "codedMesh"
  | "codedNames"
  | "codedTriangles"
  | "codedWeights"
  | "film-1"
  | "mesh-2"
  | "motion-1"
  | "groupFiles"
  | "namePattern"
  | "noFallback"
  | "packed"
  | "precision"
  | "regions"
  | "sharedPicture"
  | "sheets"
  | "stacks"
  | "timeline"
  | "toRGB";

/** Codecs of a mesh. */
export type MeshCodec = "mesh-1" | "mesh-2";

/** Codecs of intrinsics and poses. */
export type CamerasCodec = "cameras-1" | "cameras-2";

/** Codecs of the cameras' names. */
export type NamesCodec = "names-1";

/** Codecs of the view plane's triangles. */
export type TrianglesCodec = "triangles-1";

/** Codecs of weights. */
export type WeightsCodec = "weights-1";

/** Codecs of pictures. */
export type PictureCodec = "av1-10bit-1" | "av1-10bit-2" | "avif" | "webp" | "png" | "jpeg";

/** Codecs of films. */
export type FilmCodec = "film-1";

/** Codecs of the motion of a mesh. */
export type MotionCodec = "motion-1";

/** Codecs of a residual. */
export type VideoCodec = "video-1";

/** The proxy, coded. */
export interface CodedMeshJson {
  /** Index of a buffer view. */
  bufferView: number;
  /** Codecs of a mesh. */
  codec?: MeshCodec;
}

/** Parts of the proxy that are drawn one over the other, and their opacity. */
export interface SheetsJson {
  /** Triangles of each sheet, back to front; the proxy has them in this order. */
  faces: number[];
  /** A picture of one channel over the whole atlas, or its place in a film; the largest code is opaque. */
  opacity: OpacityJson;
}

/** A picture of one channel over the whole atlas, or its place in a film; the largest code is opaque. */
export interface OpacityJson {
  /** Index of a buffer view. */
  bufferView?: number;
  /** Number of a film. */
  film?: number;
  /** Column and row in the film of each channel of each texture, by rank. */
  at?: ([number, number])[];
  /** Codecs of pictures. */
  codec?: PictureCodec;
  /** Type of a picture. */
  mimeType?: MimeType;
  /** Width and height in texels. */
  size: [number, number];
  /** Bits of a sample. */
  bits?: Bits;
}

/** Channels that share a mean and bases. */
export interface PlaneJson {
  /** Channels of the mean and of each texture. */
  channels: number;
  /** The picture of a mean, or where it lies in a film. */
  mean?: MeanJson;
  /** Summed onto the mean, one after the other. */
  bases: BasisJson[];
}

/** Eigen textures of one size, and the weights that the encoded cameras give them. */
export interface BasisJson {
  /** Width and height in texels. */
  size: [number, number];
  /** Number of a film. */
  film?: number;
  /** Column and row in the film of each channel of each texture, by rank. */
  at?: ([number, number])[];
  /** Texels of the whole atlas at this basis's density. */
  grid?: [number, number];
  /** Column and row of the grid at which the textures begin. */
  corner?: [number, number];
  /** Pictures of eigen textures, by rank. */
  textures?: TextureJson[];
  /** What each entry of `textures` says unless it says otherwise. */
  picture?: TextureJson;
  /** Accessor: one number for each encoded camera and texture, row by row. */
  weights?: number;
  /** The weights, coded. */
  codedWeights?: number | CodedWeightsJson;
}

/** A stream of weights. */
export interface CodedWeightsJson {
  /** Index of a buffer view. */
  bufferView: number;
  /** Codecs of weights. */
  codec?: WeightsCodec;
}

/** A picture of one or several eigen textures. */
export interface TextureJson {
  /** Index of a buffer view. */
  bufferView?: number;
  /** Codecs of pictures. */
  codec?: PictureCodec;
  /** Type of a picture. */
  mimeType?: MimeType;
  /** Bits of a sample. */
  bits?: Bits;
  /** Textures in it, one below the other. */
  count?: number;
  /** One number for each channel of each texture, or one for each channel. */
  scale?: number[];
  /** One number for each channel of each texture, or one for each channel. */
  zero?: number[];
}

/** The picture of a mean, or where it lies in a film. */
export interface MeanJson {
  /** Index of a buffer view. */
  bufferView?: number;
  /** Number of a film. */
  film?: number;
  /** Column and row in the film of each channel of each texture, by rank. */
  at?: ([number, number])[];
  /** Codecs of pictures. */
  codec?: PictureCodec;
  /** Type of a picture. */
  mimeType?: MimeType;
  /** Width and height in texels. */
  size: [number, number];
  /** Bits of a sample. */
  bits?: Bits;
  /** One number for each channel of each texture, or one for each channel. */
  scale?: number[];
  /** One number for each channel of each texture, or one for each channel. */
  zero?: number[];
  /** How finely each place of a mean is coded: a grey PNG. */
  precision?: PrecisionJson;
}

/** Type of a picture. */
export type MimeType = "image/png" | "image/jpeg" | "image/webp" | "image/avif" | "video/AV1";

/** Bits of a sample. */
export type Bits = 8 | 10;

/** How finely each place of a mean is coded: a grey PNG. */
export interface PrecisionJson {
  /** Index of a buffer view. */
  bufferView: number;
  codec?: "png";
  /** Width and height in texels. */
  size: [number, number];
}

/** Every camera of the capture. */
export interface CamerasJson {
  /** Names, each unlike the others. */
  names?: string[];
  /** Names that lie in rows and columns. */
  pattern?: PatternJson;
  /** A stream of the cameras' names. */
  codedNames?: CodedNamesJson;
  /** Cameras that took no part in mean, textures and weights. */
  heldOut?: number[];
  /** Intrinsics and poses, coded. */
  coded?: number | CodedCamerasJson;
  /** Accessor: fx, fy, skew, cx, cy of each camera, in pixels. */
  intrinsics?: number;
  /** Accessor: the matrix [R t] of each camera, row by row. */
  poses?: number;
  /** Accessor: width and height of each photograph, in pixels. */
  sizes?: number;
  /** Width and height of each photograph, in pixels. */
  size?: [number, number];
  /** Accessor: gain of R, G, B and offset of R, G, B of each camera. */
  colour?: number;
  /** The same of each encoded camera, coded as weights; views between the cameras mix them. */
  codedColour?: number | CodedWeightsJson;
}

/** A stream of intrinsics and poses. */
export interface CodedCamerasJson {
  /** Index of a buffer view. */
  bufferView: number;
  /** Codecs of intrinsics and poses. */
  codec?: CamerasCodec;
}

/** A stream of the cameras' names. */
export interface CodedNamesJson {
  /** Index of a buffer view. */
  bufferView: number;
  /** Codecs of the cameras' names. */
  codec?: NamesCodec;
  /** Names in it. */
  count: number;
}

/** Names that lie in rows and columns. */
export interface PatternJson {
  /** Rows and columns. */
  counts: [number, number];
  /** A name is its parts, one after the other. */
  parts: (string | PatternPartJson)[];
}

/** Texts that differ along one axis. */
export interface PatternPartJson {
  /** 0 for rows, 1 for columns. */
  axis: 0 | 1;
  /** One text for each row or column. */
  texts?: string[];
  /** Number of row or column 0. */
  first?: number;
  /** What each row or column adds to the number. */
  step?: number;
  /** Digits to which zeros in front fill a number up. */
  digits?: number;
}

/** The least-squares plane through the camera centres. */
export interface ViewPlaneJson {
  /** World point at X = Y = 0. */
  origin: [number, number, number];
  /** World direction of X, of length 1. */
  right: [number, number, number];
  /** World direction of Y, of length 1. */
  up: [number, number, number];
  /** Half the width and height of the cameras' bounding box, in world units. */
  extent: [number, number];
  /** Accessor: three encoded cameras for each triangle. */
  triangles?: number;
  /** The triangles, coded. */
  codedTriangles?: number | CodedTrianglesJson;
}

/** A stream of triangles. */
export interface CodedTrianglesJson {
  /** Index of a buffer view. */
  bufferView: number;
  /** Codecs of the view plane's triangles. */
  codec?: TrianglesCodec;
}

/** Photographs of the encoded cameras minus what is drawn of them. */
export interface ResidualJson {
  /** Index of a buffer view. */
  bufferView: number;
  /** Codecs of a residual. */
  codec?: VideoCodec;
  /** Width and height of a frame, in pixels. */
  size: [number, number];
  /** Whether chroma is as fine as luma. */
  full?: boolean;
  /** Accessor: the encoded cameras in the order of the frames. */
  order?: number;
  /** What a code of luma stands for, and what one of chroma. */
  scale: [number, number];
  /** Whether the surface is drawn with smooth edges. */
  smooth?: boolean;
}

/** When the frames of a clip are shown, the films that their textures lie in, and their groups. */
export interface TimelineJson {
  /** Frames a second, a fraction of two whole numbers. */
  rate: [number, number];
  /** When the first frame is shown, in seconds. */
  first?: number;
  /** Frames of all groups. */
  frames: number;
  /** Films, which are the same in all groups. */
  films: FilmJson[];
  /** Groups in the order of time. */
  groups: GroupJson[];
  /** The sound of a clip, which lies in the chunk of groups behind the last of them, or in a file. */
  audio?: AudioJson;
  /** Groups and sound are files beside the scene's, and have no offset. */
  groupFiles?: true;
}

/** The sound of a clip, which lies in the chunk of groups behind the last of them, or in a file. */
export interface AudioJson {
  /** Opus in Ogg. */
  mimeType: "audio/ogg";
  /** When it begins, in seconds. */
  first?: number;
  /** Its first byte in the chunk; absent where groups are files. */
  offset?: number;
  /** Its bytes. */
  length: number;
}

/** A grey video in which textures lie side by side. */
export interface FilmJson {
  /** Codecs of films. */
  codec: FilmCodec;
  /** Width and height in pixels. */
  size: [number, number];
}

/** Frames that are decoded by themselves, and their bytes in the chunk of groups or in a file. */
export interface GroupJson {
  /** Frames in it. */
  frames: number;
  /** Its first byte in the chunk; absent where groups are files. */
  offset?: number;
  /** Its bytes. */
  length: number;
  /** Digest of its bytes. */
  sha256: string;
}

/** The JSON at the beginning of a group: lengths of its streams, and what its codes stand for. */
export interface GroupHeadJson {
  /** Bytes of the coded weights of each basis of each plane. */
  weights: number[][];
  /** What the codes of the mean of each plane stand for. */
  means: AffineJson[];
  /** What the codes of each basis of each plane stand for. */
  bases: AffineJson[][];
  /** For each frame the bytes of each film's unit. */
  frames: number[][];
  /** Bytes of the group's mesh, as mesh-2 codes it. Absent: the group has the mesh of the file. */
  mesh?: number;
  /** Bytes of the motion of the mesh's vertices. Absent: they stand still. */
  motion?: number;
}

/** value = (code - zero) * scale. */
export interface AffineJson {
  /** One number for each channel of each texture, or one for each channel. */
  scale: number[];
  /** One number for each channel of each texture, or one for each channel. */
  zero: number[];
}
