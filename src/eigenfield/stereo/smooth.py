"""Smoothing of depth where the photographs leave it open: local planes that stop at edges."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.smooth_kernels import fit_planes

SMOOTH_ROWS_PER_TASK = 8
SMOOTH_MIN_WEIGHT = 1e-3  # of any point: an uncertain neighbourhood still has a mean


def smooth_depth(
    d: NDArray[np.float32],
    confidence: NDArray[np.float32],
    guide: NDArray[np.float32],
    *,
    half_confidence: float = 300.0,
    spacings: Sequence[int] = (8, 4, 2, 1),
    radius: int = 4,
    colour_scale: float = 60.0,
    depth_scale: float = 0.12,
    relaxed_colour_scale: float = 60.0,
    relaxed_depth_scale: float = 0.5,
) -> NDArray[np.float32]:
    """Depth after edge-aware local plane fits (`fit_planes`), with taps 8, 4, 2 and 1 pixels apart.

    Wide taps move only uncertain points.

    Args:
        d: (h, w) labels.
        confidence: (h, w) of each point.
        guide: (h, w, 3) grey levels; planes stop at its edges.
        half_confidence: Confidence at which a point's weight is 1/2.
        spacings: Distance of the taps of each pass, pixels.
        radius: A fit has (2 radius + 1)^2 taps.
        colour_scale: Grey levels, summed over the channels, at which the weight of a tap falls by e.
        depth_scale: Labels off the plane at which the weight of a tap falls to a quarter.
        relaxed_colour_scale: Added to `colour_scale` where the point itself is uncertain.
        relaxed_depth_scale: Added to `depth_scale` there.
    """
    d = np.ascontiguousarray(d, np.float32)
    positive = np.maximum(np.ascontiguousarray(confidence, np.float32), np.float32(0))
    sure = np.maximum(positive / (positive + np.float32(half_confidence)), np.float32(SMOOTH_MIN_WEIGHT))
    colours = np.ascontiguousarray(np.moveaxis(np.asarray(guide, np.float32), 2, 0))
    for spacing in spacings:
        out = np.empty_like(d)
        scales = [np.float32(scale) for scale in (colour_scale, depth_scale, relaxed_colour_scale, relaxed_depth_scale)]
        fixed = (d, sure, colours, radius, spacing, *scales, out)
        parallel_map(partial(_fit_rows, fixed), pieces(d.shape[0], SMOOTH_ROWS_PER_TASK))
        d = out
    return d


def _fit_rows(fixed: tuple[Any, ...], rows: tuple[int, int]) -> None:
    fit_planes(*rows, *fixed)
