"""Where eigen textures of the whole atlas leave most: rectangles that get components and weights of their own."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.model import Rectangle

REGION_BLOCK_TEXELS = 8  # side of a block: rectangles are made of whole blocks
REGION_EXCESS_RATIO = 2.0  # of the mean squared error over all pixels: only what lies above it speaks for a region
REGION_MIN_ERROR_RATIO = 0.1  # of all squared error that a region must have in excess
REGION_MAX_COUNT = 3
REGION_MAX_PIXEL_RATIO = 0.4  # of the pixels seen


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
        found.append(
            (
                top * REGION_BLOCK_TEXELS,
                min(bottom * REGION_BLOCK_TEXELS, height),
                left * REGION_BLOCK_TEXELS,
                min(right * REGION_BLOCK_TEXELS, width),
            )
        )
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
