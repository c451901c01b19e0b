"""Smoothing of depth where the photographs leave it open: local planes that stop at edges."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.smooth_kernels import fit_planes

BAND = 8
LEAST = 1e-3  # confidence that no point falls below: an unsure neighbourhood still has a mean


def smooth_depth(
    d: NDArray[np.float32],
    confidence: NDArray[np.float32],
    guide: NDArray[np.float32],
    *,
    half: float = 300.0,
    spacings: Sequence[int] = (8, 4, 2, 1),
    radius: int = 4,
    colour: float = 60.0,
    depth: float = 0.12,
    loose_colour: float = 60.0,
    loose_depth: float = 0.5,
) -> NDArray[np.float32]:
    """d after edge-aware local plane fits with taps 8, 4, 2 and 1 pixels apart.

    guide: (h, w, 3) grey levels. Wide taps move only what is unsure (confidence under `half`). colour: grey levels
    summed over the channels, depth: label units, at which a tap loses its say. Equation: `smooth_kernels.fit_planes`.
    """
    d = np.ascontiguousarray(d, np.float32)
    positive = np.maximum(np.ascontiguousarray(confidence, np.float32), np.float32(0))
    sure = np.maximum(positive / (positive + np.float32(half)), np.float32(LEAST))
    colours = np.ascontiguousarray(np.moveaxis(np.asarray(guide, np.float32), 2, 0))
    for spacing in spacings:
        out = np.empty_like(d)
        scales = [np.float32(scale) for scale in (colour, depth, loose_colour, loose_depth)]
        fixed = (d, sure, colours, radius, spacing, *scales, out)
        parallel_map(partial(_fit_rows, fixed), pieces(d.shape[0], BAND))
        d = out
    return d


def _fit_rows(fixed: tuple[Any, ...], rows: tuple[int, int]) -> None:
    fit_planes(*rows, *fixed)
