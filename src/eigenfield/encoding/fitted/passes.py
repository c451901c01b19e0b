"""One look at all photographs: what is drawn of them, and what the difference asks of mean, textures and weights.

What a renderer draws is the sum of mean and components in the finest atlas. Here each is drawn from its own grid, and
the drawn pictures are summed: nearly the same (Catmull-Rom once instead of twice for what is coarse) for a third of the
work, as no camera needs an atlas of its own. A look with a `Composer` draws as the renderers do.

Cameras are taken in batches, whatever the number of threads, and a batch's parts are summed in order: the same input
gives the same numbers.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.kernels import aim, distrust, draw, put_back, squares_of
from eigenfield.encoding.fitted.model import COLUMNS, Composer, Model, sum_up
from eigenfield.encoding.fitted.observations import Shots
from eigenfield.runtime.parallel import parallel_map, pieces

BATCH = 48  # cameras whose sums are in memory at a time: each batch reads and writes all textures once
PIECE = 12  # of them are one thread's task
PLUS, MINUS = np.float32(1), np.float32(-1)

Textures = list[NDArray[np.float32]]


@dataclass(frozen=True, eq=False)
class Look:
    """What a pass brings: sums over the cameras of G^T w (photograph - drawn), or of G^T w drawn.

    mean: as the model's. textures: for each block (n, C, rows, columns). weights: for each block (Ne, n).
    squares: (Ne,) of each camera, sum of m (photograph - drawn)^2, m being its mask. pixels: (Ne,), sum of m; both zero
    without photographs.
    """

    mean: NDArray[np.float32]
    textures: Textures
    weights: Textures
    squares: NDArray[np.float64]
    pixels: NDArray[np.float64]


def look(
    shots: Shots,
    model: Model,
    *,
    mean: NDArray[np.float32] | None,
    textures: Textures | None,
    weights: Textures,
    photographs: bool,
    wanted: tuple[bool, bool, bool],
    composer: Composer | None = None,
    half: float | None = None,
) -> Look:
    """Draw every camera from a mean and textures (None: nothing) with weights, which need not be the model's own.

    photographs: whether they are compared with (the residual goes back), or what is drawn goes back itself. wanted:
    which of mean, textures and weights to bring; the textures asked of go with the model's weights, the weights with
    its textures. composer: draw exactly as the renderers do, mean and textures both given. half: from here on
    pixels of `doubtable` shots count for less the farther they are off (`kernels.distrust`); None: as before.
    """
    for_mean, for_textures, for_weights = wanted
    blocks, size = model.blocks, shots.surface.size
    found = [np.zeros_like(block.textures) for block in blocks] if for_textures else []
    asked = [np.zeros((len(shots), block.count), np.float32) for block in blocks] if for_weights else []
    squares, pixels = np.zeros(len(shots)), np.zeros(len(shots))
    coarse = any(block.count for block in blocks)
    for_coarse = coarse and (for_textures or for_weights)
    matrix, sign = (model.matrix / np.float32(255)).astype(np.float32), MINUS if photographs else PLUS
    fine_mean = composer.fine_mean(mean) if composer is not None and mean is not None else None
    # All batches share their arrays: memory given back and asked for anew costs more than what is done with it
    batch = min(BATCH, len(shots))
    room = np.empty((2, batch, model.channels, *model.grid), np.float32)  # pages not written to take no memory
    product = np.empty((max((block.count for block in blocks), default=0), COLUMNS), np.float32)
    shares = np.zeros((len(pieces(batch, PIECE)), *(model.mean.shape if for_mean else (0, 0, 0))), np.float32)
    for first, last in pieces(len(shots), BATCH):
        some = slice(first, last)
        sums, back = None, room[1, : last - first]
        if coarse and textures is not None:
            sums = room[0, : last - first]
            sum_up(model, textures, [rows[some] for rows in weights], sums)

        def piece(
            part: tuple[int, int],
            first: int = first,
            sums: NDArray[np.float32] | None = sums,
            back: NDArray[np.float32] = back,
        ) -> None:
            added = shares[part[0] // PIECE]
            for at in range(*part):
                index = first + at
                places, weight = shots.places(index), shots.weight(index)
                image = np.zeros((model.channels, *shots.shapes[index]), np.float32)
                if photographs:
                    aim(places[0], shots.photograph(index), matrix, image)
                if composer is not None and fine_mean is not None:
                    texture = fine_mean
                    if sums is not None:
                        texture = np.zeros_like(fine_mean)
                        composer.grid.up(sums[at], texture, fine_mean)
                    draw(*places, size, texture, sign, image)
                else:
                    if mean is not None:
                        draw(*places, size, mean, sign, image)
                    if sums is not None:
                        draw(*places, size, sums[at], sign, image)
                if photographs:
                    squares[index], pixels[index] = squares_of(places[0], image, shots.mask(index))
                if half is not None and shots.doubts is not None:
                    distrust(image, shots.mask(index), np.float32(max(half, 1e-12)), weight)
                if for_mean:
                    put_back(*places, size, image, weight, added)
                if for_coarse:
                    back[at] = 0
                    put_back(*places, size, image, weight, back[at])

        parallel_map(piece, pieces(last - first, PIECE))
        for number, block in enumerate(blocks if for_coarse else ()):
            inside = np.ascontiguousarray(back[:, :, *block.window]).reshape(last - first, -1)
            if for_textures and block.count:
                into = found[number].reshape(block.count, -1)
                for left, right in pieces(into.shape[1], COLUMNS):
                    part = product[: block.count, : right - left]
                    into[:, left:right] += np.matmul(block.weights[some].T, inside[:, left:right], out=part)
            if for_weights and block.count:
                asked[number][some] = inside @ block.textures.reshape(block.count, -1).T
    return Look(shares.sum(axis=0), found, asked, squares, pixels)


def psnr_of(squares: NDArray[np.float64], pixels: NDArray[np.float64], channels: int = 1) -> float:
    """dB, the mean over cameras that see anything, of the channels' own range 0..1; what is drawn is not rounded."""
    seen = pixels > 0
    return float(np.mean(-10 * np.log10(np.maximum(squares[seen] / (pixels[seen] * channels), 1e-12))))
