"""The fit: planes whose drawn pictures are as near the photographs as their bytes allow.

Open loop first: the mean alone, the paper's decomposition of what it leaves, then mean and textures together and the
weights, in turns, until a round changes less than `FIT_STOP_DB`; from the second round on pixels with robust weights
count less the farther they are from what is drawn (`FIT_SIGMA_RATIO`). Then closed loop, at any rates: the textures are
coded, weights and mean are fitted again to what the coded ones draw, and the mean is coded last.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.codecs import encoder
from eigenfield.core.appearance import Plane
from eigenfield.core.payloads import Coded, Payload
from eigenfield.core.progress import Progress
from eigenfield.core.spread import spread_indices
from eigenfield.encoding.fitted.code_planes import CodedBasis, coded_plane, with_weights
from eigenfield.encoding.fitted.coverage import fill_unseen
from eigenfield.encoding.fitted.kernels import forward, squares_of
from eigenfield.encoding.fitted.model import AtlasComposer, Block, PlaneModel, make_composer
from eigenfield.encoding.fitted.observations import FitData
from eigenfield.encoding.fitted.passes import MINUS, psnr_of
from eigenfield.encoding.fitted.products import one_blas_thread
from eigenfield.encoding.fitted.rate import Rate, code_block_rd, plane_lambda
from eigenfield.encoding.fitted.rotation import rotate_components
from eigenfield.encoding.fitted.solve import Scales, fit_textures, fit_weights, measure_scales, residual, whiten
from eigenfield.encoding.fitted.start import find_regions, principal_block, residual_energy
from eigenfield.encoding.views import nothing_seen_error
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.fit")

FIT_STOP_DB = 0.05  # by which a round must change the pictures for another to follow
FIT_SIGMA_RATIO = 4.0  # sigma of the robust weights, in root mean squares of the residual of the round before
FIT_MEAN_ITERATIONS = 8  # of conjugate gradients: the mean alone, from one colour
FIT_WEIGHT_ITERATIONS = 4
FIT_CLOSING_ITERATIONS = 3  # for the mean, after coding
WEIGHT_QUANTISER_STEP = 0.0008  # of a weight times what its component draws, in the photographs' range: 0.2 grey levels
WEIGHT_MAX_QUANTISER_STEP = 1.5  # of weights of variance 1
WEIGHTS_CODEC = "weights-1"
PSNR_MAX_OBSERVATIONS = 25  # by which a plane's PSNR is measured
MEAN_WANTED, NOTHING_WANTED = (True, False, False), (False, False, False)  # of mean, textures and weights


@dataclass(frozen=True, eq=False)
class PlaneSettings:
    """What one plane is to be.

    Attributes:
        matrix: (C, 3) its channels from R, G, B.
        mean: (rows, columns) of the mean.
        grid: (rows, columns) of the components.
        textures: N.
        local: number of components of each region's own.
        scattered: whether few of the photographs see a texel of an opaque surface (`CaptureViews.scattered`).
    """

    matrix: NDArray[np.float32]
    mean: tuple[int, int]
    grid: tuple[int, int]
    textures: int
    local: int = 0
    scattered: bool = False

    def grey_model(self) -> PlaneModel:
        """Where a fit begins: one grey, without components."""
        grey = np.full((len(self.matrix), *self.mean), 0.5, np.float32) * self.matrix.sum(axis=1)[:, None, None]
        return PlaneModel(self.matrix, grey.astype(np.float32), self.grid, [])


@dataclass(frozen=True)
class Turns:
    """How many times textures and weights are fitted in turns, at most, and by how many iterations the textures."""

    rounds: int
    texture_iterations: int = 5


@dataclass(frozen=True, eq=False)
class Pixels:
    """The same observations three times, in the same order.

    Attributes:
        every: all their pixels.
        fitted: what mean and textures are fitted to (`open_subsampled`, `with_robust_weights`).
        weighed: what weights are fitted to, likewise.
    """

    every: FitData
    fitted: FitData
    weighed: FitData


@dataclass(frozen=True, eq=False)
class MeanAlone:
    """How far the photographs are from what the mean draws.

    Attributes:
        squares: (No,) squared deviations of each observation.
        pixels: (No,) that these are over.
        total: squared deviations of all observations from one colour.
    """

    squares: NDArray[np.float64]
    pixels: NDArray[np.float64]
    channels: int
    total: float

    @property
    def psnr(self) -> float:
        """dB, the mean over observations that show anything."""
        return psnr_of(self.squares, self.pixels, self.channels)


@dataclass(frozen=True, eq=False)
class OpenFit:
    """A plane fitted, not coded.

    Attributes:
        scales: of `pixels.fitted`.
        mean_alone: what the mean left before there were textures.
        uncoded: dB of its channels, mean over PSNR_MAX_OBSERVATIONS, what is drawn not rounded.
    """

    name: str
    pixels: Pixels
    model: PlaneModel
    scales: Scales
    composer: AtlasComposer
    mean_alone: MeanAlone
    uncoded: float
    scattered: bool


def fit_plane(
    pixels: Pixels,
    settings: PlaneSettings,
    name: str,
    turns: Turns,
    work: Path | None = None,
    progress: Progress | None = None,
) -> OpenFit:
    """Fit one plane in open loop.

    Raises:
        CaptureError: `nothing-seen`, no camera covers a pixel.
    """
    fitted, channels = pixels.fitted, len(settings.matrix)
    model = settings.grey_model()
    tick = _ticker(progress, f"fit {name}", 3 + 2 * turns.rounds)
    scales = measure_scales(fitted, model)
    if not scales.mean.any():
        raise nothing_seen_error()
    if settings.scattered:
        scales = scales.for_scattered_cameras()
    mean_alone = fit_mean(fitted, model, scales)
    tick()
    count = min(settings.textures, len(fitted) - 1)
    if count:
        rows, columns = settings.grid
        model.blocks = [principal_block(fitted, model, scales, count, (0, rows, 0, columns), settings.scattered, work)]
        whiten(model, scales)
        _add_regions(pixels, model, scales, min(settings.local, len(fitted) - 1), settings.scattered, work)
    tick()
    reached, variance = -math.inf, None
    for number in range(turns.rounds if count else 0):
        equations = residual(fitted, model, variance=variance)
        before, reached = reached, psnr_of(equations.squares, equations.pixels, channels)
        log.info("%s, after round %d: %.2f dB", name, number, reached)
        if abs(reached - before) < FIT_STOP_DB:
            break
        fit_textures(fitted, model, scales, turns.texture_iterations, equations=equations)
        tick()
        fit_weights(pixels.weighed, model, FIT_WEIGHT_ITERATIONS)
        variance = FIT_SIGMA_RATIO**2 * float(equations.squares.sum() / max(equations.pixels.sum(), 1.0))
        whiten(model, scales)
        tick()
    surface = pixels.every.footprints.surface
    fill_unseen(model, scales, surface)
    composer = make_composer(surface, model)
    uncoded = _drawn_psnr(pixels.every, model, composer)
    tick(last=True)
    return OpenFit(name, pixels, model, scales, composer, mean_alone, uncoded, settings.scattered)


def _add_regions(
    pixels: Pixels, model: PlaneModel, scales: Scales, count: int, scattered: bool, work: Path | None
) -> None:
    """Add `count` components for each rectangle of which the model leaves much more than its share."""
    if not count:
        return
    for rectangle in find_regions(*residual_energy(pixels.weighed, model)):
        model.blocks.append(principal_block(pixels.fitted, model, scales, count, rectangle, scattered, work))
        log.info("%d components of their own for rows %d to %d, columns %d to %d", count, *rectangle)
    whiten(model, scales)


def code_plane(
    fit: OpenFit,
    rate: Rate,
    grid: NDArray[np.int64] | None = None,
    precision: NDArray[np.float32] | None = None,
    progress: Progress | None = None,
) -> Coded[Plane]:
    """Code a fitted plane in closed loop: textures coded, weights and mean fitted to what they became, the mean coded.
    As its files give it back.

    Args:
        fit: stays as it is, for other rates.
        grid: (rows, columns) of observations, which are the rows of the weights, whose cameras stand on a regular
            array, -1 where none stands; None where they do not.
        precision: of the mean, see `mean_precision`; None: alike everywhere.
    """
    pixels, scales, open_loop = fit.pixels, fit.scales, fit.model
    tick = _ticker(progress, f"code {fit.name}", 3)
    model = replace(open_loop, mean=open_loop.mean.copy(), blocks=[])
    bases: list[CodedBasis] = []
    lambda_ = plane_lambda(scales, rate)
    for block in open_loop.blocks:
        if fit.scattered:  # the cameras of an array see nearly the same: there it gains nothing
            block = rotate_components(block, rate.texture_step)
        coded = code_block_rd(block, model.grid, scales, rate, lambda_)
        if not coded.count:
            continue
        textures = np.ascontiguousarray(coded.basis.values().transpose(0, 3, 1, 2))
        weights = np.ascontiguousarray(block.weights[:, : coded.count])
        model.blocks.append(replace(block, textures=textures, weights=weights))
        bases.append(coded)
    tick()
    if bases:
        fit_weights(pixels.weighed, model, FIT_WEIGHT_ITERATIONS)
        for number, block in enumerate(model.blocks):
            stream, block.weights = encoder(WEIGHTS_CODEC)(
                block.weights, weight_steps(texture_squares(block, scales), scales), grid
            )
            bases[number] = with_weights(bases[number], block.weights, Payload(WEIGHTS_CODEC, stream))
    tick()
    equations = residual(pixels.fitted, model, MEAN_WANTED, fit.composer)
    fit_textures(pixels.fitted, model, scales, FIT_CLOSING_ITERATIONS, mean_only=True, equations=equations)
    mean = np.ascontiguousarray(model.mean.transpose(1, 2, 0))
    white = pixels.every.white(model.matrix)
    plane = coded_plane(mean, bases, rate.mean_step, rate.coder, precision, white)
    tick(last=True)
    return plane


def coded_psnr(fit: OpenFit, plane: Plane) -> float:
    """As `OpenFit.uncoded`, of the plane that the fit was coded to."""
    blocks = []
    for basis in plane.bases:
        top, left = basis.corner
        height, width = basis.textures.shape[1:3]
        textures = np.ascontiguousarray(basis.values().transpose(0, 3, 1, 2))
        blocks.append(Block((top, top + height, left, left + width), textures, basis.weights))
    mean = np.ascontiguousarray(plane.mean.transpose(2, 0, 1))
    return _drawn_psnr(fit.pixels.every, replace(fit.model, mean=mean, blocks=blocks), fit.composer)


@one_blas_thread
def _drawn_psnr(data: FitData, model: PlaneModel, composer: AtlasComposer) -> float:
    """dB of PSNR_MAX_OBSERVATIONS photographs, evenly spread, as the renderers draw the model."""
    mean = composer.fine_mean(model.mean)

    def measure(index: int) -> tuple[float, float]:
        footprint, image, texture = data.footprint(index), data.target(index, model.matrix), mean
        if any(block.count for block in model.blocks):
            texture = np.zeros_like(mean)
            composer.grid.up(model.sums(slice(index, index + 1))[0], texture, mean)
        forward(*footprint, data.size, texture, MINUS, image)
        return squares_of(footprint[0], image, data.observations.mask(index))

    squares, pixels = np.array(parallel_map(measure, spread_indices(len(data), PSNR_MAX_OBSERVATIONS))).T
    return psnr_of(squares, pixels, model.channels)


def fit_mean(data: FitData, model: PlaneModel, scales: Scales, iterations: int = FIT_MEAN_ITERATIONS) -> MeanAlone:
    """Fit the mean of a model without components, from what it is.

    Args:
        model: Is changed in place.
        scales: Of these data.
    """
    equations = residual(data, model, MEAN_WANTED)
    # the filter's weights sum to 1, so that G^T leaves the sum of what it brings back as it is
    sums = equations.mean.sum(axis=(1, 2), dtype=np.float64)
    total = float(equations.squares.sum() - np.square(sums).sum() / max(float(equations.pixels.sum()), 1.0))
    fit_textures(data, model, scales, iterations, mean_only=True, equations=equations)
    equations = residual(data, model, NOTHING_WANTED)
    return MeanAlone(equations.squares, equations.pixels, model.channels, total)


def texture_squares(block: Block, scales: Scales) -> NDArray[np.float64]:
    """(n,) the sum of squares that each component of weight 1 draws, over all pictures."""
    share = scales.coarse[block.window]
    return np.asarray(np.einsum("nchw,nchw,hw->n", block.textures, block.textures, share, dtype=np.float64))


def weight_steps(squares: NDArray[np.float64], scales: Scales) -> NDArray[np.float32]:
    """(n,) steps so that a weight's error moves all pictures alike: in inverse proportion to what its component draws,
    the root mean square over a picture's pixels.

    Args:
        squares: Of `texture_squares`; of several frames their mean.
    """
    drawn = np.sqrt(squares / max(float(scales.coarse.sum()), 1e-12))
    return np.clip(WEIGHT_QUANTISER_STEP / np.maximum(drawn, 1e-9), 1e-3, WEIGHT_MAX_QUANTISER_STEP).astype(np.float32)


def _ticker(progress: Progress | None, stage: str, total: int) -> Callable[..., None]:
    """A function that reports one more of `total` steps, or all of them."""
    done = 0
    if progress is not None:
        progress(stage, 0, total)

    def tick(last: bool = False) -> None:
        nonlocal done
        done = total if last else min(done + 1, total - 1)
        if progress is not None:
            progress(stage, done, total)

    return tick
