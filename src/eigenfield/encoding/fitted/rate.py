"""Which of a plane's components are coded, by rate and distortion.

Squared error over all pictures + lambda x bytes is minimised, lambda being the error that a byte of the mean takes off.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import Coder
from eigenfield.core.appearance import Basis
from eigenfield.encoding.fitted.code_planes import CodedBasis, code_basis
from eigenfield.encoding.fitted.model import Block
from eigenfield.encoding.fitted.solve import Scales

log = logging.getLogger("eigenfield.fit")

RATE_LAMBDA_PER_SQUARED_STEP = 0.134  # for a bit, as in video encoders (0.85 2^((QP - 12) / 3), H.264)
RATE_WEIGHT_BYTES = 0.4  # of a coded weight of a weak component


@dataclass(frozen=True)
class Rate:
    """How finely a plane is coded.

    Attributes:
        mean_step: Of the quantiser, in the photographs' range.
        trial: A faster coder, by which components are chosen.
    """

    mean_step: float
    texture_step: float
    coder: Coder
    trial: Coder


def plane_lambda(scales: Scales, rate: Rate) -> float:
    """Lagrange multiplier of a plane: squared error over all pictures that a byte of its mean takes off."""
    return lambda_of_step(rate.mean_step) * scales.usual if scales.mean.any() else 0.0


def code_block_rd(block: Block, grid: tuple[int, int], scales: Scales, rate: Rate, lambda_: float) -> CodedBasis:
    """The components of a block that take off more squared error than lambda x their bytes, coded.

    The block's rectangle is part of `grid` (rows, columns).
    """
    step = rate.texture_step * _coarsening(scales)
    errors, sizes = effects_on_trial(block, grid, scales, rate)
    count = int(np.argmin(np.cumsum([0.0, *(errors + lambda_ * sizes)])))  # of the strongest
    log.debug("%d of %d components coded", count, block.count)
    few = replace(block, textures=block.textures[:count], weights=np.ascontiguousarray(block.weights[:, :count]))
    return code_basis(_basis_of(few, grid), step, rate.coder)


def effects_on_trial(
    block: Block, grid: tuple[int, int], scales: Scales, rate: Rate
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """How each component of a block, coded on trial, changes the squared error over all cameras, and its bytes with
    those of its weights."""
    step = rate.texture_step * _coarsening(scales)
    return _effects(code_basis(_basis_of(block, grid), step, rate.trial), block, scales)


def _coarsening(scales: Scales) -> float:
    """How much coarser the components of sheets are coded than those of an opaque surface.

    For the same error in the pictures, steps are in inverse proportion to the root of a texel's noise, were its errors
    independent of those of the texels behind. They are partly alike: half of that, in octaves, is best (Fern).
    """
    if not scales.soft:
        return 1.0
    usual = scales.usual * scales.mean.size / scales.coarse.size
    return float((usual / max(float(scales.coarse_noise[scales.coarse > 0].mean()), 1e-12)) ** 0.25)


def _effects(coded: CodedBasis, block: Block, scales: Scales) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The change of squared error over all cameras by each component, and its bytes with those of its weights."""
    share, noise = scales.coarse[block.window], scales.coarse_noise[block.window]
    errors: list[float] = []
    sizes: list[float] = []
    for picture in coded.pictures:
        part = slice(len(errors), len(errors) + picture.count)
        before, after = block.textures[part], coded.basis.values(part.start, part.stop).transpose(0, 3, 1, 2)
        # noise (b - a)^2 - share b^2: errors of sheets are independent, what they show of a component is alike
        more = np.einsum("nchw,nchw,hw->n", after, after - 2 * before, noise, dtype=np.float64)
        more += np.einsum("nchw,nchw,hw->n", before, before, noise - share, dtype=np.float64)
        errors += more.tolist()
        sizes += [len(picture.data) / picture.count + RATE_WEIGHT_BYTES * len(block.weights)] * picture.count
    return np.array(errors), np.array(sizes)


def lambda_of_step(mean_step: float) -> float:
    """Lagrange multiplier of a mean's quantiser step: squared error for a byte, for each pixel that sees a texel."""
    return 8 * RATE_LAMBDA_PER_SQUARED_STEP * mean_step**2


def _basis_of(block: Block, grid: tuple[int, int]) -> Basis:
    """A block as a scene has it."""
    textures = np.ascontiguousarray(block.textures.transpose(0, 2, 3, 1))
    ones = np.ones((block.count, textures.shape[3]), np.float32)
    top, _, left, _ = block.rectangle
    part = textures.shape[1:3] != grid
    return Basis(textures, ones, np.zeros_like(ones), block.weights, grid if part else None, (top, left))
