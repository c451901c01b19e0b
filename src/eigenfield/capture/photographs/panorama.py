"""Panoramas, which no pinhole camera takes: recognised by their metadata, or by what all of them show."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.header import Header
from eigenfield.capture.photographs.read import decode
from eigenfield.core.errors import CaptureError

PANORAMA_ROWS = 256  # of the small copy that is looked at
PANORAMA_DETAIL_ROWS = 16  # over which a column's mean is taken away
PANORAMA_MIN_DETAIL = 0.005  # standard deviation of a column's detail
PANORAMA_MIN_SEAM_CORRELATION = 0.8  # of the detail of the first and last columns
PANORAMA_MAX_POLE_RATIO = 0.25  # spread of the values of a pole to those of the middle row


def refuse_panorama(path: Path, header: Header, focal: float | None, *, by_shape: bool) -> None:
    """Raise CaptureError `image-panorama` for a panorama.

    Args:
        focal: Focal length that EXIF states, which a panorama has none of.
        by_shape: Also look into pictures that are twice as wide as high and have no focal length.
    """
    why = None
    if header.panorama:
        why = "its metadata say so (GPano)"
    elif by_shape and focal is None and header.width == 2 * header.height and _shows_all_around(decode(path)[0]):
        why = "twice as wide as high, its left and right sides meet, and its top or bottom row is one point"
    if why is not None:
        raise CaptureError(
            "image-panorama",
            f"is a panorama ({why}), and cameras are pinholes here",
            path=path,
            remedy="cut it into perspective views, or take it out",
        )


def _shows_all_around(pixels: NDArray[np.float32]) -> bool:
    """Whether a picture is equirectangular, all 360 degrees of it: detail runs on from its right side to its left, and
    a pole, which is one direction, has one colour."""
    grey = cv2.resize(pixels, (2 * PANORAMA_ROWS, PANORAMA_ROWS), interpolation=cv2.INTER_AREA).mean(axis=2)
    sides = grey[:, [0, -1]]
    detail = sides - cv2.blur(sides, (1, PANORAMA_DETAIL_ROWS))
    spread = detail.std(axis=0)
    if spread.min() < PANORAMA_MIN_DETAIL:
        return False
    seam = float((detail[:, 0] * detail[:, 1]).mean() / (spread[0] * spread[1]))
    poles = min(grey[0].std(), grey[-1].std())
    return seam > PANORAMA_MIN_SEAM_CORRELATION and poles < PANORAMA_MAX_POLE_RATIO * grey[PANORAMA_ROWS // 2].std()
