"""Whether the photographs show the same thing on the proxy, by which a wrong camera, mesh or photograph is found."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

log = logging.getLogger("eigenfield.encode")

# An outlier is farther from the mean texture than most, by all of these:
OUTLIER_MIN_DEVIATIONS = 5.0  # robust standard deviations
OUTLIER_MIN_RATIO = 0.6  # of the typical difference
OUTLIER_MIN_GREY_LEVELS = 4.0
AGREEMENT_MIN_GREY_LEVELS = 1.0  # of the photographs' contrast, where it is asked how much of it the mean holds
NORMAL_DEVIATION_RATIO = 1.4826  # standard deviation of a normal distribution over its median deviation
AGREEMENT_MIN_CONTRAST_RATIO = 0.5  # of the mean texture to the photographs; real captures: 0.95, three of noise: 0.33
AGREEMENT_NEIGHBOURS = 24  # nearest observations: errors that they share, as vignetting, are no fault
AGREEMENT_MIN_PIXELS = 50  # or texels, for an observation to be judged


def warn_of_disagreement(
    squares: NDArray[np.float64],
    seen: NDArray[Any],
    channels: int,
    total: float,
    names: Sequence[str],
    places: NDArray[np.float64],
    aligned: bool = False,
) -> NDArray[np.float64]:
    """Log a warning for each observation that is far from the mean texture, farther than those beside it, or one if
    all of them are.

    Args:
        squares: (No,) squared deviations from the mean, of values 0..1.
        seen: (No,) texels or pixels that these are over.
        total: Squared deviations of all observations from one colour.
        places: (No, 2) of each observation's camera on the view plane.
        aligned: Whether texture maps were aligned, which may have failed for one.

    Returns:
        (No,) the root mean square deviations in grey levels, NaN for an observation that shows next to nothing.
    """
    error = np.where(seen >= AGREEMENT_MIN_PIXELS, 255 * np.sqrt(squares / np.maximum(seen * channels, 1)), np.nan)
    for index in np.flatnonzero(seen < AGREEMENT_MIN_PIXELS).tolist():
        log.warning("%s sees next to nothing of the proxy: its camera or its mask may be wrong", names[index])
    if not np.isfinite(error).any():
        return error
    typical = float(np.nanmedian(error))
    spread = NORMAL_DEVIATION_RATIO * float(np.nanmedian(np.abs(error - typical)))
    beyond = max(OUTLIER_MIN_DEVIATIONS * spread, OUTLIER_MIN_RATIO * typical, OUTLIER_MIN_GREY_LEVELS)
    why = "an alignment that failed, another scene" if aligned else "another scene"
    outliers = np.flatnonzero(error > np.maximum(typical, _neighbours_error(error, places)) + beyond).tolist()
    for index in outliers:
        log.warning(
            "%s does not show what the others do: it differs by %.0f grey levels from the mean texture (they by %.0f); "
            "%s, or a wrong camera? take it out of the capture, or leave it out with --hold-out",
            names[index], error[index], typical, why,
        )  # fmt: skip
    shared = 1 - float(squares.sum()) / total if total > 0 else 1.0
    log.info("%.1f grey levels from the mean texture, which holds %.0f %% of the contrast", typical, 100 * shared)
    contrast = 255 * np.sqrt(total / max(float(seen.sum()) * channels, 1.0))
    poor = shared < AGREEMENT_MIN_CONTRAST_RATIO and contrast > AGREEMENT_MIN_GREY_LEVELS
    if poor and not outliers:  # which spoil the mean for all
        words = "the photographs hardly agree on the proxy: their mean holds %.0f %% of their contrast; look at "
        log.warning(
            words + "cameras and mesh (`eigenfield inspect CAPTURE --proxy MESH --overlay overlay.png`)", 100 * shared
        )
    return error


def _neighbours_error(error: NDArray[np.float64], places: NDArray[np.float64]) -> NDArray[np.float64]:
    """(No,) the median error of each observation and its nearest ones; NaN for those that show next to nothing."""
    known = np.flatnonzero(np.isfinite(error))
    count = min(AGREEMENT_NEIGHBOURS + 1, len(known))
    nearest = KDTree(places[known]).query(places[known], count)[1].reshape(len(known), -1)
    result = np.full(len(error), np.nan)
    result[known] = np.median(error[known][nearest], axis=1)
    return result
