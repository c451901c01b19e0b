// The textures of a clip: those of the frame that is shown, which are put over those of the one before.

import { basesOf } from "./info.js";
import { stillsOf, type SceneDocument } from "./document.js";
import { partsOf } from "./film-codes.js";
import type { Codes, Piece } from "./pieces.js";
import type { Picture } from "./planes.js";
import { strengthOf } from "./strength.js";
import type { Filling, TextureSource } from "./texture-source.js";

export class FilmTextures implements TextureSource {
  private filling: Filling | null = null;

  /** `films`: of the first frame. */
  constructor(
    private readonly scene: SceneDocument,
    private films: (Codes | null)[],
  ) {}

  fill(filling: Filling): Promise<void> {
    this.filling = filling;
    this.put(filling);
    filling.announce();
    return Promise.resolve();
  }

  /** Puts another frame, of which films of eigen textures may be left out. Its codes have to stay as they are until the
   * next is put. */
  show(films: (Codes | null)[]): void {
    this.films = films;
    if (this.filling) this.put(this.filling);
  }

  gain(rank: number): Promise<number> {
    let channel = 0;
    for (const { channels, bases } of this.scene.planes) {
      const colours = this.scene.colours.slice(channel, (channel += channels));
      const picture = bases.find(({ count }) => count > rank)?.pictures[0];
      if (picture) return Promise.resolve(this.gainOf(picture, rank, colours));
    }
    return Promise.resolve(1);
  }

  dispose(): void {
    this.filling = null;
  }

  private put(filling: Filling): void {
    stillsOf(this.scene).forEach(({ mean }, i) => filling.putMean(i, { pieces: this.piecesOf(mean), precision: null }));
    basesOf(this.scene).forEach(({ pictures: [picture] }, i) => {
      const pieces = picture ? this.piecesOf(picture) : [];
      if (picture && pieces.length) filling.putTextures(i, 0, pieces, picture);
    });
  }

  private piecesOf({ part }: Picture): Piece[] {
    const film = part && this.films[part.film];
    if (!film) return [];
    return partsOf(film, part).map((picture): Piece => ({ picture, row: 0, rows: picture.height }));
  }

  private gainOf({ part, pieces, scale, zero }: Picture, rank: number, colours: [number, number, number][]): number {
    const film = part && this.films[part.film];
    if (!film) return 1;
    const values = partsOf(film, part).slice(pieces * rank, pieces * (rank + 1)).flatMap((codes, channel) => {
      const at = pieces * rank + channel;
      const colour = Math.max(...(colours[channel] ?? [0]).map(Math.abs)) * (scale[at] ?? 0);
      return sampled(codes).map((code) => Math.abs((code - (zero[at] ?? 0)) * colour));
    });
    return strengthOf(values);
  }
}

const SAMPLED = 8; // of so many codes along a row and a column one is looked at

function sampled({ data, width, height, stride }: Codes): number[] {
  const found: number[] = [];
  for (let row = 0; row < height; row += SAMPLED) {
    for (let column = 0; column < width; column += SAMPLED) {
      const at = row * stride + 2 * column;
      found.push(data[at]! + 256 * data[at + 1]!);
    }
  }
  return found;
}
