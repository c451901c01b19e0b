// What fills the textures of a field: the pictures of a scene, by rank, or those of a film, frame by frame.

import type { Mean } from "./means.js";
import type { Plan } from "./memory.js";
import type { Piece } from "./pieces.js";
import type { Picture } from "./planes.js";

/** Textures on a GPU, to be filled, and filled again. What is put is drawn from the next draw on. */
export interface Filling {
  readonly plan: Plan;
  /** Aborted when these textures are gone: the context is lost, another renderer has the field, or it has ended. From
   * then on nothing is put. */
  readonly signal: AbortSignal;
  /** The mean of a plane, or after those of all planes the opacity. Whoever calls closes it. */
  putMean(index: number, mean: Mean): void;
  /** The textures of a picture, from `first` of basis `basis`, counted over all planes. Whoever calls closes them. */
  putTextures(basis: number, first: number, pieces: Piece[], picture: Picture): void;
  /** Tells whoever draws on demand that there is more to draw. */
  announce(): void;
  /** Nothing more will be put: frees what that takes. */
  end(): void;
}

export interface TextureSource {
  /** Fills textures that have just been made; called again for those that take their place. What is put before the
   * first `await` is in the first picture. Resolves when each texture has been put once. Raises SceneError. */
  fill(filling: Filling): Promise<void>;
  /** The factor that makes eigen texture `rank` visible when it is shown alone. */
  gain(rank: number): Promise<number>;
  dispose(): void;
}
