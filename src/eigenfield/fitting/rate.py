"""Which of a plane's components are coded: those that take more squared error off the pictures than their bytes would
elsewhere."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import accumulate

import numpy as np

from eigenfield.fitting.model import Block
from eigenfield.fitting.solve import Scales
from eigenfield.format.deep import Coder
from eigenfield.format.deep_code import code_basis, first_pictures
from eigenfield.format.stored import files_of
from eigenfield.scene import Basis

LAGRANGE = 0.134  # squared error per bit in steps^2, as video encoders weigh them (0.85 2^((QP - 12) / 3), H.264)
WEIGHT_BYTES = 0.4  # of a coded weight: what weak components' take


@dataclass(frozen=True)
class Rate:
    """How finely a plane is coded. mean_step, texture_step: of the quantiser, in the photographs' range. coder: of the
    pictures. trial: one that is faster, by which components are chosen; None: the same."""

    mean_step: float
    texture_step: float
    coder: Coder
    trial: Coder | None = None


def code_worthwhile(block: Block, grid: tuple[int, int], scales: Scales, rate: Rate) -> Basis:
    """Those of a block's components that are worth their bytes, coded. grid: (rows, columns) that it is part of."""
    coded = code_basis(_basis_of(block, grid), rate.texture_step, rate.trial or rate.coder)
    count = _worthwhile(coded, block, scales, rate)
    files = files_of(coded) or ()
    ends = list(accumulate((file.count for file in files), initial=0))
    if count == 0 or (count in ends and rate.trial is None):
        return first_pictures(coded, ends.index(count))
    few = replace(block, textures=block.textures[:count], weights=np.ascontiguousarray(block.weights[:, :count]))
    return code_basis(_basis_of(few, grid), rate.texture_step, rate.coder)


def _worthwhile(coded: Basis, block: Block, scales: Scales, rate: Rate) -> int:
    """How many components, the strongest first, are worth their bytes and their weights'.

    One takes squared error off the pictures, over all cameras; it is worth its bytes where the mean's coder would need
    more to take off as much: `LAGRANGE` step^2 a bit, times the pixels that a texel of the mean answers for.
    """
    seen, share = scales.mean[scales.mean > 0], scales.coarse[block.window]
    price = price_of(rate.mean_step) * float(np.median(seen)) if len(seen) else 0.0
    gains: list[float] = []
    for file in files_of(coded) or ():
        part = slice(len(gains), len(gains) + file.count)
        before, after = block.textures[part], coded.values(part.start, part.stop).transpose(0, 3, 1, 2)
        less = np.einsum("nchw,nchw,hw->n", after, 2 * before - after, share, dtype=np.float64)  # b^2 - (b - a)^2
        gains += (less - price * (len(file.data) / file.count + WEIGHT_BYTES * len(block.weights))).tolist()
    return int(np.argmax([0.0, *np.cumsum(gains)]))


def price_of(mean_step: float) -> float:
    """Squared error of a mean that a byte of it takes off, for each pixel that a texel is seen in."""
    return 8 * LAGRANGE * mean_step**2


def _basis_of(block: Block, grid: tuple[int, int]) -> Basis:
    """A block as a scene has it."""
    textures = np.ascontiguousarray(block.textures.transpose(0, 2, 3, 1))
    ones = np.ones((block.count, textures.shape[3]), np.float32)
    top, _, left, _ = block.rectangle
    part = textures.shape[1:3] != grid
    return Basis(textures, ones, np.zeros_like(ones), block.weights, grid if part else None, (top, left))
