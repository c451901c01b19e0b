"""Upsampling of textures: Catmull-Rom from a coarse atlas to the texels of a fine one, both cut into tiles."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from eigenfield.rendering.software.kernels import TILE_TEXELS
from eigenfield.rendering.software.resample_kernels import mark_read


@dataclass(frozen=True, eq=False)
class Taps:
    """Along one axis, for each of n fine texels, the four coarse ones that it is interpolated from.

    Attributes:
        at: (n, 4) int32 coarse texels, clamped to the atlas.
        weight: (n, 4) float32, summing to 1.
        first: (tiles,) int64 for each tile of the fine atlas the first coarse tile that it reads.
        last: (tiles,) int64 and the last.
        base: (n,) int64 the first of the four, before it is clamped.
    """

    at: NDArray[np.int32]
    weight: NDArray[np.float32]
    first: NDArray[np.int64]
    last: NDArray[np.int64]
    base: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class TileUpsampler:
    """From a coarse atlas to the tiles of a fine one.

    Attributes:
        first: (tile columns,) int64 for each column of tiles the first coarse column that it reads, before clamping.
        count: (tile columns,) int64 how many it reads.
        matrix: (tile columns, most, TILE_TEXELS) float32 how much of each its texels take.
    """

    rows: Taps
    columns: Taps
    first: NDArray[np.int64]
    count: NDArray[np.int64]
    matrix: NDArray[np.float32]


def make_tile_upsampler(fine: tuple[int, int], coarse: tuple[int, int]) -> TileUpsampler:
    """An upsampler.

    Args:
        fine: (rows, columns) of the fine atlas.
        coarse: (rows, columns) of the coarse atlas.
    """
    rows, columns = make_taps(fine[0], coarse[0]), make_taps(fine[1], coarse[1])
    starts = np.arange(0, fine[1], TILE_TEXELS)
    first = columns.base[starts]
    count = columns.base[np.minimum(starts + TILE_TEXELS, fine[1]) - 1] + 4 - first
    matrix = np.zeros((len(first), int(count.max()), TILE_TEXELS), np.float32)
    texel = np.arange(fine[1])
    tile = texel // TILE_TEXELS
    at = (columns.base - first[tile])[:, None] + np.arange(4)
    matrix[tile[:, None], at, (texel % TILE_TEXELS)[:, None]] = columns.weight
    return TileUpsampler(rows, columns, first, count, matrix)


def make_taps(fine: int, coarse: int) -> Taps:
    """Fine texel i lies at x = (i + 0.5) / fine * coarse - 0.5 among the coarse ones; Catmull-Rom (a = -1/2)."""
    x = (np.arange(fine) + 0.5) * (coarse / fine) - 0.5
    base = np.floor(x)
    weight = catmull_rom(x - base)
    at = np.clip(base[:, None] + np.arange(-1, 3), 0, coarse - 1).astype(np.int32)
    starts = np.arange(0, fine, TILE_TEXELS)
    ends = np.minimum(starts + TILE_TEXELS, fine) - 1
    first, last = at[starts, 0].astype(np.int64) // TILE_TEXELS, at[ends, 3].astype(np.int64) // TILE_TEXELS
    return Taps(at, weight.astype(np.float32), first, last, base.astype(np.int64) - 1)


def tap_matrix(fine: int, coarse: int) -> csr_array:
    """(fine, coarse) float32: the taps along an axis, to enlarge whole pictures."""
    taps = make_taps(fine, coarse)
    at = taps.at.ravel(), np.arange(0, taps.at.size + 1, taps.at.shape[1])
    return csr_array((taps.weight.ravel(), *at), (fine, coarse))


def catmull_rom(f: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 4) weights of the taps at distances 1 + f, f, 1 - f, 2 - f, for f (n,) in 0..1."""
    f2, f3 = f * f, f * f * f
    taps = [2 * f2 - f3 - f, 3 * f3 - 5 * f2 + 2, 4 * f2 - 3 * f3 + f, f3 - f2]
    return np.stack(taps, axis=1) / 2


def tiles_reading(read: NDArray[np.bool_], rows: Taps, columns: Taps) -> NDArray[np.bool_]:
    """(tile rows, tile columns) bool, the fine tiles that read any of these (tile rows, tile columns) coarse ones."""
    sums = np.zeros((read.shape[0] + 1, read.shape[1] + 1), np.int64)
    sums[1:, 1:] = read.cumsum(axis=0).cumsum(axis=1)
    band = sums[rows.last + 1] - sums[rows.first]
    return np.asarray(band[:, columns.last + 1] > band[:, columns.first])


def tiles_read(needed: NDArray[np.bool_], rows: Taps, columns: Taps, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """(tile rows, tile columns) bool, the coarse tiles that fine ones read.

    Args:
        needed: (tile rows, tile columns) the fine tiles.
        shape: (tile rows, tile columns) of the coarse atlas.
    """
    found = np.zeros(shape, np.bool_)
    mark_read(needed, rows.first, rows.last, columns.first, columns.last, found)
    return found
