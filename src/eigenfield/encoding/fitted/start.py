"""Where a fit begins: the paper's decomposition, of what the mean leaves of each photograph, on the coarse grid.

Rectangles in which eigen textures of the whole atlas leave most get components and weights of their own.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.kernels import adjoint, forward
from eigenfield.encoding.fitted.model import Block, PlaneModel, Rectangle
from eigenfield.encoding.fitted.observations import FitData
from eigenfield.encoding.fitted.passes import MINUS, PASS_TASKS
from eigenfield.encoding.fitted.products import combine, one_blas_thread, weighted_gram
from eigenfield.encoding.fitted.solve import Scales
from eigenfield.encoding.spread import push_pull
from eigenfield.runtime.files import scratch_array
from eigenfield.runtime.parallel import even_pieces, parallel_map

MAP_MIN_SHARE_RATIO = 0.2  # of a texel's median share in one picture: residuals are divided by no smaller one
# Of the mean, in texels that a camera in no array does not see: what it sees goes on beyond its border and fades within
# about 16 texels. Chosen on Temple
FADE_WEIGHT = 0.02
REGION_BLOCK_TEXELS = 8  # side of a block: rectangles are made of whole blocks
REGION_EXCESS_RATIO = 2.0  # of the mean squared error over all pixels: only what lies above it speaks for a region
REGION_MIN_ERROR_RATIO = 0.1  # of all squared error that a region must have in excess
REGION_MAX_COUNT = 3
REGION_MAX_PIXEL_RATIO = 0.4  # of the pixels seen


@dataclass(frozen=True, eq=False)
class ResidualMaps:
    """What a model leaves of each photograph, on a rectangle of the components' grid.

    Attributes:
        values: (No, C h w) float32.
        shape: C, h, w.
        share: (C h w,) the square root of how much of the pictures each texel answers for.
    """

    values: NDArray[np.float32]
    shape: tuple[int, int, int]
    share: NDArray[np.float32]

    @one_blas_thread
    def gram(self) -> NDArray[np.float64]:
        """(No, No) inner products of the maps, which are plain sums over texels.

        Frames of a clip that share their weights are decomposed by the sum of their matrices, which may be made in any
        process.
        """
        return weighted_gram(self.values, self.share)

    @one_blas_thread
    def textures(self, weights: NDArray[np.float64]) -> NDArray[np.float32]:
        """(N, C, h, w) eigen textures for weights (No, N) of mean square 1: the maps projected on them."""
        textures = np.zeros((weights.shape[1], self.values.shape[1]), np.float32)
        combine((weights.T / len(weights)).astype(np.float32), self.values, textures)
        return textures.reshape(-1, *self.shape)


@contextlib.contextmanager
def open_residual_maps(
    data: FitData, model: PlaneModel, scales: Scales, rectangle: Rectangle, scattered: bool, work: Path | None = None
) -> Iterator[ResidualMaps]:
    """What the model leaves of the photographs, in a scratch file of 4 bytes an observation and number.

    Each observation's residual is put into the texture by the transpose of drawing, divided by what the observation
    has there. What it does not see is zero, which is the mean, as equation 2 fills it. Where cameras stand in no array
    the residual fades to that: with nearly as many components as cameras, what is not seen stays as it begins, and a
    step at the border of a photograph takes bytes and shows in the views between.
    """
    top, bottom, left, right = rectangle
    shape = (model.channels, bottom - top, right - left)
    seen = scales.coarse[scales.coarse > 0]
    floor = np.float32(MAP_MIN_SHARE_RATIO * (float(np.median(seen)) if len(seen) else 1.0) / len(data))
    share = np.tile(np.sqrt(scales.coarse[top:bottom, left:right]).reshape(-1), model.channels)
    with scratch_array((len(data), int(np.prod(shape))), np.float32, work) as maps:

        def put(index: int) -> None:
            whole = _residual_map(data, model, index, floor, scattered)
            maps[index] = whole[:, top:bottom, left:right].reshape(-1)

        one_blas_thread(parallel_map)(put, range(len(data)))
        yield ResidualMaps(maps, shape, share)


@one_blas_thread
def principal_weights(gram: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """(No, count) weights of mean square 1 of the strongest components, by falling eigenvalue of a Gram matrix."""
    _, vectors = np.linalg.eigh(gram)
    return vectors[:, ::-1][:, :count] * np.sqrt(len(gram))


@one_blas_thread
def principal_block(
    data: FitData,
    model: PlaneModel,
    scales: Scales,
    count: int,
    rectangle: Rectangle,
    scattered: bool,
    work: Path | None = None,
) -> Block:
    """Eigen textures of what the model leaves of the photographs (`open_residual_maps`), `count` of them."""
    with open_residual_maps(data, model, scales, rectangle, scattered, work) as maps:
        weights = principal_weights(maps.gram(), count)
        return Block(rectangle, maps.textures(weights), weights.astype(np.float32))


@one_blas_thread
def residual_energy(data: FitData, model: PlaneModel) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(h, w) of the grid: the squared error that a texel answers for, and the pixels, over all observations."""

    def piece(part: tuple[int, int]) -> NDArray[np.float32]:
        added = np.zeros((2, *model.grid), np.float32)
        for index in range(*part):
            image = residual_image(data, model, index)
            both = np.stack([np.square(image).sum(axis=0), np.ones(image.shape[1:], np.float32)])
            adjoint(*data.footprint(index), data.size, both, data.observations.weights(index), added)
        return added

    total = np.zeros((2, *model.grid), np.float32)
    for added in parallel_map(piece, even_pieces(len(data), PASS_TASKS)):
        total += added
    energy, seen = np.maximum(total, 0)
    return energy, seen


