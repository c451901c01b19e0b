"""Lens distortion, and its removal: a photograph is resampled as the pinhole camera of the same K and size sees it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.kernels import sample_cubic
from eigenfield.core.errors import CaptureError
from eigenfield.runtime.parallel import parallel_map, pieces

LENS_BAND_ROWS = 64  # resampled at a time
LENS_NEGLIGIBLE_COEFFICIENT = 1e-12  # smaller ones are no distortion


@dataclass(frozen=True)
class Lens:
    """Distortion from normalised coordinates x = X / Z, y = Y / Z to distorted ones x', y', both times K.

    Models and their coefficients:
        "brown", (k1, k2, p1, p2, k3): x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), y' alike
            (OpenCV's default, COLMAP's SIMPLE_RADIAL, RADIAL and OPENCV).
        "fisheye", (k1, k2, k3, k4): theta' = theta (1 + k1 theta^2 + .. + k4 theta^8) (OpenCV's and COLMAP's fisheye).
        "rational", 8, 12 or 14 coefficients (k1, k2, p1, p2, k3, k4, k5, k6, s1..s4, tx, ty): OpenCV's, radial term
            (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6), thin prism and tilt.
        "metashape", (k1, k2, k3, k4, p1, p2, p3, p4, s): Agisoft's frame camera,
            x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8) + (p1 (r^2 + 2 x^2) + 2 p2 x y) (1 + p3 r^2 + p4 r^4), y'
            alike with p1 and p2 exchanged; then x' + s y': the skew, in units of the focal length (B2 / fx).
        "metashape-equidistant", "metashape-equisolid": the same, of the x, y scaled to the length theta, or
            2 sin(theta / 2), theta the angle to the axis: Agisoft's fisheye cameras.

    Attributes:
        model: One of these names.
        coefficients: In the order above.
    """

    model: Literal["brown", "fisheye", "rational", "metashape", "metashape-equidistant", "metashape-equisolid"]
    coefficients: tuple[float, ...]

    @property
    def is_fisheye(self) -> bool:
        """Whether without coefficients it is no pinhole."""
        return self.model in ("fisheye", "metashape-equidistant", "metashape-equisolid")

    @property
    def is_identity(self) -> bool:
        """Whether there is no distortion at all; a fisheye always has some."""
        return not self.is_fisheye and all(abs(c) < LENS_NEGLIGIBLE_COEFFICIENT for c in self.coefficients)

    def valid_radius(self) -> float:
        """The undistorted radius (tangent of the angle to the axis) up to which distortion grows with it.

        Beyond, the polynomial folds back and a pinhole picture would repeat the photograph's rim: nothing is there.
        CaptureError `lens` where the coefficients are beyond computing.
        """
        c = self.coefficients
        if self.model == "brown":
            return _first_fold((c[0], c[1], c[4]))
        if self.model == "rational":
            return _first_fold((c[0], c[1], c[4]), c[5:8])
        first = _first_fold(c[:4])  # of x, y; of theta; or of 2 sin(theta / 2)
        if self.model == "metashape":
            return first
        if self.model == "metashape-equisolid":
            first = 2 * np.arcsin(min(first / 2, 1.0))
        return float(np.tan(first)) if first < np.pi / 2 else np.inf


def _first_fold(above: tuple[float, ...], below: tuple[float, ...] = ()) -> float:
    """The smallest s > 0 at which s n(s^2) / d(s^2) stops to grow: n = 1 + above[0] q + above[1] q^2 .., d likewise."""
    n, d = np.polynomial.Polynomial((1.0, *above)), np.polynomial.Polynomial((1.0, *below))
    q = np.polynomial.Polynomial((0.0, 1.0))
    with np.errstate(all="ignore"):
        slope = (n + 2 * q * n.deriv()) * d - 2 * q * n * d.deriv()  # the derivative by s, times d^2
        try:
            roots = np.concatenate([np.roots(p.coef[::-1]) for p in (slope, d)])
        except np.linalg.LinAlgError as error:
            raise _not_finite_error() from error
    real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0)]
    return float(np.sqrt(real.min())) if len(real) else np.inf


def _not_finite_error() -> CaptureError:
    return CaptureError("lens", "the lens coefficients give positions that are not finite", remedy="mend them")


def source_positions(
    K: NDArray[np.float64], lens: Lens, width: int, height: int
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.bool_]]:
    """The position in the photograph of each pixel of the pinhole picture.

    OpenCV counts pixel centres from 0, we from 0.5: K is shifted first.

    Args:
        K: (3, 3) pixels, centres at +0.5.
        width: Of both pictures, pixels.

    Returns:
        x and y, (H, W) float32 positions with integer pixel centres, and (H, W) bool, whether the photograph covers
        them.
    """
    shifted = K - np.array([[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]])
    size = (width, height)
    d = np.array(lens.coefficients)
    if lens.model in ("brown", "rational"):
        x, y = cv2.initUndistortRectifyMap(shifted, d, np.eye(3), shifted, size, cv2.CV_32FC1)
    elif lens.model == "fisheye":
        x, y = cv2.fisheye.initUndistortRectifyMap(shifted, d, np.eye(3), shifted, size, cv2.CV_32FC1)
    else:
        u, v = metashape_distortion(*_pinhole_coordinates(shifted, width, height), lens)
        with np.errstate(over="ignore", invalid="ignore"):
            x, y = shifted[0, 0] * u + shifted[0, 1] * v + shifted[0, 2], shifted[1, 1] * v + shifted[1, 2]
    inside = (x >= -0.5) & (x <= width - 0.5) & (y >= -0.5) & (y <= height - 0.5)
    limit = lens.valid_radius()
    if np.isfinite(limit):
        nx, ny = _pinhole_coordinates(shifted, width, height)
        inside &= nx**2 + ny**2 < limit**2
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(x, np.float32), np.asarray(y, np.float32), inside


def _pinhole_coordinates(
    shifted: NDArray[np.float64], width: int, height: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """x = X / Z (H, W) and y = Y / Z (H, 1) of pixels whose centres are whole numbers."""
    y = ((np.arange(height) - shifted[1, 2]) / shifted[1, 1])[:, None]
    return (np.arange(width) - shifted[0, 2] - shifted[0, 1] * y) / shifted[0, 0], y


def metashape_distortion(
    x: NDArray[np.float64], y: NDArray[np.float64], lens: Lens
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distorted coordinates x', y' of one of Metashape's models (user manual, appendix "Camera models").

    Args:
        x: X / Z.
        y: Y / Z.
    """
    k1, k2, k3, k4, p1, p2, p3, p4, skew = lens.coefficients
    if lens.model != "metashape":
        radius = np.maximum(np.hypot(x, y), 1e-12)
        theta = np.arctan(radius)
        scale = (theta if lens.model == "metashape-equidistant" else 2 * np.sin(theta / 2)) / radius
        x, y = x * scale, y * scale
    with np.errstate(over="ignore", invalid="ignore"):
        q = x * x + y * y
        radial = 1 + q * (k1 + q * (k2 + q * (k3 + q * k4)))
        more = 1 + q * (p3 + q * p4)
        u = x * radial + (p1 * (q + 2 * x * x) + 2 * p2 * x * y) * more
        v = y * radial + (p2 * (q + 2 * y * y) + 2 * p1 * x * y) * more
        return u + skew * v, v


def resample(picture: NDArray[np.float32], x: NDArray[np.float32], y: NDArray[np.float32]) -> NDArray[np.float32]:
    """A picture (H, W, C) sampled at positions x, y (h, w) with integer pixel centres: Catmull-Rom, the rim repeated
    outside."""
    out = np.empty((*x.shape, picture.shape[2]), np.float32)

    parallel_map(lambda band: sample_cubic(picture, x, y, *band, out), pieces(len(x), LENS_BAND_ROWS))
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
        raise _not_finite_error()
    if mask is None:
        return np.clip(resample(pixels, x, y), 0, 1), inside.astype(np.float32)
    weighted = resample(np.concatenate([pixels * mask[..., None], mask[..., None]], axis=2), x, y)
    weight = weighted[..., 3:]
    colours = np.where(weight > 0.05, weighted[..., :3] / np.maximum(weight, 0.05), resample(pixels, x, y))
    return np.clip(colours, 0, 1), np.clip(weight[..., 0], 0, 1) * inside
