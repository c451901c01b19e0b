"""Which of a plane's components are coded, and how finely: those that take more squared error off the pictures than
their bytes would elsewhere."""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import Coder, svt
from eigenfield.core.scene import Basis
from eigenfield.encoding.fitted.code_planes import CodedBasis, code_basis, code_mean, first_pictures
from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.solve import Scales
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.fit")

LAGRANGE = 0.134  # squared error per bit in steps^2, as video encoders weigh them (0.85 2^((QP - 12) / 3), H.264)
WEIGHT_BYTES = 0.4  # of a coded weight: what weak components' take
NEAR = 1.25  # the mean's steps whose bytes and errors are compared lie so far to either side
BELIEVED = 4.0  # a measured price is at most so many times the reckoned one, or that part of it
OTHER_STEPS = 1.2, 1 / 1.2  # of the usual one, at which textures may be coded instead
QUICK = svt(8)  # codes textures to find their step: in a quarter of the time, a few per cent larger


@dataclass(frozen=True)
class Rate:
    """How finely a plane is coded. mean_step, texture_step: of the quantiser, in the photographs' range. coder: of the
    pictures. trial: one that is faster, by which components are chosen; None: the same. search: whether textures may
    be coded at one of OTHER_STEPS."""

    mean_step: float
    texture_step: float
    coder: Coder
    trial: Coder | None = None
    search: bool = False


@dataclass(frozen=True)
class Price:
    """Squared error over all pictures that a byte of the mean takes off: a component is worth its bytes where it takes
    off more. reckoned: `LAGRANGE` step^2 a bit, times the pixels that a texel of the mean answers for. measured: from
    the mean's coding beside its step; `reckoned` where that was not looked at."""

    reckoned: float
    measured: float


def price_of_mean(model: PlaneModel, scales: Scales, rate: Rate, precision: NDArray[np.float32] | None = None) -> Price:
    """precision: as `code_mean`. Measured where `rate` searches and there is what to search for."""
    seen = scales.mean[scales.mean > 0]
    reckoned = price_of(rate.mean_step) * float(np.median(seen)) if len(seen) else 0.0
    if not (rate.search and model.blocks):
        return Price(reckoned, reckoned)
    mean = np.ascontiguousarray(model.mean.transpose(1, 2, 0))

    def coded(factor: float) -> tuple[float, int]:
        kept, picture = code_mean(mean, rate.mean_step * factor, rate.trial or rate.coder, precision)
        return float(np.einsum("hwc,hw->", np.square(kept - mean), scales.mean, dtype=np.float64)), len(picture.data)

    (fine, more), (coarse, fewer) = parallel_map(coded, (1 / NEAR, NEAR))
    slope = (coarse - fine) / (more - fewer) if more > fewer else reckoned
    return Price(reckoned, min(max(slope, reckoned / BELIEVED), reckoned * BELIEVED))


def code_worthwhile(block: Block, grid: tuple[int, int], scales: Scales, rate: Rate, price: Price) -> CodedBasis:
    """Those of a block's components that are worth their bytes, coded. grid: (rows, columns) that it is part of."""
    basis = _basis_of(block, grid)
    step = rate.texture_step
    if rate.search:
        step *= _best_factor(basis, block, scales, step, price)
    coded = code_basis(basis, step, rate.trial or rate.coder)
    _, count = _worthwhile(*_effects(coded, block, scales), price.reckoned)
    log.debug("%d of %d components coded, at %.2f of the usual step", count, block.count, step / rate.texture_step)
    ends = list(accumulate((picture.count for picture in coded.pictures), initial=0))
    if count == 0 or (count in ends and rate.trial is None):
        return first_pictures(coded, ends.index(count))
    few = replace(block, textures=block.textures[:count], weights=np.ascontiguousarray(block.weights[:, :count]))
    return code_basis(_basis_of(few, grid), step, rate.coder)


def _best_factor(basis: Basis, block: Block, scales: Scales, step: float, price: Price) -> float:
    """Of `step`: 1, or that of OTHER_STEPS which a quick coder finds cheaper at the reckoned and at the measured price.

    Neither is right alone. Where bytes are few the measured one is up to 2.5 times the other, and too high, since
    drawing averages away part of the error of a mean denser than the pictures.
    """

    def costs(factor: float) -> tuple[float, float]:
        errors, sizes = _effects(code_basis(basis, step * factor, QUICK), block, scales)
        return _worthwhile(errors, sizes, price.reckoned)[0], _worthwhile(errors, sizes, price.measured)[0]

    usual = costs(1.0)
    for factor in OTHER_STEPS:
        if all(other < least for other, least in zip(costs(factor), usual, strict=True)):
            return factor
    return 1.0


def _effects(coded: CodedBasis, block: Block, scales: Scales) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of each component: squared error over all cameras that it brings, less than 0 where it takes some off, and bytes,
    its weights' too."""
    share = scales.coarse[block.window]
    errors: list[float] = []
    sizes: list[float] = []
    for picture in coded.pictures:
        part = slice(len(errors), len(errors) + picture.count)
        before, after = block.textures[part], coded.basis.values(part.start, part.stop).transpose(0, 3, 1, 2)
        more = np.einsum("nchw,nchw,hw->n", after, after - 2 * before, share, dtype=np.float64)  # (b - a)^2 - b^2
        errors += more.tolist()
        sizes += [len(picture.data) / picture.count + WEIGHT_BYTES * len(block.weights)] * picture.count
    return np.array(errors), np.array(sizes)


def _worthwhile(errors: NDArray[np.float64], sizes: NDArray[np.float64], price: float) -> tuple[float, int]:
    """Least of what components bring and their bytes cost, the strongest first, and with how many."""
    totals = np.cumsum([0.0, *(errors + price * sizes)])
    count = int(np.argmin(totals))
    return float(totals[count]), count


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
