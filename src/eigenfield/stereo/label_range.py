"""The range of depth labels that a scene occupies, from a coarse sweep."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.stereo.detail import detail_pictures
from eigenfield.stereo.estimate import P1, P2, labels_over, reference_picture, spread_views
from eigenfield.stereo.semiglobal import semi_global
from eigenfield.stereo.sweep import MOST, sweep
from eigenfield.stereo.sweep_kernels import UNIT
from eigenfield.stereo.views import Pictures, halve, halved_matrices, motion, pack

LOOKED_AT = 25  # views
HALVINGS = 2
TRIMMED = 0.5  # per cent of the pixels that each end of the range may leave out
WIDENED = 0.05  # of the range, added at both ends
SOUND = 0.5  # a label's cost against the median of all labels', under which a pixel counts as matched
VISIBLE = 0.01  # of the pixels that must show any contrast
FEWEST = 0.15  # of those, the part that must have matched (noise: 0.06; a range that misses the scene: 0.07)


def depth_range(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    wide: tuple[float, float],
    *,
    labels: int = 128,
) -> tuple[float, float] | None:
    """(low, high) labels that hold the scene, from a sweep of `wide` at a quarter of the resolution.

    Only pixels count at which one label fits clearly better than most: flat paint fits anywhere. None if hardly any
    does: nothing in `wide` is consistent with the photographs.
    """
    packed = pack(pictures)
    chosen = spread_views(motion(matrices, shape, sum(wide) / 2), LOOKED_AT)
    small, coarse = packed[chosen], np.asarray(matrices, np.float64)[chosen]
    for _ in range(HALVINGS):
        small, coarse = halve(small), halved_matrices(coarse)
        shape = ((shape[0] + 1) // 2, (shape[1] + 1) // 2)
    tried = labels_over(*wide, (wide[1] - wide[0]) / (labels - 1))
    detail = detail_pictures(small)
    compared, known = reference_picture(detail, coarse, shape)
    seen, _ = reference_picture(small, coarse, shape)
    cost = sweep(detail, coarse, shape, tried, reference=compared if known.any() else None, known=known, unseen=MOST)
    d, _ = semi_global(cost, seen.mean(axis=-1).astype(np.float32), tried, P1, P2)
    nearest = np.abs(tried[None, None] - d[..., None]).argmin(axis=-1)
    at_best = np.take_along_axis(cost, nearest[..., None], axis=-1)[..., 0].astype(np.float32)
    usual = np.median(cost, axis=-1)
    ends = (nearest > 0) & (nearest < len(tried) - 1)
    contrast = usual > float(UNIT)
    matched = ends & (at_best < SOUND * usual) & contrast
    if contrast.mean() < VISIBLE or matched.sum() < FEWEST * contrast.sum():
        return None
    low, high = np.percentile(d[matched], [TRIMMED, 100 - TRIMMED])
    margin = WIDENED * (high - low) + float(tried[1] - tried[0])
    return float(max(low - margin, wide[0])), float(min(high + margin, wide[1]))
