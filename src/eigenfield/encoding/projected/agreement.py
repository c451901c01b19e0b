"""Whether the photographs show the same thing on the proxy: what a wrong camera, mesh or photograph gives away."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from eigenfield.encoding.projected.mean import Mean
from eigenfield.encoding.projected.project import TextureMaps

log = logging.getLogger("eigenfield.encode")

# beyond the typical difference from the mean texture: robust standard deviations, parts of it, and grey levels
STRANGE = (5.0, 0.6, 4.0)
NORMAL = 1.4826  # standard deviation of a normal distribution over its median deviation
SHARED = 0.5  # of the photographs' contrast that the mean texture must hold; real captures: 0.95, three of noise: 0.33
BESIDE = 24  # observations nearest to one: what they have too, as light that falls off towards corners, is no fault
FEWEST_SEEN = 50  # texels or pixels of an observation from which it is judged


def disagreement_of(
    maps: TextureMaps,
    mean: Mean,
    gram: NDArray[np.float64],
    names: Sequence[str],
    places: NDArray[np.float64],
    aligned: bool = False,
) -> NDArray[np.float64]:
    """`warn_of_disagreement` of texture maps.

    Args:
        maps: of No observations.
        mean: of the maps.
        gram: (No, No) of `gram_matrix`; its diagonal holds the squared deviations from the mean.
        names: of each observation's camera.
        places: (No, 2) of each observation's camera on the view plane.
        aligned: the maps were aligned, which may have failed for one.
    """
    seen = np.array([int(np.count_nonzero(row)) for row in maps.seen])
    squares = np.diag(gram)
    count, values = mean.count.astype(np.float64)[:, None], mean.values.astype(np.float64)
    centre = (count * values).sum(axis=0) / max(float(count.sum()), 1.0)
    total = float((count * (values - centre) ** 2).sum()) + float(squares.sum())
    return warn_of_disagreement(squares, seen, maps.channels, total, names, places, aligned)


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
        channels: of each texel or pixel.
        total: squared deviations of all observations from one colour.
        names: of each observation's camera.
        places: (No, 2) of each observation's camera on the view plane.
        aligned: texture maps were aligned, which may have failed for one.

    Returns:
        (No,) the root mean square deviations in grey levels, NaN for an observation that shows next to nothing.
    """
    error = np.where(seen >= FEWEST_SEEN, 255 * np.sqrt(squares / np.maximum(seen * channels, 1)), np.nan)
    for index in np.flatnonzero(seen < FEWEST_SEEN).tolist():
        log.warning("%s sees next to nothing of the proxy: its camera or its mask may be wrong", names[index])
    if not np.isfinite(error).any():
        return error
    typical = float(np.nanmedian(error))
    spread = NORMAL * float(np.nanmedian(np.abs(error - typical)))
    beyond = max(STRANGE[0] * spread, STRANGE[1] * typical, STRANGE[2])
    why = (
        "an alignment that failed, another scene, or a wrong camera" if aligned else "another scene, or a wrong camera"
    )
    strange = np.flatnonzero(error > np.maximum(typical, _beside(error, places)) + beyond).tolist()
    for index in strange:
        log.warning(
            "%s does not show what the others do: it differs by %.0f grey levels from the mean texture (they by %.0f); "
            "%s? take it out of the capture, or leave it out with --hold-out",
            names[index], error[index], typical, why,
        )  # fmt: skip
    shared = 1 - float(squares.sum()) / total if total > 0 else 1.0
    log.info("%.1f grey levels from the mean texture, which holds %.0f %% of the contrast", typical, 100 * shared)
    if shared < SHARED and not strange:  # which spoil the mean for all
        log.warning(
            "the photographs hardly agree on the proxy: their mean holds %.0f %% of their contrast; look at cameras "
            "and mesh (eigenfield inspect --overlay)", 100 * shared,
        )  # fmt: skip
    return error


def _beside(error: NDArray[np.float64], places: NDArray[np.float64]) -> NDArray[np.float64]:
    """(No,) the median error of each observation and the BESIDE nearest to it; NaN for those that show next to
    nothing."""
    known = np.flatnonzero(np.isfinite(error))
    nearest = KDTree(places[known]).query(places[known], min(BESIDE + 1, len(known)))[1].reshape(len(known), -1)
    result = np.full(len(error), np.nan)
    result[known] = np.median(error[known][nearest], axis=1)
    return result
