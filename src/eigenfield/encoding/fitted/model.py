"""What is fitted: one plane's mean at the finest density and its components at a coarser one, planar and as numbers."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.kernels import upsample
from eigenfield.encoding.fitted.products import combine
from eigenfield.rendering.software.drawing import Surface
from eigenfield.rendering.software.kernels import TILE_TEXELS
from eigenfield.rendering.software.resample import Taps, make_taps

NO_START = np.zeros((0, 0, 0), np.float32)
MEAN_ALONE_GRID = (1, 1)  # of a model that has no components, nor gets any

Rectangle = tuple[int, int, int, int]  # [top, bottom) x [left, right), in texels of the components' grid


@dataclass(eq=False)
class Block:
    """Components with one region.

    Attributes:
        textures: (n, C, rows, columns) float32.
        weights: (No, n) float32, a row for each observation.
    """

    rectangle: Rectangle
    textures: NDArray[np.float32]
    weights: NDArray[np.float32]

    @property
    def count(self) -> int:
        return len(self.textures)

    @property
    def window(self) -> tuple[slice, slice]:
        """Rows and columns of the grid."""
        top, bottom, left, right = self.rectangle
        return slice(top, bottom), slice(left, right)


@dataclass(eq=False)
class PlaneModel:
    """A plane in the making.

    Attributes:
        matrix: (C, 3) float32, its channels from R, G, B.
        mean: (C, rows, columns) float32.
        grid: (h, w) of the components.
        blocks: the components, summed onto the mean.
    """

    matrix: NDArray[np.float32]
    mean: NDArray[np.float32]
    grid: tuple[int, int]
    blocks: list[Block]

    @classmethod
    def grey(cls, matrix: NDArray[np.float32], size: tuple[int, int]) -> PlaneModel:
        """A mean of one grey without components: one channel of `matrix` (1, 3), of `size` (rows, columns)."""
        return cls(matrix, np.full((1, *size), 0.5, np.float32), MEAN_ALONE_GRID, [])

    @property
    def channels(self) -> int:
        return len(self.matrix)

    def sums(self, observations: slice) -> NDArray[np.float32]:
        """(B, C, h, w) float32: the weighted sum of all components for some observations."""
        weights = [block.weights[observations] for block in self.blocks]
        total = np.empty((len(weights[0]) if weights else 0, self.channels, *self.grid), np.float32)
        sum_up(self, [block.textures for block in self.blocks], weights, total)
        return total


def sum_up(
    model: PlaneModel,
    textures: list[NDArray[np.float32]],
    weights: list[NDArray[np.float32]],
    total: NDArray[np.float32],
) -> None:
    """As `PlaneModel.sums`, of textures and weights, (B, n) each, in the model's blocks, into `total` (contiguous)."""
    parts = [part for part in zip(model.blocks, textures, weights, strict=True) if part[0].count]
    if parts and parts[0][1].shape[2:] == model.grid:
        _, some, mine = parts.pop(0)
        combine(mine, some.reshape(len(some), -1), total.reshape(len(total), -1))
    else:
        total[:] = 0
    for block, some, mine in parts:
        total[:, :, *block.window] += (mine @ some.reshape(len(some), -1)).reshape(len(mine), *some.shape[1:])


@dataclass(frozen=True, eq=False)
class Upsampler:
    """From a coarse atlas to the finest one, by Catmull-Rom.

    Attributes:
        spans: (H, 2) columns in use, see the kernel.
        coarse: (rows, columns) of the coarse atlas.
        fine: (rows, columns) of the fine atlas.
    """

    rows: Taps
    columns: Taps
    spans: NDArray[np.int64]
    coarse: tuple[int, int]
    fine: tuple[int, int]

    def up(self, coarse: NDArray[np.float32], fine: NDArray[np.float32], start: NDArray[np.float32] = NO_START) -> None:
        """fine (C, H, W) = start + coarse (C, h, w) made finer, in the columns in use."""
        lines = np.zeros((self.coarse[0], self.fine[1]), np.float32)
        taps = (self.rows.at, self.rows.weight, self.columns.at, self.columns.weight)
        upsample(coarse, *taps, self.spans, lines, start, fine)


@dataclass(frozen=True, eq=False)
class AtlasComposer:
    """Mean and components as one texture of the finest atlas, as the renderers compose it.

    Attributes:
        mean: None where the mean is as fine as the atlas.
    """

    mean: Upsampler | None
    grid: Upsampler

    def fine_mean(self, mean: NDArray[np.float32]) -> NDArray[np.float32]:
        """(C, H, W): a mean as fine as the atlas."""
        if self.mean is None:
            return mean
        fine = np.zeros((len(mean), *self.grid.fine), np.float32)
        self.mean.up(mean, fine)
        return fine


def make_composer(surface: Surface, model: PlaneModel) -> AtlasComposer:
    """For a model drawn on `surface`."""
    shape = model.mean.shape[1:]
    mean = None if shape == surface.size else make_upsampler(surface, shape)
    return AtlasComposer(mean, make_upsampler(surface, model.grid))


def make_upsampler(surface: Surface, grid: tuple[int, int]) -> Upsampler:
    """Between `grid` and the atlas of `surface`, whose unused tiles are left out."""
    height, width = surface.size
    spans = np.zeros((height, 2), np.int64)
    for row in np.flatnonzero(surface.used.any(axis=1)):
        used = np.flatnonzero(surface.used[row])
        first, last = used[0] * TILE_TEXELS, min((used[-1] + 1) * TILE_TEXELS, width)
        spans[row * TILE_TEXELS : (row + 1) * TILE_TEXELS] = first, last
    return Upsampler(make_taps(height, grid[0]), make_taps(width, grid[1]), spans, grid, (height, width))