def residual_image(data: FitData, model: PlaneModel, index: int) -> NDArray[np.float32]:
    """(C, h, w): what is left of a photograph."""
    footprint, image = data.footprint(index), data.target(index, model.matrix)
    forward(*footprint, data.size, model.mean, MINUS, image)
    if any(block.count for block in model.blocks):
        forward(*footprint, data.size, model.sums(slice(index, index + 1))[0], MINUS, image)
    return image


def _residual_map(
    data: FitData, model: PlaneModel, index: int, floor: np.float32, scattered: bool
) -> NDArray[np.float32]:
    """(C, h, w): what is left of a photograph, on the grid."""
    footprint, weight = data.footprint(index), data.observations.weights(index)
    image = residual_image(data, model, index)
    back, part = np.zeros((model.channels, *model.grid), np.float32), np.zeros((1, *model.grid), np.float32)
    adjoint(*footprint, data.size, image, weight, back)
    adjoint(*footprint, data.size, np.ones((1, *image.shape[1:]), np.float32), weight, part)
    found = np.asarray(back / np.maximum(part, floor), np.float32)
    if not scattered:
        return found
    seen = part[0] > floor / 2
    known = np.ascontiguousarray(np.where(seen, found, np.float32(0)).transpose(1, 2, 0))
    filled = push_pull(known, np.where(seen, np.float32(1), np.float32(FADE_WEIGHT)))
    return np.where(seen, found, filled.transpose(2, 0, 1))


def find_regions(energy: NDArray[np.float32], seen: NDArray[np.float32]) -> list[Rectangle]:
    """Rectangles with far more squared error than their pixels' share, the one with most first; they do not overlap.

    Args:
        energy: (h, w) of the components' grid, squared error that a texel answers for.
        seen: (h, w) pixels that it answers for.
    """
    height, width = energy.shape
    error, pixels = _blocks(energy), _blocks(seen)
    total = float(error.sum())
    if total <= 0:
        return []
    value = error - REGION_EXCESS_RATIO * total / float(pixels.sum()) * pixels
    found: list[Rectangle] = []
    for _ in range(REGION_MAX_COUNT):
        gain, (top, bottom, left, right) = best_rectangle(value)
        part = float(pixels[top:bottom, left:right].sum())
        if gain < REGION_MIN_ERROR_RATIO * total or part > REGION_MAX_PIXEL_RATIO * float(pixels.sum()):
            break
        rows = top * REGION_BLOCK_TEXELS, min(bottom * REGION_BLOCK_TEXELS, height)
        columns = left * REGION_BLOCK_TEXELS, min(right * REGION_BLOCK_TEXELS, width)
        found.append((*rows, *columns))
        value[top:bottom, left:right] = -total
    return found


def _blocks(values: NDArray[np.float32]) -> NDArray[np.float64]:
    """Sums over REGION_BLOCK_TEXELS x REGION_BLOCK_TEXELS texels, the last ones over what is left."""
    rows, columns = (np.arange(0, side, REGION_BLOCK_TEXELS) for side in values.shape)
    return np.add.reduceat(np.add.reduceat(values.astype(np.float64), rows, axis=0), columns, axis=1)


def best_rectangle(value: NDArray[np.float64]) -> tuple[float, Rectangle]:
    """The rectangle of largest sum, and its sum: for each pair of rows, Kadane's scan along the columns."""
    height, width = value.shape
    below = np.vstack([np.zeros((1, width)), np.cumsum(value, axis=0)])
    best, found = -np.inf, (0, 1, 0, 1)
    for top in range(height):
        # All rectangles that begin at this row, one row of `runs` for each bottom
        runs = np.cumsum(np.pad(below[top + 1 :] - below[top], ((0, 0), (1, 0))), axis=1)
        least = np.minimum.accumulate(runs[:, :-1], axis=1)
        sums = runs[:, 1:] - least
        at = int(sums.argmax())
        row, right = divmod(at, width)
        if sums[row, right] > best:
            left = int(runs[row, : right + 1].argmin())
            best, found = float(sums[row, right]), (top, top + 1 + row, left, right + 1)
    return best, found
