"""One pass over all observations: each is drawn, and its difference is brought back to mean, textures and weights.

What a renderer draws is the sum of mean and components in the finest atlas. Here each is drawn from its own grid, and
the drawn pictures are summed: nearly the same (Catmull-Rom once instead of twice for what is coarse) for a third of the
work, as no observation needs an atlas of its own. A pass with an `AtlasComposer` draws as the renderers do.

Observations are taken in batches, whatever the number of threads, and a batch's parts are summed in order: the same
input gives the same numbers.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.footprints import Footprint
from eigenfield.encoding.fitted.kernels import adjoint, forward, robust_weights, squares_of
from eigenfield.encoding.fitted.model import AtlasComposer, PlaneModel, sum_up
from eigenfield.encoding.fitted.normal_kernels import multiply, multiply_both
from eigenfield.encoding.fitted.observations import FitData
from eigenfield.encoding.fitted.products import add_shares, one_blas_thread, scalar_products
from eigenfield.runtime.parallel import even_pieces, parallel_map

PASS_BATCH_OBSERVATIONS = 48  # whose sums are in memory at a time: each batch reads and writes all textures once
PASS_TASKS = 8  # of a batch, each with sums of its own
SYMMETRIC_MAX_POINTS = 1.3  # a pixel, of sheets: measured with one and two
PLUS, MINUS = np.float32(1), np.float32(-1)

Textures = list[NDArray[np.float32]]


@dataclass(frozen=True, eq=False)
class NormalEquations:
    """What a pass brings: sums over the observations of G^T w (photograph - drawn), the right-hand side of the normal
    equations, or of G^T w drawn, their matrix times what was drawn.

    Attributes:
        mean: as the model's.
        textures: for each block (n, C, rows, columns).
        weights: for each block (No, n), a row for each observation.
        squares: (No,) the sum of m (photograph - drawn)^2 over an observation, m being its mask.
        pixels: (No,) the sum of m; both are zero where photographs were not compared with.
    """

    mean: NDArray[np.float32]
    textures: Textures
    weights: Textures
    squares: NDArray[np.float64]
    pixels: NDArray[np.float64]


@one_blas_thread
def render_and_backproject(
    data: FitData,
    model: PlaneModel,
    *,
    mean: NDArray[np.float32] | None,
    textures: Textures | None,
    weights: Textures,
    photographs: bool,
    wanted: tuple[bool, bool, bool],
    composer: AtlasComposer | None = None,
    variance: float | None = None,
) -> NormalEquations:
    """Draw every observation from a mean and textures, and bring back what is asked for.

    Args:
        model: whose weights the textures that are asked for go with, and whose textures the weights go with.
        mean: is drawn; None: nothing.
        textures: are drawn, for each block of the model; None: nothing.
        weights: (No, n) by which the textures are drawn, for each block; they need not be the model's own.
        photographs: whether they are compared with (the residual goes back), or what is drawn goes back itself.
        wanted: which of mean, textures and weights to bring.
        composer: draws exactly as the renderers do, mean and textures both given.
        variance: sigma^2 by which the robust weights of the pixels, where the data have any, are updated from the
            residual (`kernels.robust_weights`); None: they stay.
    """
    for_mean, for_textures, for_weights = wanted
    observations, blocks, size = data.observations, model.blocks, data.size
    found = [np.zeros_like(block.textures) for block in blocks] if for_textures else []
    asked = [np.zeros((len(data), block.count), np.float32) for block in blocks] if for_weights else []
    squares, pixels = np.zeros(len(data)), np.zeros(len(data))
    coarse = any(block.count for block in blocks)
    for_coarse = coarse and (for_textures or for_weights)
    sign = MINUS if photographs else PLUS
    fine_mean = composer.fine_mean(mean) if composer is not None and mean is not None else None
    # What is drawn goes back to where it came from. That is slower where many pixels show several points
    points, shown = data.footprints.offsets[-1], data.footprints.pixel_offsets[-1]
    single = not len(data.footprints.shares) or points < SYMMETRIC_MAX_POINTS * shown
    symmetric = not photographs and composer is None and single
    symmetric = symmetric and (mean is not None, coarse and textures is not None) == (for_mean, for_coarse)
    # All batches share their arrays: memory given back and asked for anew costs more than what is done with it
    batches = even_pieces(len(data), -(-len(data) // PASS_BATCH_OBSERVATIONS))
    batch = max((last - first for first, last in batches), default=0)
    room = np.empty((2, batch, model.channels, *model.grid), np.float32)  # pages not written to take no memory
    tasks = min(PASS_TASKS, batch)
    shares = np.zeros((tasks, *(model.mean.shape if for_mean else (0, 0, 0))), np.float32)
    for first, last in batches:
        some = slice(first, last)
        sums, back = None, room[1, : last - first]
        if coarse and textures is not None:
            sums = room[0, : last - first]
            sum_up(model, textures, [rows[some] for rows in weights], sums)

        def piece(
            task: tuple[NDArray[np.float32], tuple[int, int]],
            first: int = first,
            sums: NDArray[np.float32] | None = sums,
            back: NDArray[np.float32] = back,
        ) -> None:
            added, part = task
            for at in range(*part):
                index = first + at
                footprint, weight = data.footprint(index), observations.weights(index)
                if for_coarse:
                    back[at] = 0
                if symmetric:
                    _multiply(footprint, size, weight, mean, None if sums is None else sums[at], added, back[at])
                    continue
                image = data.target(index, model.matrix) if photographs else data.blank(index, model.channels)
                if composer is not None and fine_mean is not None:
                    texture = fine_mean
                    if sums is not None:
                        texture = np.zeros_like(fine_mean)
                        composer.grid.up(sums[at], texture, fine_mean)
                    forward(*footprint, size, texture, sign, image)
                else:
                    if mean is not None:
                        forward(*footprint, size, mean, sign, image)
                    if sums is not None:
                        forward(*footprint, size, sums[at], sign, image)
                if photographs:
                    squares[index], pixels[index] = squares_of(footprint[0], image, observations.mask(index))
                if variance is not None and observations.robust is not None:
                    robust_weights(image, observations.mask(index), np.float32(max(variance, 1e-12)), weight)
                if for_mean:
                    adjoint(*footprint, size, image, weight, added)
                if for_coarse:
                    adjoint(*footprint, size, image, weight, back[at])

        parallel_map(piece, list(zip(shares, even_pieces(last - first, tasks), strict=False)))
        for number, block in enumerate(blocks if for_coarse else ()):
            inside = np.ascontiguousarray(back[:, :, *block.window]).reshape(last - first, -1)
            if for_textures and block.count:
                add_shares(block.weights[some], inside, found[number].reshape(block.count, -1))
            if for_weights and block.count:
                asked[number][some] = scalar_products(inside, block.textures.reshape(block.count, -1))
    return NormalEquations(shares.sum(axis=0), found, asked, squares, pixels)


def _multiply(
    footprint: Footprint,
    size: tuple[int, int],
    weight: NDArray[np.uint8],
    mean: NDArray[np.float32] | None,
    sums: NDArray[np.float32] | None,
    mean_product: NDArray[np.float32],
    sums_product: NDArray[np.float32],
) -> None:
    """Add an observation's G^T w G (mean + sums) to both products, each of the size of what it belongs to."""
    if mean is not None and sums is not None:
        multiply_both(*footprint, size, weight, mean, sums, mean_product, sums_product)
    elif mean is not None:
        multiply(*footprint, size, weight, mean, mean_product)
    elif sums is not None:
        multiply(*footprint, size, weight, sums, sums_product)


def psnr_of(squares: NDArray[np.float64], pixels: NDArray[np.float64], channels: int = 1) -> float:
    """dB, the mean over observations that show anything, of the channels' own range 0..1; what is drawn is not
    rounded."""
    seen = pixels > 0
    return float(np.mean(-10 * np.log10(np.maximum(squares[seen] / (pixels[seen] * channels), 1e-12))))
