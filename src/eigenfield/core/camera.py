"""A pinhole camera: world-to-camera, OpenCV axes (x right, y down, z forward), pixels with centres at +0.5."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.core.brief import brief_repr
from eigenfield.core.errors import CaptureError

CAMERA_ROTATION_TOLERANCE = 1e-4  # of singular values; calibrations are often printed with six digits

NO_MEAN_AXIS = 1e-9  # length of a mean of unit vectors that has no direction


@dataclass(frozen=True, eq=False)
class Camera:
    """One calibrated pinhole camera.

    Attributes:
        K: (3, 3) float64, pixels, upper triangular, last row 0 0 1.
        R: (3, 3) float64, rotation from world to camera axes.
        t: (3,) float64, x_camera = R x_world + t.
        width: Of the photograph, pixels; the top-left pixel's centre is (0.5, 0.5).
        height: Likewise.
    """

    K: NDArray[np.float64]
    R: NDArray[np.float64]
    t: NDArray[np.float64]
    width: int
    height: int

    __repr__ = brief_repr

    @staticmethod
    def from_matrices(K: ArrayLike, R: ArrayLike, t: ArrayLike, width: int, height: int, name: str) -> Camera:
        """A camera from outside, checked; R becomes the nearest rotation.

        Args:
            K: (3, 3) pixels, upper triangular, last row 0 0 1.
            R: (3, 3) world-to-camera rotation.
            t: (3,) x_camera = R x_world + t.
            width: Pixels.
            height: Pixels.
            name: Names the camera in errors.

        Raises:
            CaptureError: `camera-shape`, `camera-not-finite`, `camera-not-rotation`, `camera-focal`, `camera-size`.
        """

        def refuse(code: str, what: str, remedy: str = "mend its entry") -> NoReturn:
            raise CaptureError(f"camera-{code}", f"camera {name}{what}", remedy=remedy)

        k, r, p = (np.array(a, dtype=np.float64) for a in (K, R, t))
        if k.shape != (3, 3) or r.shape != (3, 3) or p.shape != (3,):
            refuse("shape", ": matrices of the wrong shape")
        if not (np.isfinite(k).all() and np.isfinite(r).all() and np.isfinite(p).all()):
            refuse("not-finite", " has NaN or infinite entries", "mend or remove its entry")
        if k[0, 0] <= 0 or k[1, 1] <= 0:
            refuse("focal", f" has a focal length of {k[0, 0]:g} x {k[1, 1]:g}")
        if width < 1 or height < 1:
            refuse("size", f" has a size of {width}x{height}")
        u, s, vt = np.linalg.svd(r)
        if np.abs(s - 1).max() > CAMERA_ROTATION_TOLERANCE or np.linalg.det(r) < 0:
            refuse(
                "not-rotation",
                f": the rotation has singular values {s.round(4).tolist()} and determinant {np.linalg.det(r):.4f}",
                "a pose needs an orthonormal, right-handed rotation: mend or remove its entry",
            )
        return Camera(k, u @ vt, p, int(width), int(height))

    @property
    def centre(self) -> NDArray[np.float64]:
        """(3,) the camera's centre in the world."""
        return -self.R.T @ self.t

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(3, 4) K [R | t]: world to homogeneous pixels, whose third entry is the depth along z."""
        return self.K @ np.hstack([self.R, self.t[:, None]])

    def homogeneous(self, points: ArrayLike) -> NDArray[np.float64]:
        """(n, 3) world points as homogeneous pixels, whose third entry is the depth along z."""
        matrix = self.matrix
        return np.asarray(points, dtype=np.float64) @ matrix[:, :3].T + matrix[:, 3]

    def project(self, points: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(n, 3) world points to (n, 2) pixels and (n,) depths; pixels are meaningless where depth is not positive."""
        homogeneous = self.homogeneous(points)
        depth = homogeneous[:, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            return homogeneous[:, :2] / depth[:, None], depth

    def resize(self, width: int, height: int) -> Camera:
        """The same view on a `width` x `height` raster that it covers entirely: scaled evenly, centred, cropped."""
        scale = max(width / self.width, height / self.height)
        shift = np.array(
            [[1, 0, (width - scale * self.width) / 2], [0, 1, (height - scale * self.height) / 2], [0, 0, 1]]
        )
        return Camera(shift @ np.diag([scale, scale, 1.0]) @ self.K, self.R, self.t, width, height)

    def to_float32(self) -> Camera:
        """The camera with every number rounded to float32, as files keep it."""
        k, r, p = (a.astype(np.float32).astype(np.float64) for a in (self.K, self.R, self.t))
        return Camera(k, r, p, self.width, self.height)


def nearest_rotation(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3) the rotation nearest to a matrix, by least squares (polar decomposition)."""
    u, _, vt = np.linalg.svd(matrix)
    turn = np.array([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
    return (u * turn) @ vt


def axis_angles(cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """(V,) degrees between each camera's optical axis and the mean of all; 180 where they have no mean."""
    axes = np.array([camera.R[2] for camera in cameras])
    mean = axes.mean(axis=0)
    length = float(np.linalg.norm(mean))
    if length < NO_MEAN_AXIS:
        return np.full(len(cameras), 180.0)
    return np.asarray(np.degrees(np.arccos(np.clip(axes @ (mean / length), -1, 1))))
