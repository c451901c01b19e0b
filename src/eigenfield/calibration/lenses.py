"""Known lenses: intrinsics that are given, not estimated, and the undistortion of pixels."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.lens import Lens, metashape_distortion

F64 = NDArray[np.float64]

UNDISTORT_MAX_ITERATIONS = 30
UNDISTORT_DERIVATIVE_STEP = 1e-6  # in units of the focal length
UNDISTORT_STEP_TOLERANCE = 1e-13  # in the same units
UNDISTORT_MAX_ERROR_PIXELS = 0.01  # of the inverse


@dataclass(frozen=True, eq=False)
class KnownLens:
    """The intrinsics of one photograph.

    Attributes:
        K: (3, 3) pixels, centres at +0.5.
        lens: Its distortion; None if there is none.
    """

    K: F64
    lens: Lens | None = None


def undistort_pixels(points: F64, known: KnownLens) -> F64:
    """Where the pinhole camera K sees what the lens shows.

    Newton's method inverts `distort_to_pixels`. Directions beyond `Lens.valid_radius` are rejected.

    Args:
        points: (n, 2) pixels of the photograph.

    Returns:
        (n, 2) pixels; NaN where no direction leads to the pixel.
    """
    if known.lens is None or len(points) == 0:
        return points.copy()
    focal, principal = known.K[[0, 1], [0, 1]], known.K[:2, 2]
    target = (points - principal) / focal
    normalised = target.copy()
    with np.errstate(all="ignore"):
        for _ in range(UNDISTORT_MAX_ITERATIONS):
            error = _apply_distortion(normalised, known.lens) - target
            right, down = (
                (_apply_distortion(normalised + step, known.lens) - _apply_distortion(normalised - step, known.lens))
                / (2 * UNDISTORT_DERIVATIVE_STEP)
                for step in UNDISTORT_DERIVATIVE_STEP * np.eye(2)
            )
            determinant = right[:, 0] * down[:, 1] - down[:, 0] * right[:, 1]
            step = np.column_stack([
                (down[:, 1] * error[:, 0] - down[:, 0] * error[:, 1]) / determinant,
                (right[:, 0] * error[:, 1] - right[:, 1] * error[:, 0]) / determinant,
            ])  # fmt: skip
            normalised = normalised - step
            if np.abs(step).max() < UNDISTORT_STEP_TOLERANCE:
                break
        left = np.abs(_apply_distortion(normalised, known.lens) - target).max(axis=1)
        wrong = ~(left < UNDISTORT_MAX_ERROR_PIXELS / focal.max())
        wrong |= ~((normalised**2).sum(axis=1) < known.lens.valid_radius() ** 2)
    normalised[wrong] = np.nan
    return normalised * focal + principal


def distort_to_pixels(normalised: F64, known: KnownLens) -> F64:
    """(n, 2) pixels of the photograph at which directions are seen.

    Args:
        normalised: (n, 2) directions x / z, y / z.
    """
    seen = normalised if known.lens is None or len(normalised) == 0 else _apply_distortion(normalised, known.lens)
    return seen * known.K[[0, 1], [0, 1]] + known.K[:2, 2]


def _apply_distortion(normalised: F64, lens: Lens) -> F64:
    """(n, 2) distorted coordinates x', y' of directions x / z, y / z (n, 2), as `Lens` defines them."""
    if lens.model.startswith("metashape"):
        return np.column_stack(metashape_distortion(normalised[:, 0], normalised[:, 1], lens))
    rays = np.column_stack([normalised, np.ones(len(normalised))])[:, None]
    none, coefficients = np.zeros(3), np.array(lens.coefficients)
    if lens.model == "fisheye":
        return np.asarray(cv2.fisheye.projectPoints(rays, none, none, np.eye(3), coefficients)[0][:, 0])
    return np.asarray(cv2.projectPoints(rays, none, none, np.eye(3), coefficients)[0][:, 0])
