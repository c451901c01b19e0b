"""Descent by a pyramid of corrections: coarse ones move whole regions of a layer at once.

A layer is its start plus corrections on grids, each half as fine as the one before, interpolated bilinearly. Adam moves
the corrections of all grids. What is kept is their sum and, for each grid, Adam's running means.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from eigenfield.stereo.multiplane.kernels import adam_step, prolong, restrict

MEAN_DECAY = 0.9
SQUARE_DECAY = 0.99
MIN_GRID_TEXELS = 2

Interpolation = tuple[NDArray[np.int64], NDArray[np.float32]]


@dataclass(frozen=True, eq=False)
class Corrections:
    """Corrections of one density for one layer, C numbers a texel.

    Attributes:
        step: (h, w, C) float32, the gradient and then the step.
        mean: (h, w, C) running mean of the gradient.
        square: (h, w, C) running mean of its square.
        taps: From this grid to the finer one before: along rows, along columns; empty for the finest.
    """

    step: NDArray[np.float32]
    mean: NDArray[np.float32]
    square: NDArray[np.float32]
    taps: tuple[NDArray[np.int64] | NDArray[np.float32], ...]


class Pyramid:
    """The corrections of one layer.

    Attributes:
        gradient: (h, w, C) float32, of the layer: what `step` starts from, and what it leaves the step in.
    """

    def __init__(self, shape: tuple[int, int], channels: int, levels: int) -> None:
        """Corrections of zero.

        Args:
            levels: Number of grids, the layer's own among them.
        """
        self._grids = [_corrections((*shape, channels), ())]
        for _ in range(levels - 1):
            fine = self._grids[-1].step.shape[:2]
            coarse = max(MIN_GRID_TEXELS, fine[0] // 2), max(MIN_GRID_TEXELS, fine[1] // 2)
            rows, columns = interpolation(fine[0], coarse[0]), interpolation(fine[1], coarse[1])
            self._grids.append(_corrections((*coarse, channels), (*rows, *columns)))
        self.gradient = self._grids[0].step

    def step(self, number: int) -> None:
        """Turn the gradient into the layer's step at a rate of 1.

        Args:
            number: Of this step, from 1 on.
        """
        decays = np.array([MEAN_DECAY, SQUARE_DECAY], np.float32)
        corrections = (1 / (1 - np.array([MEAN_DECAY, SQUARE_DECAY]) ** number)).astype(np.float32)
        for fine, coarse in pairwise(self._grids):
            restrict(fine.step, *coarse.taps, coarse.step)
        for grid in self._grids:
            adam_step(grid.step.reshape(-1), grid.mean.reshape(-1), grid.square.reshape(-1), *decays, *corrections)
        for fine, coarse in reversed(list(pairwise(self._grids))):
            prolong(coarse.step, *coarse.taps, fine.step)


def _corrections(shape: tuple[int, int, int], taps: tuple[NDArray[np.int64] | NDArray[np.float32], ...]) -> Corrections:
    step, mean, square = np.zeros((3, *shape), np.float32)
    return Corrections(step, mean, square, taps)


def interpolation(fine: int, coarse: int) -> Interpolation:
    """For each of `fine` texels along a line, the coarse texel before it and the weight of the next.

    Args:
        coarse: Texels of the coarser one, at least two.
    """
    place = np.clip((np.arange(fine) + 0.5) * coarse / fine - 0.5, 0, coarse - 1)
    at = np.minimum(place.astype(np.int64), coarse - 2)
    return at, (place - at).astype(np.float32)
