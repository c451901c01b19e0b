"""Smoothing of depth where the photographs leave it open: local planes that stop at edges."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.smooth_kernels import fit_planes

SMOOTH_ROWS_PER_TASK = 8
SMOOTH_MIN_WEIGHT = 1e-3  # of any point: an uncertain neighbourhood still has a mean
SMOOTH_SPACINGS_PIXELS = (8, 4, 2, 1)  # distance of the taps of each pass
SMOOTH_RADIUS_TAPS = 4  # a fit has (2 radius + 1)^2 taps
SMOOTH_COLOUR_SCALE_LEVELS = 60.0  # summed over the channels: there the weight of a tap falls by e
SMOOTH_LOOSE_COLOUR_SCALE_LEVELS, SMOOTH_LOOSE_DEPTH_SCALE_LABELS = 60.0, 0.5  # added where a point is uncertain


def smooth_depth(
    d: NDArray[np.float32],
    confidence: NDArray[np.float32],
    guide: NDArray[np.float32],
    *,
    half_confidence: float = 300.0,
    depth_scale: float = 0.12,
) -> NDArray[np.float32]:
    """Depth after edge-aware local plane fits (`fit_planes`), with taps 8, 4, 2 and 1 pixels apart.

    Wide taps move only uncertain points.

    Args:
        guide: (h, w, 3) grey levels; planes stop at its edges.
        half_confidence: Confidence at which a point's weight is 1/2.
        depth_scale: Labels off the plane at which the weight of a tap falls to a quarter.
    """
    d = np.ascontiguousarray(d, np.float32)
    positive = np.maximum(np.ascontiguousarray(confidence, np.float32), np.float32(0))
    sure = np.maximum(positive / (positive + np.float32(half_confidence)), np.float32(SMOOTH_MIN_WEIGHT))
    colours = np.ascontiguousarray(np.moveaxis(np.asarray(guide, np.float32), 2, 0))
    loose = SMOOTH_LOOSE_COLOUR_SCALE_LEVELS, SMOOTH_LOOSE_DEPTH_SCALE_LABELS
    scales = [np.float32(scale) for scale in (SMOOTH_COLOUR_SCALE_LEVELS, depth_scale, *loose)]
    for spacing in SMOOTH_SPACINGS_PIXELS:
        out = np.empty_like(d)
        fixed = (d, sure, colours, SMOOTH_RADIUS_TAPS, spacing, *scales, out)
        parallel_map(partial(_fit_rows, fixed), pieces(d.shape[0], SMOOTH_ROWS_PER_TASK))
        d = out
    return d


def _fit_rows(fixed: tuple[Any, ...], rows: tuple[int, int]) -> None:
    fit_planes(*rows, *fixed)
