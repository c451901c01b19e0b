// What pictures decode to: pieces, each a whole texture of R, G and B or one channel of a texture.

/** What the header of a picture must say. */
export interface PictureFormat {
  mimeType: string;
  bits: number; // of a code
}

/** A picture in the file. */
export interface PictureFile {
  view: number;
  codec: PictureFormat;
  textures: number; // one below the other
  pieces: number; // of each texture: one of R, G and B, or its channels, one below the other
  where: string;
}

/** Codes of two bytes each, the lower first, in rows of `stride` bytes. */
export interface Codes {
  data: Uint8Array;
  width: number;
  height: number;
  stride: number;
  grown?: boolean; // made of eight bits
  room?: Uint8Array<ArrayBuffer>; // that holds them, and may take others when they are needed no more
}

/** Part of a picture: `rows` of it from `row`. */
export interface Piece<Kind extends ImageBitmap | Codes = ImageBitmap | Codes> {
  picture: Kind;
  row: number;
  rows: number;
}

/**
 * Decodes a picture into its pieces, in their order. `size`: of a texture, where it is announced. Whoever takes the pieces closes them. Raises SceneError: `damaged`, `codec`.
 */
export type PictureDecoder<Kind extends ImageBitmap | Codes = ImageBitmap | Codes> = (
  bytes: ArrayBuffer,
  picture: PictureFile,
  size: [number, number] | null,
) => Promise<Piece<Kind>[]>;

export function closePieces(pieces: Piece[]): void {
  for (const { picture } of pieces) if ("close" in picture) picture.close();
}
