"""The fit: planes whose drawn pictures are as near the photographs as their bytes allow.

Open loop first: the mean alone, the paper's decomposition of what it leaves, then mean and textures together and the
weights, in turns, until a round gains less than `STOP`. Then closed loop: the textures are coded, weights and mean are
fitted again to what the coded ones draw, and the mean is coded last.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.errors import CaptureError
from eigenfield.fitting.model import Block, Finers, Model, make_finer
from eigenfield.fitting.passes import look, psnr_of
from eigenfield.fitting.shots import Shots
from eigenfield.fitting.solve import Scales, fit_textures, fit_weights, measure_scales, whiten
from eigenfield.fitting.start import principal_block
from eigenfield.format.deep_code import code_basis, code_plane, with_weights
from eigenfield.format.weight_coder import code_weights
from eigenfield.progress import Progress
from eigenfield.scene import Basis, Plane

log = logging.getLogger("eigenfield.fit")

STOP = 0.05  # dB that a round must gain for another to follow
ROUNDS = 3  # at most
MEAN_STEPS = 8  # of conjugate gradients: the mean alone, at first
TEXTURE_STEPS = 5
WEIGHT_STEPS = 4
WEIGHT_STEP = 0.0008  # of a weight times what its component draws, in the photographs' range: 0.2 grey levels
WEIGHT_STEP_MOST = 1.5  # of weights of variance 1
CLOSING_STEPS = 3  # for the mean, after coding


@dataclass(frozen=True, eq=False)
class PlaneSettings:
    """What one plane is to be.

    matrix: (C, 3) its channels from R, G, B. mean, grid: (rows, columns) of mean and components. textures: N.
    step: every how many-th pixel of a row the fit looks at. mean_step, texture_step: of the
    quantiser, in the photographs' range. preset: of the encoder.
    """

    matrix: NDArray[np.float32]
    mean: tuple[int, int]
    grid: tuple[int, int]
    textures: int
    step: int
    mean_step: float
    texture_step: float
    preset: int


@dataclass(frozen=True, eq=False)
class Fitted:
    """A coded plane; dB of its channels before coding and after, mean over cameras, what is drawn not rounded."""

    plane: Plane
    uncoded: float
    coded: float


def fit_plane(
    shots: Shots,
    settings: PlaneSettings,
    name: str,
    rounds: int = ROUNDS,
    grid: NDArray[np.int64] | None = None,
    work: Path | None = None,
    progress: Progress | None = None,
) -> Fitted:
    """Fit and code one plane. grid: (rows, columns) camera indices where they stand on a regular array, -1 where none
    stands, None where they do not. Raises CaptureError `nothing-seen` where no camera covers a pixel."""
    surface = shots.surface
    finers = Finers(
        None if settings.mean == surface.size else make_finer(surface, settings.mean),
        make_finer(surface, settings.grid),
    )
    channels = len(settings.matrix)
    grey = np.full((channels, *settings.mean), 0.5, np.float32) * settings.matrix.sum(axis=1)[:, None, None]
    model = Model(settings.matrix, grey.astype(np.float32), settings.grid, [])
    tick = _ticker(progress, f"fit {name}", 4 + 2 * rounds)
    scales = measure_scales(shots, model, finers)
    if not scales.mean.any():
        raise CaptureError(
            "nothing-seen",
            "no camera sees any texel of the proxy",
            remedy="bring mesh and cameras into one frame (eigenfield inspect --overlay shows both); look at the masks",
        )
    fit_textures(shots, model, finers, scales, MEAN_STEPS, settings.step, mean_only=True)
    tick()
    count = min(settings.textures, len(shots) - 1)
    if count:
        rows, columns = settings.grid
        model.blocks = [principal_block(shots, model, finers, scales, count, (0, rows, 0, columns), work)]
        whiten(model, scales)
    tick()
    best = _measure(shots, model, finers)
    for number in range(rounds if count else 0):
        fit_textures(shots, model, finers, scales, TEXTURE_STEPS, settings.step)
        tick()
        fit_weights(shots, model, finers, WEIGHT_STEPS, settings.step)
        whiten(model, scales)
        reached = _measure(shots, model, finers)
        tick()
        log.info("%s, round %d: %.2f dB (%.2f before)", name, number + 1, reached, best)
        gained, best = reached - best, max(best, reached)
        if gained < STOP:
            break
    fitted = _code(shots, model, finers, scales, settings, grid)
    tick(last=True)
    return replace(fitted, uncoded=best)


def _weight_steps(block: Block, scales: Scales) -> NDArray[np.float32]:
    """(n,) steps so that a weight's error moves all pictures alike: in inverse proportion to what its component draws,
    the root mean square over a picture's pixels."""
    share = scales.coarse[block.window]
    drawn = np.sqrt((np.square(block.textures) * share).sum(axis=(1, 2, 3)) / max(float(scales.coarse.sum()), 1e-12))
    return np.clip(WEIGHT_STEP / np.maximum(drawn, 1e-9), 1e-3, WEIGHT_STEP_MOST).astype(np.float32)


def _code(
    shots: Shots,
    model: Model,
    finers: Finers,
    scales: Scales,
    settings: PlaneSettings,
    grid: NDArray[np.int64] | None = None,
) -> Fitted:
    """Closed loop: textures coded, weights and mean fitted to them, the mean coded."""
    bases: list[Basis] = []
    for block in model.blocks:
        coded = code_basis(_basis(block, settings.grid), settings.texture_step, settings.preset)
        block.textures = np.ascontiguousarray(coded.values().transpose(0, 3, 1, 2))
        bases.append(coded)
    if bases:
        fit_weights(shots, model, finers, WEIGHT_STEPS, settings.step)
        for number, block in enumerate(model.blocks):
            stream, block.weights = code_weights(block.weights, _weight_steps(block, scales), grid)
            bases[number] = with_weights(bases[number], block.weights, stream)
    fit_textures(shots, model, finers, scales, CLOSING_STEPS, settings.step, mean_only=True)
    mean = np.ascontiguousarray(model.mean.transpose(1, 2, 0))
    plane = code_plane(mean, tuple(bases), settings.mean_step, settings.preset)
    model.mean = np.ascontiguousarray(plane.mean.transpose(2, 0, 1))
    return Fitted(plane, 0.0, _measure(shots, model, finers))


def _basis(block: Block, grid: tuple[int, int]) -> Basis:
    """A block as a scene has it."""
    textures = np.ascontiguousarray(block.textures.transpose(0, 2, 3, 1))
    ones = np.ones((block.count, textures.shape[3]), np.float32)
    top, _, left, _ = block.rectangle
    part = textures.shape[1:3] != grid
    return Basis(textures, ones, np.zeros_like(ones), block.weights, grid if part else None, (top, left))


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


def _measure(shots: Shots, model: Model, finers: Finers) -> float:
    found = look(
        shots, model, finers, mean=model.mean, textures=[block.textures for block in model.blocks],
        weights=[block.weights for block in model.blocks], photographs=True, wanted=(False, False, False),
    )  # fmt: skip
    return psnr_of(found.squares, found.pixels, model.channels)
