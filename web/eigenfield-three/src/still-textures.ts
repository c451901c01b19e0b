// The textures of a scene from its file: the means first, then eigen textures by rank. Compressed pictures stay in
// memory, decoded ones do not, and are decoded again when a lost context comes back.

import type { ViewBytes } from "./accessors.js";
import { stillsOf, type SceneDocument } from "./document.js";
import { basesOf } from "./info.js";
import { closeMean, decodeMean, type Mean } from "./means.js";
import { closePieces, type Piece } from "./pieces.js";
import type { Basis, Picture } from "./planes.js";
import { eigenGain } from "./strength.js";
import type { TextureSource } from "./texture-source.js";

const AHEAD = 3; // pictures decoded at a time

/** A picture of eigen textures: those from `first` of basis `number`. */
interface Entry {
  basis: Basis;
  number: number;
  picture: Picture;
  first: number;
}

function byRank(scene: SceneDocument): Entry[] {
  const entries = basesOf(scene).flatMap((basis, number) => {
    let next = 0;
    return basis.pictures.map((picture) => {
      const first = next;
      next += picture.textures;
      return { basis, number, picture, first };
    });
  });
  return entries.sort((a, b) => a.first - b.first || a.number - b.number);
}

/** `means`: of each plane, and of the opacity, which are decoded already; the source closes them. */
export function stillTextures(scene: SceneDocument, bytes: ViewBytes, means: Mean[]): TextureSource {
  const entries = byRank(scene);
  let decoded: Mean[] | null = means; // until they are on the GPU

  const decode = ({ basis, picture }: Entry): Promise<Piece[]> => {
    const pieces = bytes(picture.view).then((data) => picture.codec.decode(data, picture, basis.size));
    pieces.catch(() => undefined); // awaited later, or not at all
    return pieces;
  };

  return {
    async fill(filling) {
      const { plan, signal } = filling;
      const now = decoded ?? (await Promise.all(stillsOf(scene).map((still) => decodeMean(still, bytes))));
      decoded = null;
      now.forEach((mean, i) => {
        filling.putMean(i, mean);
        closeMean(mean);
      });
      const wanted = entries.filter(({ first }) => first < plan.usable);
      const queue: Promise<Piece[]>[] = [];
      let next = 0;
      try {
        for (const { number, first, picture } of wanted) {
          if (signal.aborted) return;
          for (const entry of wanted.slice(next, next + AHEAD - queue.length)) {
            queue.push(decode(entry));
            next += 1;
          }
          const pieces = (await queue[0]) ?? [];
          queue.shift();
          filling.putTextures(number, first, pieces, picture);
          closePieces(pieces);
          filling.announce();
        }
      } finally {
        for (const left of queue) left.then(closePieces).catch(() => undefined);
      }
      filling.end();
    },

    gain(rank) {
      let channel = 0;
      for (const { channels, bases } of scene.planes) {
        const colours = scene.colours.slice(channel, (channel += channels));
        const basis = bases.find(({ count }) => count > rank);
        if (basis) return eigenGain(basis, rank, colours, bytes);
      }
      return Promise.resolve(1);
    },

    dispose() {
      decoded?.forEach(closeMean);
      decoded = null;
    },
  };
}
