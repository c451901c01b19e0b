"""Which of a plane's components are coded, and how finely, by rate and distortion.

Squared error over all pictures + lambda x bytes is minimised, lambda being the error that a byte of the mean takes off.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import Coder, svt_coder
from eigenfield.core.appearance import Basis
from eigenfield.encoding.fitted.code_planes import CodedBasis, code_basis, code_mean, first_pictures
from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.solve import Scales
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.fit")

RATE_LAMBDA_PER_SQUARED_STEP = 0.134  # for a bit, as in video encoders (0.85 2^((QP - 12) / 3), H.264)
RATE_WEIGHT_BYTES = 0.4  # of a coded weight of a weak component
RATE_SLOPE_STEP_RATIO = 1.25  # the mean is coded at its step times and over this, for the slope of error over bytes
RATE_MAX_LAMBDA_RATIO = 4.0  # of the measured lambda to the predicted one, or of this to that
RATE_STEP_RATIOS = 1.2, 1 / 1.2  # of the usual step, at which textures may be coded instead
RATE_STEP_CODER = svt_coder(8)  # codes textures to find their step: in a quarter of the time, a few per cent larger


@dataclass(frozen=True)
class Rate:
    """How finely a plane is coded.

    Attributes:
        mean_step: Of the quantiser, in the photographs' range.
        texture_step: Likewise.
        coder: Of the pictures.
        trial: A faster coder, by which components are chosen; None: the same.
        search: Whether textures may be coded at one of RATE_STEP_RATIOS.
    """

    mean_step: float
    texture_step: float
    coder: Coder
    trial: Coder | None = None
    search: bool = False


@dataclass(frozen=True)
class Lambdas:
    """Lagrange multipliers: squared error over all pictures that a byte of the mean takes off.

    Attributes:
        predicted: By `lambda_of_step`, times the pixels that a texel of the mean answers for.
        measured: From the mean's coding at two steps; `predicted` where that was not done.
    """

    predicted: float
    measured: float


def measure_lambda(
    model: PlaneModel, scales: Scales, rate: Rate, precision: NDArray[np.float32] | None = None
) -> Lambdas:
    """The multipliers of a plane, measured where its rate searches and it has components.

    Args:
        model: The plane.
        scales: Of the data that it was fitted to.
        rate: How finely it is coded.
        precision: As `code_mean`.
    """
    seen = scales.mean[scales.mean > 0]
    predicted = lambda_of_step(rate.mean_step) * float(np.median(seen)) if len(seen) else 0.0
    if not (rate.search and model.blocks):
        return Lambdas(predicted, predicted)
    mean = np.ascontiguousarray(model.mean.transpose(1, 2, 0))

    def code_at(factor: float) -> tuple[float, int]:
        kept, picture = code_mean(mean, rate.mean_step * factor, rate.trial or rate.coder, precision)
        return float(np.einsum("hwc,hw->", np.square(kept - mean), scales.mean, dtype=np.float64)), len(picture.data)

    (fine, more), (coarse, fewer) = parallel_map(code_at, (1 / RATE_SLOPE_STEP_RATIO, RATE_SLOPE_STEP_RATIO))
    slope = (coarse - fine) / (more - fewer) if more > fewer else predicted
    return Lambdas(predicted, min(max(slope, predicted / RATE_MAX_LAMBDA_RATIO), predicted * RATE_MAX_LAMBDA_RATIO))


def code_block_rd(block: Block, grid: tuple[int, int], scales: Scales, rate: Rate, lambda_: Lambdas) -> CodedBasis:
    """The components of a block that take off more squared error than lambda x their bytes, coded.

    Args:
        block: The components.
        grid: (rows, columns) that its rectangle is part of.
        scales: Of the data that it was fitted to.
        rate: How finely it is coded.
        lambda_: Of the plane.
    """
    basis = _basis_of(block, grid)
    step = rate.texture_step
    if rate.search:
        step *= _best_factor(basis, block, scales, step, lambda_)
    coded = code_basis(basis, step, rate.trial or rate.coder)
    _, count = _least_cost(*_effects(coded, block, scales), lambda_.predicted)
    log.debug("%d of %d components coded, at %.2f of the usual step", count, block.count, step / rate.texture_step)
    ends = list(accumulate((picture.count for picture in coded.pictures), initial=0))
    if count == 0 or (count in ends and rate.trial is None):
        return first_pictures(coded, ends.index(count))
    few = replace(block, textures=block.textures[:count], weights=np.ascontiguousarray(block.weights[:, :count]))
    return code_basis(_basis_of(few, grid), step, rate.coder)


def _best_factor(basis: Basis, block: Block, scales: Scales, step: float, lambda_: Lambdas) -> float:
    """Of `step`: 1, or that of RATE_STEP_RATIOS which a quick coder finds cheaper by both multipliers.

    Neither is right alone. Where bytes are few the measured one is up to 2.5 times the other, and too high, since
    drawing averages away part of the error of a mean denser than the pictures.
    """

    def costs(factor: float) -> tuple[float, float]:
        errors, sizes = _effects(code_basis(basis, step * factor, RATE_STEP_CODER), block, scales)
        return _least_cost(errors, sizes, lambda_.predicted)[0], _least_cost(errors, sizes, lambda_.measured)[0]

    usual = costs(1.0)
    for factor in RATE_STEP_RATIOS:
        if all(other < least for other, least in zip(costs(factor), usual, strict=True)):
            return factor
    return 1.0


def _effects(coded: CodedBasis, block: Block, scales: Scales) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The change of squared error over all cameras by each component, and its bytes with those of its weights."""
    share = scales.coarse[block.window]
    errors: list[float] = []
    sizes: list[float] = []
    for picture in coded.pictures:
        part = slice(len(errors), len(errors) + picture.count)
        before, after = block.textures[part], coded.basis.values(part.start, part.stop).transpose(0, 3, 1, 2)
        more = np.einsum("nchw,nchw,hw->n", after, after - 2 * before, share, dtype=np.float64)  # (b - a)^2 - b^2
        errors += more.tolist()
        sizes += [len(picture.data) / picture.count + RATE_WEIGHT_BYTES * len(block.weights)] * picture.count
    return np.array(errors), np.array(sizes)


def _least_cost(errors: NDArray[np.float64], sizes: NDArray[np.float64], lambda_: float) -> tuple[float, int]:
    """The least rate-distortion cost of the first components, the strongest first, and their number."""
    totals = np.cumsum([0.0, *(errors + lambda_ * sizes)])
    count = int(np.argmin(totals))
    return float(totals[count]), count


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
