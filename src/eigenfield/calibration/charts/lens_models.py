"""The pinhole camera with Brown's distortion as OpenCV defines it, its derivatives, and which parameters are free.

    r^2 = x^2 + y^2,  q = 1 + k1 r^2 + k2 r^4 + k3 r^6
    u = fx (x q + 2 p1 x y + p2 (r^2 + 2 x^2)) + cx
    v = fy (y q + p1 (r^2 + 2 y^2) + 2 p2 x y) + cy

Intrinsics are (9,) float64: fx, fy, cx, cy, k1, k2, p1, p2, k3. Pixel centres are at +0.5.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.lens import Lens

LENS_INTRINSICS = 9  # parameters of a camera


@dataclass(frozen=True)
class LensModel:
    """Which intrinsics are estimated. The rest keep their nominal values (square pixels, centred, no distortion).

    Attributes:
        centre: Whether the principal point is free.
        aspect: Whether fx and fy differ.
        distortion: How many of k1, k2, (p1 and p2), k3 are free: 0 to 4.
    """

    centre: bool
    aspect: bool
    distortion: int

    @property
    def basis(self) -> NDArray[np.float64]:
        """(9, m) directions in which intrinsics may move; fx and fy move together if the aspect is fixed."""
        columns = [[0, 1]] if not self.aspect else [[0], [1]]
        columns += [[2], [3]] if self.centre else []
        for group in ([[4]], [[5]], [[6], [7]], [[8]])[: self.distortion]:
            columns += group
        basis = np.zeros((LENS_INTRINSICS, len(columns)))
        for j, rows in enumerate(columns):
            basis[rows, j] = 1
        return basis

    @property
    def flags(self) -> int:
        """Flags of `cv2.calibrateCamera`."""
        flags = 0 if self.aspect else cv2.CALIB_FIX_ASPECT_RATIO
        flags |= 0 if self.centre else cv2.CALIB_FIX_PRINCIPAL_POINT
        fixed = (cv2.CALIB_FIX_K1, cv2.CALIB_FIX_K2, cv2.CALIB_ZERO_TANGENT_DIST, cv2.CALIB_FIX_K3)
        for flag in fixed[self.distortion :]:
            flags |= flag
        return flags

    def __str__(self) -> str:
        names = ["fx fy" if self.aspect else "f"] + ["cx cy"] * self.centre
        return " ".join(names + ["k1", "k2", "p1 p2", "k3"][: self.distortion])


# from the fewest free parameters to the most; cross-validation selects one
LENS_MODEL_LADDER = (
    LensModel(False, False, 0),
    LensModel(False, False, 1),
    LensModel(True, False, 1),
    LensModel(True, True, 2),
    LensModel(True, True, 3),
    LensModel(True, True, 4),
)


def camera_matrix(intrinsics: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3) K.

    Args:
        intrinsics: (9,), see above.
    """
    fx, fy, cx, cy = intrinsics[:4]
    return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])


def brown_lens(intrinsics: NDArray[np.float64]) -> Lens | None:
    """The distortion as a Lens; None if there is none.

    Args:
        intrinsics: (9,), see above.
    """
    k1, k2, p1, p2, k3 = (float(v) for v in intrinsics[4:])
    found = Lens("brown", (k1, k2, p1, p2, k3))
    return None if found.is_identity else found


def project_points(points: NDArray[np.float64], intrinsics: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 2) pixels of points.

    Args:
        points: (n, 3) in camera axes.
        intrinsics: (9,) or (n, 9).
    """
    return _project_points(points, intrinsics, None)


def project_points_with_derivatives(
    points: NDArray[np.float64], intrinsics: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Pixels of points, and their derivatives.

    Args:
        points: (n, 3) in camera axes.
        intrinsics: (9,) or (n, 9).

    Returns:
        (n, 2) pixels, (n, 2, 3) derivatives by the points and (n, 2, 9) by the intrinsics.
    """
    both = np.zeros((len(points), 2, 3)), np.zeros((len(points), 2, LENS_INTRINSICS))
    return _project_points(points, intrinsics, both), *both


def _project_points(
    points: NDArray[np.float64],
    intrinsics: NDArray[np.float64],
    derivatives: tuple[NDArray[np.float64], NDArray[np.float64]] | None,
) -> NDArray[np.float64]:
    fx, fy, cx, cy, k1, k2, p1, p2, k3 = intrinsics.T
    z = points[:, 2]
    x, y = points[:, 0] / z, points[:, 1] / z
    r2 = x * x + y * y
    q = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    xd = x * q + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    yd = y * q + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    if derivatives is not None:
        by_point, by_intrinsics = derivatives
        dq = k1 + r2 * (2 * k2 + 3 * r2 * k3)  # by r^2
        xx = q + 2 * x * x * dq + 2 * p1 * y + 6 * p2 * x
        mixed = 2 * x * y * dq + 2 * p1 * x + 2 * p2 * y
        yy = q + 2 * y * y * dq + 6 * p1 * y + 2 * p2 * x
        by_point[:, 0, 0], by_point[:, 0, 1] = fx * xx / z, fx * mixed / z
        by_point[:, 1, 0], by_point[:, 1, 1] = fy * mixed / z, fy * yy / z
        by_point[:, 0, 2] = -(by_point[:, 0, 0] * x + by_point[:, 0, 1] * y)
        by_point[:, 1, 2] = -(by_point[:, 1, 0] * x + by_point[:, 1, 1] * y)
        by_intrinsics[:, 0, 0], by_intrinsics[:, 1, 1] = xd, yd
        by_intrinsics[:, 0, 2] = by_intrinsics[:, 1, 3] = 1
        for column, power in ((4, r2), (5, r2 * r2), (8, r2**3)):
            by_intrinsics[:, 0, column], by_intrinsics[:, 1, column] = fx * x * power, fy * y * power
        by_intrinsics[:, 0, 6], by_intrinsics[:, 1, 6] = fx * 2 * x * y, fy * (r2 + 2 * y * y)
        by_intrinsics[:, 0, 7], by_intrinsics[:, 1, 7] = fx * (r2 + 2 * x * x), fy * 2 * x * y
    return np.stack([fx * xd + cx, fy * yd + cy], axis=1)
