"""One look at all photographs: what is drawn of them, and what the difference asks of mean, textures and weights.

Cameras are taken in batches, whatever the number of threads, and a batch's parts are summed in order: the same input
gives the same numbers.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.fitting.kernels import draw_back
from eigenfield.fitting.model import ZERO, Finers, Model, sums_of
from eigenfield.fitting.shots import Shots
from eigenfield.parallel import parallel_map, pieces

BATCH = 48  # cameras whose sums are in memory at a time: each batch reads and writes all textures once
PIECE = 12  # of them are one thread's task
NONE = np.zeros((0, 0, 3), np.uint8)

Textures = list[NDArray[np.float32]]


@dataclass(frozen=True, eq=False)
class Look:
    """What a pass brings: sums over the cameras of G^T w (photograph - drawn), or of G^T w drawn.

    mean: as the model's. textures: for each block (n, C, rows, columns). weights: for each block (Ne, n).
    squares: (Ne,) of each camera, sum of w (photograph - drawn)^2. pixels: (Ne,), sum of w.
    """

    mean: NDArray[np.float32]
    textures: Textures
    weights: Textures
    squares: NDArray[np.float64]
    pixels: NDArray[np.float64]


def look(
    shots: Shots,
    model: Model,
    finers: Finers,
    *,
    mean: NDArray[np.float32] | None,
    textures: Textures | None,
    weights: Textures,
    photographs: bool,
    wanted: tuple[bool, bool, bool],
    step: int = 1,
) -> Look:
    """Draw every camera from a mean and textures (None: nothing) with weights, which need not be the model's own.

    photographs: whether they are compared with (the residual goes back), or what is drawn goes back itself. wanted:
    which of mean, textures and weights to bring; the textures asked of go with the model's weights, the weights with
    its textures. step: every `step`-th pixel of a row counts, another one in each row and camera.
    """
    for_mean, for_textures, for_weights = wanted
    blocks = model.blocks
    shape = (model.channels, *finers.fine)
    finer, fine_mean = finers.grid, None if mean is None else finers.fine_mean(mean)
    total = np.zeros(shape if for_mean else (0, 0, 0), np.float32)
    found = [np.zeros_like(block.textures) for block in blocks] if for_textures else []
    asked = [np.zeros((len(shots), block.count), np.float32) for block in blocks] if for_weights else []
    squares, pixels = np.zeros(len(shots)), np.zeros(len(shots))
    coarse = any(block.count for block in blocks)
    summed, for_coarse = coarse and textures is not None, coarse and (for_textures or for_weights)
    summed, for_coarse = coarse and textures is not None, coarse and (for_textures or for_weights)
    matrix = (model.matrix / np.float32(255)).astype(np.float32)
    for first, last in pieces(len(shots), BATCH):
        some = slice(first, last)
        sums = sums_of(model, textures, weights, some) if summed and textures is not None else None
        back = np.zeros((last - first, model.channels, *model.grid), np.float32)

        def piece(
            part: tuple[int, int],
            first: int = first,
            sums: NDArray[np.float32] | None = sums,
            back: NDArray[np.float32] = back,
        ) -> NDArray[np.float32]:
            added = np.zeros(shape if for_mean else (0, 0, 0), np.float32)
            drawn, out = np.zeros(shape, np.float32), np.zeros(shape, np.float32)
            for at in range(*part):
                index, source = first + at, drawn
                if sums is not None:
                    finer.up(sums[at], drawn, ZERO if fine_mean is None else fine_mean)
                elif fine_mean is not None:
                    source = fine_mean
                into = added if for_mean and not for_coarse else out
                if into is out:
                    out[:] = 0
                squares[index], pixels[index] = draw_back(
                    shots.places(index), source, shots.photograph(index) if photographs else NONE, matrix,
                    shots.weight(index), index % step, step, into,
                )  # fmt: skip
                if for_coarse:
                    finer.down(out, back[at])
                    if for_mean:
                        added += out
            return added

        for added in parallel_map(piece, pieces(last - first, PIECE)):
            if for_mean:
                total += added
        for number, block in enumerate(blocks if for_coarse else ()):
            inside = np.ascontiguousarray(back[:, :, *block.window]).reshape(last - first, -1)
            if for_textures and block.count:
                found[number] += (block.weights[some].T @ inside).reshape(block.textures.shape)
            if for_weights and block.count:
                asked[number][some] = inside @ block.textures.reshape(block.count, -1).T
    return Look(finers.coarse_mean(total) if for_mean else total, found, asked, squares, pixels)


def psnr_of(squares: NDArray[np.float64], pixels: NDArray[np.float64], channels: int = 1) -> float:
    """dB, the mean over cameras that see anything, of the channels' own range 0..1; what is drawn is not rounded."""
    seen = pixels > 0
    return float(np.mean(-10 * np.log10(np.maximum(squares[seen] / (pixels[seen] * channels), 1e-12))))
