"""Plane sweep: how well the photographs agree on each of a row of depth labels, at every pixel of a canvas."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.sweep_kernels import NEVER, UNIT, sweep_rows
from eigenfield.stereo.views import Pictures, check_matrices, motion, pack, sectors

BAND = 4  # rows a thread takes at a time
MOST = 30.0  # grey levels: a difference larger than this counts as this


def sweep(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    labels: NDArray[np.float32],
    *,
    reference: NDArray[np.uint8] | NDArray[np.float32] | None = None,
    known: NDArray[np.bool_] | None = None,
    todo: NDArray[np.bool_] | None = None,
    floor: NDArray[np.float32] | None = None,
    ceiling: NDArray[np.float32] | None = None,
    buffers: NDArray[np.float32] | None = None,
    bias: float = 0.12,
    best: float = 0.4,
    most: float = MOST,
    fewest: int = 2,
    unseen: float | None = None,
    free: float = 0.0,
) -> NDArray[np.uint8]:
    """(h, w, L) costs in eighths of a grey level (0..254); 255 marks labels that were not tried and may not be taken.

    pictures, matrices: the views, (V, H, W, 3) uint8 or packed, (V, 3, 4) from (x, y, d, 1) to index coordinates.
    labels: (L,) rising. reference: (h, w, 3), the canvas camera's own picture where `known` (h, w) (default:
        everywhere, if a reference is given); elsewhere colours are compared with the views' own robust centre.
    todo: pixels to look at; the others are 255 throughout. floor, ceiling: (h, w), only labels between them.
    buffers: (V, H, W) depth buffers: points more than `bias` behind them are hidden. best: the cost is the least mean
        over half-planes of parallax directions that hold at least this part of the views that look; 1: over all views.
    most: grey levels at which differences are cut. fewest: views that must look; otherwise the cost is `unseen` grey
        levels (default: `most` times 0.7).

    free: 0 measures the distance from the centre, 1 the spread about the views' own mean.

    Equations: `sweep_kernels.sweep_rows`. Memory: one byte a pixel and label.
    """
    packed = pack(pictures)
    count, height, width = packed.shape
    matrices = check_matrices(matrices, count)
    if not 0 < most * float(UNIT) < NEVER:
        raise ValueError(f"most must be under {NEVER / float(UNIT)} grey levels")
    sorted_labels = np.ascontiguousarray(labels, np.float32)
    low, high = _ranges(shape, sorted_labels, todo, floor, ceiling)
    if reference is None:
        reference, known = np.zeros((*shape, 3), np.float32), np.zeros(shape, np.bool_)
    if known is None:
        known = np.ones(shape, np.bool_)
    empty = np.zeros((count, 0), np.float32)
    flat_buffers = empty if buffers is None else np.ascontiguousarray(buffers, np.float32).reshape(count, -1)
    sector = sectors(motion(matrices, shape, float(np.median(sorted_labels))))
    out = np.full((*shape, len(sorted_labels)), NEVER, np.uint8)
    fixed = (
        packed.reshape(count, -1), flat_buffers, matrices, sector, height, width,
        np.ascontiguousarray(reference, np.float32), np.ascontiguousarray(known), sorted_labels, low, high,
        np.float32(most), np.float32(fewest), np.float32(best), np.float32(0.7 * most if unseen is None else unseen),
        np.float32(bias), np.float32(free),
    )  # fmt: skip
    parallel_map(lambda rows: sweep_rows(rows[0], rows[1], *fixed, out), pieces(shape[0], BAND))
    return out


def _ranges(
    shape: tuple[int, int],
    labels: NDArray[np.float32],
    todo: NDArray[np.bool_] | None,
    floor: NDArray[np.float32] | None,
    ceiling: NDArray[np.float32] | None,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Indices [low, high) of the labels that each pixel may try."""
    low, high = np.zeros(shape, np.int32), np.full(shape, len(labels), np.int32)
    if floor is not None:
        low[:] = np.searchsorted(labels, floor, side="left")
    if ceiling is not None:
        high[:] = np.searchsorted(labels, ceiling, side="right")
    if todo is not None:
        high[~todo] = 0
    return low, np.maximum(high, low)
