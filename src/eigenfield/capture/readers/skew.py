"""Camera matrices with skew: no view keeps one (transforms.json and COLMAP could not), so it is removed as a lens."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.text import damaged_error
from eigenfield.core.errors import CaptureError

SKEW_NEGLIGIBLE_RATIO = 1e-6  # of the focal length: 0.001 pixel at the rim of a photograph
SKEW_MAX_RATIO = 0.1  # of the focal length: beyond, it is no camera but a wrong matrix
SKEW_ROW_TOLERANCE = 1e-6  # of entries below the diagonal, which must be 0


def remove_skew(K: NDArray[np.float64], label: str, path: Path) -> tuple[NDArray[np.float64], Lens | None]:
    """A camera matrix without its skew, which becomes a lens: x' = x + s y, s = K[0, 1] / K[0, 0].

    Args:
        K: (3, 3) upper triangular.

    Returns:
        (3, 3) K with K[0, 1] = 0 and K[2, 2] = 1, and the lens; None where s is negligible.

    Raises:
        CaptureError: `camera-focal`, `camera-skew` (more than a tenth of the focal length), `calibration-damaged` (not
            upper triangular).
    """
    if not np.isfinite(K).all() or K[2, 2] == 0:
        raise damaged_error(path, f"the camera matrix of {label} does not end in 0 0 1")
    with np.errstate(all="ignore"):
        K = K / K[2, 2]
    if not np.isfinite(K).all() or not (K[0, 0] > 0 and K[1, 1] > 0):
        message = f"{label} has a focal length of {K[0, 0]:g} x {K[1, 1]:g}"
        raise CaptureError("camera-focal", message, path=path, remedy="mend its entry")
    if max(abs(K[2, 0]), abs(K[2, 1])) > SKEW_ROW_TOLERANCE or abs(K[1, 0]) > SKEW_ROW_TOLERANCE * K[1, 1]:
        raise damaged_error(path, f"the camera matrix of {label} is not upper triangular with a last row of 0 0 1")
    with np.errstate(all="ignore"):
        skew = float(K[0, 1] / K[0, 0])
    if not abs(skew) <= SKEW_MAX_RATIO:
        raise CaptureError(
            "camera-skew",
            f"{label} has a skew of {K[0, 1]:g} at a focal length of {K[0, 0]:g}: no photograph has that",
            path=path,
            remedy="mend or remove its entry",
        )
    straight = np.array([[K[0, 0], 0, K[0, 2]], [0, K[1, 1], K[1, 2]], [0, 0, 1]])
    return straight, None if abs(skew) < SKEW_NEGLIGIBLE_RATIO else Lens("metashape", (*(0.0,) * 8, skew))
