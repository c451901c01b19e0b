"""Camera matrices with skew: no view keeps one (transforms.json and COLMAP could not), so it goes as a lens does."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.text import damaged
from eigenfield.core.errors import CaptureError

NEGLIGIBLE = 1e-6  # of the focal length: 0.001 pixel at the rim of a photograph
LARGEST = 0.1  # of the focal length: beyond, it is no camera but a wrong matrix
LAST_ROW = 1e-6


def without_skew(K: NDArray[np.float64], label: str, path: Path) -> tuple[NDArray[np.float64], Lens | None]:
    """(3, 3) K with K[0, 1] = 0, and the lens that draws the photograph so: x' = x + s y in coordinates of the focal
    length, s = K[0, 1] / K[0, 0]; None where s is negligible.

    K is scaled so that its last entry is 1. CaptureError: `camera-focal`, `camera-skew` (more than a tenth of the
    focal length), `calibration-damaged` (not upper triangular).
    """
    if not np.isfinite(K).all() or K[2, 2] == 0:
        raise damaged(path, f"the camera matrix of {label} does not end in 0 0 1")
    with np.errstate(all="ignore"):
        K = K / K[2, 2]
    if not np.isfinite(K).all() or not (K[0, 0] > 0 and K[1, 1] > 0):
        raise CaptureError(
            "camera-focal",
            f"{label} has a focal length of {K[0, 0]:g} x {K[1, 1]:g}",
            path=path,
            remedy="mend its entry",
        )
    if max(abs(K[2, 0]), abs(K[2, 1])) > LAST_ROW or abs(K[1, 0]) > LAST_ROW * K[1, 1]:
        raise damaged(path, f"the camera matrix of {label} is not upper triangular with a last row of 0 0 1")
    with np.errstate(all="ignore"):
        skew = float(K[0, 1] / K[0, 0])
    if not abs(skew) <= LARGEST:
        raise CaptureError(
            "camera-skew",
            f"{label} has a skew of {K[0, 1]:g} at a focal length of {K[0, 0]:g}: no photograph has that",
            path=path,
            remedy="mend or remove its entry",
        )
    straight = np.array([[K[0, 0], 0, K[0, 2]], [0, K[1, 1], K[1, 2]], [0, 0, 1]])
    return straight, None if abs(skew) < NEGLIGIBLE else Lens("metashape", (*(0.0,) * 8, skew))
