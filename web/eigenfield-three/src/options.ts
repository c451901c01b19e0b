import type { WebGLRenderer } from "three";
import type { Filter } from "./material.js";

/** Where the binary chunk comes from while the file still arrives. */
export interface ByteStream {
  /** Bytes of the whole file. */
  readonly total: number;
  /** `length` bytes from `offset` of the binary chunk, once they are there. Rejects with a SceneError. */
  read(offset: number, length: number): Promise<ArrayBuffer>;
  /** The same of the chunk that has the groups of a clip; without it a clip is shown as other viewers show it. */
  readGroups?(offset: number, length: number): Promise<ArrayBuffer>;
  /** The first `length` bytes of a file of `size` bytes in the folder of a clip, whose groups are such files. */
  readFile?(name: string, size: number, length: number): Promise<ArrayBuffer>;
}

export interface EigenfieldOptions {
  /** Whose GPU takes the textures; else the first one that draws the scene. */
  renderer?: WebGLRenderer | undefined;
  /** GPU bytes that may be used; else `defaultMemory()`. */
  memory?: number | undefined;
  /** How the texture is read where pixels are no larger than the photographs' own: Catmull-Rom (`bicubic`, the
   * default), or what the GPU does. */
  filter?: Filter | undefined;
  stream?: ByteStream | undefined;
}
