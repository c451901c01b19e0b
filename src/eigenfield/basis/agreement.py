"""Whether the photographs show the same thing on the proxy: what a wrong camera, mesh or photograph gives away."""

from __future__ import annotations

import logging
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.basis.mean import Mean
from eigenfield.texturing import TextureMaps

log = logging.getLogger("eigenfield.encode")

# beyond the typical difference from the mean texture: robust standard deviations, parts of it, and grey levels
STRANGE = (5.0, 0.6, 4.0)
NORMAL = 1.4826  # standard deviation of a normal distribution over its median deviation
SHARED = 0.5  # of the photographs' contrast that the mean texture must hold; real captures: 0.95, three of noise: 0.33
FEWEST_SEEN = 50  # texels of a camera from which it is judged


def warn_of_disagreement(
    maps: TextureMaps, mean: Mean, gram: NDArray[np.float64], names: Sequence[str], aligned: bool = False
) -> NDArray[np.float64]:
    """Log a warning for each camera whose photograph is far from the mean texture, and one if all of them are.

    gram: (Nc, Nc) of `basis.gram_matrix`; its diagonal holds the squared deviations from the mean. Returns (Nc,) the
    root mean square deviations in grey levels, NaN for a camera that sees next to nothing. aligned: the maps were
    aligned, which may have failed for one.
    """
    seen = np.array([int(np.count_nonzero(row)) for row in maps.seen])
    squares = np.diag(gram)
    error = np.where(seen >= FEWEST_SEEN, 255 * np.sqrt(squares / np.maximum(seen * maps.channels, 1)), np.nan)
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
    for index in np.flatnonzero(error > typical + beyond).tolist():
        log.warning(
            "%s does not show what the others do: it differs by %.0f grey levels from the mean texture (they by %.0f); "
            "%s? take it out of the capture, or leave it out with --hold-out",
            names[index], error[index], typical, why,
        )  # fmt: skip
    shared = _shared(mean, float(squares.sum()))
    log.info("%.1f grey levels from the mean texture, which holds %.0f %% of the contrast", typical, 100 * shared)
    if shared < SHARED:
        log.warning(
            "the photographs hardly agree on the proxy: their mean holds %.0f %% of their contrast; look at cameras "
            "and mesh (eigenfield inspect --overlay)", 100 * shared,
        )  # fmt: skip
    return error


def _shared(mean: Mean, left: float) -> float:
    """Of the photographs' squared deviations from one colour, the part that their mean texture holds."""
    count = mean.count.astype(np.float64)[:, None]
    values = mean.values.astype(np.float64)
    centre = (count * values).sum(axis=0) / max(float(count.sum()), 1.0)
    held = float((count * (values - centre) ** 2).sum())
    return held / (held + left) if held + left > 0 else 1.0
