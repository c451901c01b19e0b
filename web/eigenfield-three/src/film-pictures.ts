// The films of a clip where the browser decodes pictures of AV1 and no videos: the key picture of each group.

import { asAvif } from "./av1-picture.js";
import { drawnOf, grownCodes } from "./film-codes.js";
import type { FilmSource, FilmUser } from "./film-decoder.js";
import { decodeTenBits } from "./pictures-10bit.js";
import { closePieces, type Codes } from "./pieces.js";

const FORMAT = { mimeType: "video/AV1", bits: 10 };

/** The codes of the first unit of a group, which is a picture by itself: no decoder of videos is needed for it. Raises
 * SceneError: `damaged`, `codec`. */
export async function keyPicture(unit: Uint8Array, size: [number, number], where: string): Promise<Codes> {
  const picture = { view: -1, codec: FORMAT, textures: 1, pieces: 1, where };
  const pieces = await decodeTenBits(asAvif(unit.slice().buffer, where), picture, size);
  const found = pieces[0]!.picture;
  if ("data" in found) return found;
  const drawn = drawnOf(found, size)!;
  closePieces(pieces);
  return grownCodes(drawn, 4 * size[0], 4, size);
}

/** Of each group the first unit becomes a frame, and no other. */
export class FilmPictures implements FilmSource {
  private readonly decoding = new Set<Promise<void>>();
  private turn = 0; // of decoding: what belongs to one before is thrown away

  /** `size`: of its frames. */
  constructor(
    private readonly size: [number, number],
    private readonly where: string,
    private readonly user: FilmUser,
  ) {}

  readonly open = 0;

  get busy(): boolean {
    return this.decoding.size > 0;
  }

  get ready(): boolean {
    return this.decoding.size === 0;
  }

  start(): Promise<void> {
    return Promise.resolve();
  }

  decode(unit: Uint8Array, position: number, key: boolean): void {
    if (!key) return;
    const { turn } = this;
    const made = keyPicture(unit, this.size, this.where)
      .then((codes) => (turn === this.turn ? this.user.take(position, () => Promise.resolve(codes)) : undefined))
      .catch((reason: unknown) => {
        if (turn === this.turn) this.user.failed(reason);
      })
      .finally(() => {
        this.decoding.delete(made);
        this.user.closed();
      });
    this.decoding.add(made);
  }

  async flush(): Promise<void> {
    await Promise.all(this.decoding);
  }

  reset(): void {
    this.turn += 1;
  }

  dispose(): void {
    this.reset();
  }
}
