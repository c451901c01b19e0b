"""Plane sweep: how well the photographs agree on each of a series of labels, at every pixel of a reference view."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.sweep_kernels import SWEEP_COST_UNITS_PER_LEVEL, SWEEP_EXCLUDED_COST, sweep_rows
from eigenfield.stereo.views import Pictures, check_matrices, label_parallax, pack_pictures, parallax_sectors
from eigenfield.stereo.visibility import flatten_buffers

SWEEP_ROWS_PER_TASK = 4
SWEEP_MAX_DIFFERENCE_LEVELS = 30.0  # a larger difference counts as this


def plane_sweep(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    labels: NDArray[np.float32],
    *,
    reference: NDArray[np.uint8] | NDArray[np.float32] | None = None,
    known: NDArray[np.bool_] | None = None,
    mask: NDArray[np.bool_] | None = None,
    floor: NDArray[np.float32] | None = None,
    ceiling: NDArray[np.float32] | None = None,
    buffers: NDArray[np.float32] | None = None,
    bias: float = 0.12,
    half_plane_fraction: float = 0.4,
    max_difference: float = SWEEP_MAX_DIFFERENCE_LEVELS,
    min_views: int = 2,
    unseen_cost: float | None = None,
) -> NDArray[np.uint8]:
    """The matching cost of every label at every pixel.

    The equations are those of `sweep_rows`. Memory: one byte a pixel and label.

    Args:
        reference: (h, w, 3) the reference camera's own picture. Without it, colours are compared with the views' robust
            mean.
        known: (h, w) where `reference` is valid. Default: everywhere.
        mask: (h, w) pixels to process. The others get 255 throughout.
        floor: (h, w) lowest label tried at each pixel.
        ceiling: (h, w) highest label tried.
        buffers: (V, H, W) depth buffers that hide points.
        half_plane_fraction: The cost is the least mean over half-planes of parallax directions that hold at least this
            fraction of the visible views; 1: over all views.
        max_difference: Grey levels at which differences are cut off.
        min_views: Views that must see a point. Otherwise its cost is `unseen_cost`.
        unseen_cost: Grey levels. Default: 0.7 times `max_difference`.

    Returns:
        (h, w, L) costs in eighths of a grey level (0..254); 255 marks labels that were not tried and may not be taken.

    Raises:
        ValueError: Pictures or matrices are malformed, or `max_difference` does not fit a byte.
    """
    packed = pack_pictures(pictures)
    count, height, width = packed.shape
    matrices = check_matrices(matrices, count)
    if not 0 < max_difference * float(SWEEP_COST_UNITS_PER_LEVEL) < SWEEP_EXCLUDED_COST:
        raise ValueError(
            f"max_difference must be under {SWEEP_EXCLUDED_COST / float(SWEEP_COST_UNITS_PER_LEVEL)} grey levels"
        )
    sorted_labels = np.ascontiguousarray(labels, np.float32)
    low, high = _label_ranges(shape, sorted_labels, mask, floor, ceiling)
    if reference is None:
        reference, known = np.zeros((*shape, 3), np.float32), np.zeros(shape, np.bool_)
    if known is None:
        known = np.ones(shape, np.bool_)
    sector = parallax_sectors(label_parallax(matrices, shape, float(np.median(sorted_labels))))
    out = np.full((*shape, len(sorted_labels)), SWEEP_EXCLUDED_COST, np.uint8)
    fixed = (
        packed.reshape(count, -1), flatten_buffers(buffers, count), matrices, sector, height, width,
        np.ascontiguousarray(reference, np.float32), np.ascontiguousarray(known), sorted_labels, low, high,
        np.float32(max_difference), np.float32(min_views), np.float32(half_plane_fraction),
        np.float32(0.7 * max_difference if unseen_cost is None else unseen_cost), np.float32(bias), out,
    )  # fmt: skip
    parallel_map(lambda rows: sweep_rows(*rows, *fixed), pieces(shape[0], SWEEP_ROWS_PER_TASK))
    return out


def _label_ranges(
    shape: tuple[int, int],
    labels: NDArray[np.float32],
    mask: NDArray[np.bool_] | None,
    floor: NDArray[np.float32] | None,
    ceiling: NDArray[np.float32] | None,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Indices [low, high) of the labels that each pixel may try."""
    low, high = np.zeros(shape, np.int32), np.full(shape, len(labels), np.int32)
    if floor is not None:
        low[:] = np.searchsorted(labels, floor, side="left")
    if ceiling is not None:
        high[:] = np.searchsorted(labels, ceiling, side="right")
    if mask is not None:
        high[~mask] = 0
    return low, np.maximum(high, low)
