"""Known lenses: intrinsics that are given and not estimated, and features freed from their distortion."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.lens import Lens

F64 = NDArray[np.float64]

ITERATIONS = 30
STEP = 1e-6  # of the numerical derivative, in units of the focal length
ENOUGH = 1e-13  # of a step, in the same units
CLOSE = 0.01  # pixels to which the inverse must hold


@dataclass(frozen=True, eq=False)
class KnownLens:
    """The intrinsics of one photograph.

    K: (3, 3) pixels, centres at +0.5. lens: its distortion, None where there is none.
    """

    K: F64
    lens: Lens | None = None


def undistorted(points: F64, known: KnownLens) -> F64:
    """Where the pinhole K sees what the lens shows at (n, 2) pixels; NaN where no direction leads there.

    Newton's method on `distorted`; directions beyond `Lens.limit` are none.
    """
    if known.lens is None or len(points) == 0:
        return points.copy()
    focal, principal = known.K[[0, 1], [0, 1]], known.K[:2, 2]
    target = (points - principal) / focal
    flat = target.copy()
    x_step, y_step = np.array([STEP, 0.0]), np.array([0.0, STEP])
    with np.errstate(all="ignore"):
        for _ in range(ITERATIONS):
            away = bent(flat, known.lens) - target
            right = (bent(flat + x_step, known.lens) - bent(flat - x_step, known.lens)) / (2 * STEP)
            down = (bent(flat + y_step, known.lens) - bent(flat - y_step, known.lens)) / (2 * STEP)
            determinant = right[:, 0] * down[:, 1] - down[:, 0] * right[:, 1]
            step = np.column_stack([
                (down[:, 1] * away[:, 0] - down[:, 0] * away[:, 1]) / determinant,
                (right[:, 0] * away[:, 1] - right[:, 1] * away[:, 0]) / determinant,
            ])  # fmt: skip
            flat = flat - step
            if np.abs(step).max() < ENOUGH:
                break
        wrong = ~(np.abs(bent(flat, known.lens) - target).max(axis=1) < CLOSE / focal.max())
        wrong |= ~((flat**2).sum(axis=1) < known.lens.limit() ** 2)
    flat[wrong] = np.nan
    return flat * focal + principal


def distorted(flat: F64, known: KnownLens) -> F64:
    """(n, 2) pixels of the photograph at which the directions (x / z, y / z) are seen."""
    seen = flat if known.lens is None or len(flat) == 0 else bent(flat, known.lens)
    return seen * known.K[[0, 1], [0, 1]] + known.K[:2, 2]


def bent(flat: F64, lens: Lens) -> F64:
    """x', y' of x, y (n, 2), as `Lens` defines them."""
    if lens.model.startswith("metashape"):
        return _metashape(flat, lens)
    rays = np.column_stack([flat, np.ones(len(flat))])[:, None]
    none, coefficients = np.zeros(3), np.array(lens.coefficients)
    if lens.model == "fisheye":
        return np.asarray(cv2.fisheye.projectPoints(rays, none, none, np.eye(3), coefficients)[0][:, 0])
    return np.asarray(cv2.projectPoints(rays, none, none, np.eye(3), coefficients)[0][:, 0])


def _metashape(flat: F64, lens: Lens) -> F64:
    k1, k2, k3, k4, p1, p2, p3, p4, skew = lens.coefficients
    x, y = flat.T
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
