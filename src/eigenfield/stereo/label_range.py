"""The range of labels that a scene occupies, from a coarse sweep."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.stereo.detail import detail_pictures
from eigenfield.stereo.estimate import spaced_labels, spread_views, sweep_and_match
from eigenfield.stereo.sweep import SWEEP_MAX_DIFFERENCE_LEVELS
from eigenfield.stereo.sweep_kernels import SWEEP_COST_UNITS_PER_LEVEL
from eigenfield.stereo.views import Pictures, halve_pictures, halved_matrices, label_parallax, pack_pictures

LABEL_RANGE_MAX_VIEWS = 25
LABEL_RANGE_LABELS = 128  # that are tried
LABEL_RANGE_HALVINGS = 2
LABEL_RANGE_TRIM_PERCENT = 0.5  # pixels that may lie outside at each end of the range
LABEL_RANGE_MARGIN_FRACTION = 0.05  # added at both ends
LABEL_RANGE_MATCH_COST_RATIO = 0.5  # a pixel is matched if its best cost is below this fraction of the median cost
LABEL_RANGE_MIN_CONTRAST_FRACTION = 0.01  # pixels that must show contrast
LABEL_RANGE_MIN_MATCH_FRACTION = 0.15  # of those, matched (noise: 0.06; a range that misses the scene: 0.07)


def depth_range(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    search_range: tuple[float, float],
) -> tuple[float, float] | None:
    """The range of labels that holds the scene, from a sweep at a quarter of the resolution.

    Only pixels count at which one label fits clearly better than most others: flat paint fits anywhere.

    Returns:
        (low, high), or None if hardly any pixel matches: nothing in `search_range` is consistent with the photographs.
    """
    packed = pack_pictures(pictures)
    chosen = spread_views(label_parallax(matrices, shape, sum(search_range) / 2), LABEL_RANGE_MAX_VIEWS)
    small, coarse = packed[chosen], np.asarray(matrices, np.float64)[chosen]
    for _ in range(LABEL_RANGE_HALVINGS):
        small, coarse = halve_pictures(small), halved_matrices(coarse)
        shape = ((shape[0] + 1) // 2, (shape[1] + 1) // 2)
    tried = spaced_labels(*search_range, (search_range[1] - search_range[0]) / (LABEL_RANGE_LABELS - 1))
    detail = detail_pictures(small)
    d, cost = sweep_and_match(detail, small, coarse, shape, tried, unseen_cost=SWEEP_MAX_DIFFERENCE_LEVELS)
    nearest = np.abs(tried[None, None] - d[..., None]).argmin(axis=-1)
    at_best = np.take_along_axis(cost, nearest[..., None], axis=-1)[..., 0].astype(np.float32)
    usual = np.median(cost, axis=-1)
    ends = (nearest > 0) & (nearest < len(tried) - 1)
    contrast = usual > float(SWEEP_COST_UNITS_PER_LEVEL)
    matched = ends & (at_best < LABEL_RANGE_MATCH_COST_RATIO * usual) & contrast
    if (
        contrast.mean() < LABEL_RANGE_MIN_CONTRAST_FRACTION
        or matched.sum() < LABEL_RANGE_MIN_MATCH_FRACTION * contrast.sum()
    ):
        return None
    low, high = np.percentile(d[matched], [LABEL_RANGE_TRIM_PERCENT, 100 - LABEL_RANGE_TRIM_PERCENT])
    margin = LABEL_RANGE_MARGIN_FRACTION * (high - low) + float(tried[1] - tried[0])
    return float(max(low - margin, search_range[0])), float(min(high + margin, search_range[1]))
