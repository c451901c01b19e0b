"""Lens distortion, and its removal: a photograph is drawn anew as the pinhole camera of the same K and size sees it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.kernels import sample_cubic
from eigenfield.errors import CaptureError
from eigenfield.parallel import parallel_map, pieces

BAND = 64  # rows drawn at a time
NEGLIGIBLE = 1e-12  # coefficients below this are no distortion


@dataclass(frozen=True)
class Lens:
    """Distortion as OpenCV and COLMAP define it.

    model: "brown", x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + tangential terms (OpenCV's default, COLMAP's SIMPLE_RADIAL,
        RADIAL and OPENCV), or "fisheye", theta' = theta (1 + k1 theta^2 + .. + k4 theta^8) (COLMAP's OPENCV_FISHEYE).
    coefficients: (k1, k2, p1, p2, k3) or (k1, k2, k3, k4).
    """

    model: Literal["brown", "fisheye"]
    coefficients: tuple[float, ...]

    @property
    def does_nothing(self) -> bool:
        """No distortion at all; a fisheye is never without."""
        return self.model == "brown" and all(abs(c) < NEGLIGIBLE for c in self.coefficients)

    def limit(self) -> float:
        """The undistorted radius (tangent of the angle to the axis) up to which distortion grows with it.

        Beyond, the polynomial folds back and a pinhole picture would repeat the photograph's rim: nothing is there.
        """
        if self.model == "brown":
            k1, k2, _, _, k3 = self.coefficients
            radial = (k1, k2, k3)
        else:
            radial = self.coefficients  # type: ignore[assignment]
        # derivative of s (1 + k1 s^2 + k2 s^4 ..) as a polynomial in s^2, highest power first, for numpy.roots
        derivative = [(2 * i + 3) * k for i, k in reversed(list(enumerate(radial)))] + [1.0]
        roots = np.roots(derivative)
        real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0)]
        first = float(np.sqrt(real.min())) if len(real) else np.inf
        if self.model == "brown":
            return first
        return float(np.tan(first)) if first < np.pi / 2 else np.inf


def source_positions(
    K: NDArray[np.float64], lens: Lens, width: int, height: int
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.bool_]]:
    """Where each pixel of the pinhole picture lies in the photograph.

    Returns x and y, (H, W) float32, positions with integer pixel centres, and (H, W) bool, whether the photograph
    has anything there. OpenCV counts pixel centres from 0, we from 0.5: K is shifted on the way in.
    """
    shifted = K - np.array([[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]])
    size = (width, height)
    d = np.array(lens.coefficients)
    if lens.model == "brown":
        x, y = cv2.initUndistortRectifyMap(shifted, d, np.eye(3), shifted, size, cv2.CV_32FC1)
    else:
        x, y = cv2.fisheye.initUndistortRectifyMap(shifted, d, np.eye(3), shifted, size, cv2.CV_32FC1)
    inside = (x >= -0.5) & (x <= width - 0.5) & (y >= -0.5) & (y <= height - 0.5)
    limit = lens.limit()
    if np.isfinite(limit):
        ny = (np.arange(height) + 0.5 - K[1, 2]) / K[1, 1]
        nx = (np.arange(width) + 0.5 - K[0, 2] - K[0, 1] * ny[:, None]) / K[0, 0]
        inside &= nx**2 + ny[:, None] ** 2 < limit**2
    return np.asarray(x, np.float32), np.asarray(y, np.float32), inside


def resample(picture: NDArray[np.float32], x: NDArray[np.float32], y: NDArray[np.float32]) -> NDArray[np.float32]:
    """(H, W, C) drawn anew at positions x, y (integer pixel centres): Catmull-Rom, the rim repeated outside."""
    out = np.empty((*x.shape, picture.shape[2]), np.float32)

    def draw(band: tuple[int, int]) -> None:
        sample_cubic(picture, x, y, band[0], band[1], out)

    parallel_map(draw, pieces(len(x), BAND))
    return out


def remove_lens(
    pixels: NDArray[np.float32], mask: NDArray[np.float32] | None, K: NDArray[np.float64], lens: Lens
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The photograph (H, W, 3) and its mask (H, W) as the pinhole camera K sees them; mask 0 outside the photograph.

    Colours are weighted by the mask, so that what does not count never bleeds into what does.
    """
    height, width = pixels.shape[:2]
    x, y, inside = source_positions(K, lens, width, height)
    if not np.isfinite(x).all() or not np.isfinite(y).all():
        raise CaptureError("lens", "the lens coefficients give positions that are not finite", remedy="mend them")
    if mask is None:
        return np.clip(resample(pixels, x, y), 0, 1), inside.astype(np.float32)
    weighted = resample(np.concatenate([pixels * mask[..., None], mask[..., None]], axis=2), x, y)
    weight = weighted[..., 3:]
    colours = np.where(weight > 0.05, weighted[..., :3] / np.maximum(weight, 0.05), resample(pixels, x, y))
    return np.clip(colours, 0, 1), np.clip(weight[..., 0], 0, 1) * inside
