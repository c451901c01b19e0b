"""Known lenses: intrinsics that are given, not estimated, and the undistortion of pixels."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.lens import Lens

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
        known: The lens.

    Returns:
        (n, 2) pixels; NaN where no direction leads to the pixel.
    """
    if known.lens is None or len(points) == 0:
        return points.copy()
    focal, principal = known.K[[0, 1], [0, 1]], known.K[:2, 2]
    target = (points - principal) / focal
    normalised = target.copy()
    x_step, y_step = np.array([UNDISTORT_DERIVATIVE_STEP, 0.0]), np.array([0.0, UNDISTORT_DERIVATIVE_STEP])
    with np.errstate(all="ignore"):
        for _ in range(UNDISTORT_MAX_ITERATIONS):
            error = apply_distortion(normalised, known.lens) - target
            right = (
                apply_distortion(normalised + x_step, known.lens) - apply_distortion(normalised - x_step, known.lens)
            ) / (2 * UNDISTORT_DERIVATIVE_STEP)
            down = (
                apply_distortion(normalised + y_step, known.lens) - apply_distortion(normalised - y_step, known.lens)
            ) / (2 * UNDISTORT_DERIVATIVE_STEP)
            determinant = right[:, 0] * down[:, 1] - down[:, 0] * right[:, 1]
            step = np.column_stack([
                (down[:, 1] * error[:, 0] - down[:, 0] * error[:, 1]) / determinant,
                (right[:, 0] * error[:, 1] - right[:, 1] * error[:, 0]) / determinant,
            ])  # fmt: skip
            normalised = normalised - step
            if np.abs(step).max() < UNDISTORT_STEP_TOLERANCE:
                break
        wrong = ~(
            np.abs(apply_distortion(normalised, known.lens) - target).max(axis=1)
            < UNDISTORT_MAX_ERROR_PIXELS / focal.max()
        )
        wrong |= ~((normalised**2).sum(axis=1) < known.lens.valid_radius() ** 2)
    normalised[wrong] = np.nan
    return normalised * focal + principal


def distort_to_pixels(normalised: F64, known: KnownLens) -> F64:
    """(n, 2) pixels of the photograph at which directions are seen.

    Args:
        normalised: (n, 2) directions x / z, y / z.
        known: The lens.
    """
    seen = normalised if known.lens is None or len(normalised) == 0 else apply_distortion(normalised, known.lens)
    return seen * known.K[[0, 1], [0, 1]] + known.K[:2, 2]


def apply_distortion(normalised: F64, lens: Lens) -> F64:
    """(n, 2) distorted coordinates x', y', as `Lens` defines them.

    Args:
        normalised: (n, 2) directions x / z, y / z.
        lens: The distortion.
    """
    if lens.model.startswith("metashape"):
        return _apply_metashape(normalised, lens)
    rays = np.column_stack([normalised, np.ones(len(normalised))])[:, None]
    none, coefficients = np.zeros(3), np.array(lens.coefficients)
    if lens.model == "fisheye":
        return np.asarray(cv2.fisheye.projectPoints(rays, none, none, np.eye(3), coefficients)[0][:, 0])
    return np.asarray(cv2.projectPoints(rays, none, none, np.eye(3), coefficients)[0][:, 0])


def _apply_metashape(normalised: F64, lens: Lens) -> F64:
    k1, k2, k3, k4, p1, p2, p3, p4, skew = lens.coefficients
    x, y = normalised.T
    if lens.model != "metashape":
        radius = np.maximum(np.hypot(x, y), 1e-12)
        theta = np.arctan(radius)
        scale = (theta if lens.model == "metashape-equidistant" else 2 * np.sin(theta / 2)) / radius
        x, y = x * scale, y * scale
    q = x * x + y * y
    radial = 1 + q * (k1 + q * (k2 + q * (k3 + q * k4)))
    more = 1 + q * (p3 + q * p4)
    u = x * radial + (p1 * (q + 2 * x * x) + 2 * p2 * x * y) * more
    v = y * radial + (p2 * (q + 2 * y * y) + 2 * p1 * x * y) * more
    return np.column_stack([u + skew * v, v])
