"""Flat Gaussians in a scene's world, and how a camera sees them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.viewer.exports.splats.kernels import SPLAT_REACH_SIGMAS, splat

SH_DEGREE = 2
SH_ZERO = 0.28209479177387814  # the harmonic of degree 0
_SH_ONE, _SH_TWO = 0.4886025119029199, (1.0925484305920792, 0.31539156525252005, 0.5462742152960396)
SPLAT_LEAST_VARIANCE_PX = 1e-3  # of a Gaussian that is seen edge-on


@dataclass(frozen=True, eq=False)
class Gaussians:
    """N Gaussians, as `KHR_gaussian_splatting` has them, in the scene's world.

    Attributes:
        positions: (N, 3) float64.
        rotations: (N, 3, 3) float64, columns are their axes, the last one the normal of the surface.
        scales: (N, 3) float64, standard deviations along these.
        opacity: (N,) float32 in 0..1.
        harmonics: (N, k, 3) float32 coefficients of R, G, B: degree 0 alone (k = 1), or up to `SH_DEGREE`.
    """

    positions: NDArray[np.float64]
    rotations: NDArray[np.float64]
    scales: NDArray[np.float64]
    opacity: NDArray[np.float32]
    harmonics: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.positions)

    def colours(self, basis: NDArray[np.float32]) -> NDArray[np.float32]:
        """(N, 3) their colours, 0..1, where `basis` (N, k) are the harmonics of the directions they are seen in."""
        return np.clip(np.einsum("nk,nkc->nc", basis, self.harmonics) + np.float32(0.5), 0, 1)


def joined(parts: Sequence[Gaussians]) -> Gaussians:
    """Several as one."""
    return Gaussians(*(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(Gaussians)))


@dataclass(frozen=True, eq=False)
class Footprint2D:
    """Gaussians in a camera's picture: arguments of `kernels.splat`."""

    shape: tuple[int, int]
    order: NDArray[np.int64]
    pixels: NDArray[np.float32]
    conics: NDArray[np.float32]
    reaches: NDArray[np.float32]
    opacity: NDArray[np.float32]

    def draw(self, colours: NDArray[np.float32]) -> NDArray[np.float32]:
        """(H, W, 3) the picture of colours (N, 3), on black."""
        image = np.zeros((*self.shape, 3), np.float32)
        self._pass(colours, False, image, np.zeros((1, 4), np.float32))
        return image

    def gather(self, image: NDArray[np.float32]) -> NDArray[np.float32]:
        """(N, 4) the sum over a picture (H, W, 3), weighted by how much of each pixel a Gaussian is; and of weights."""
        sums = np.zeros((len(self.pixels), 4), np.float32)
        self._pass(np.zeros((1, 3), np.float32), True, image, sums)
        return sums

    def _pass(
        self, colours: NDArray[np.float32], gather: bool, image: NDArray[np.float32], sums: NDArray[np.float32]
    ) -> None:
        rest = np.ones(self.shape, np.float32)
        splat(self.order, self.pixels, self.conics, self.reaches, self.opacity, colours, gather, image, rest, sums)


def footprint_of(gaussians: Gaussians, camera: Camera) -> Footprint2D:
    """The Gaussians as a camera sees them, the nearest first.

    The covariance is that of the projection's first derivatives in the middle of the Gaussian.
    """
    matrix = camera.matrix
    pixels, depth = camera.project(gaussians.positions)
    ahead = depth > 0
    depth, pixels = np.where(ahead, depth, 1.0), np.where(ahead[:, None], pixels, 0.0)
    slopes = (matrix[:2, :3] - pixels[:, :, None] * matrix[2, :3]) / depth[:, None, None]
    spread = slopes @ (gaussians.rotations * gaussians.scales[:, None])
    covariance = spread @ spread.transpose(0, 2, 1)
    xx, yy = (covariance[:, k, k] + SPLAT_LEAST_VARIANCE_PX for k in range(2))
    xy = covariance[:, 0, 1]
    conics = np.stack([yy, -xy, xx], axis=1) / (xx * yy - xy * xy)[:, None]
    reaches = SPLAT_REACH_SIGMAS * np.sqrt(np.stack([xx, yy], axis=1))
    size = np.array([camera.width, camera.height])
    shown = ahead & (pixels > -reaches).all(axis=1) & (pixels < size + reaches).all(axis=1)
    order = np.flatnonzero(shown)
    distance = np.linalg.norm(gaussians.positions[order] - camera.centre, axis=1)
    order = order[np.argsort(distance, kind="stable")]
    near, inverse, ends = (array.astype(np.float32) for array in (pixels, conics, reaches))
    return Footprint2D((camera.height, camera.width), order, near, inverse, ends, gaussians.opacity)


def harmonics_of(directions: NDArray[np.float64], degree: int) -> NDArray[np.float32]:
    """(n, (degree + 1)²) the real spherical harmonics of directions (n, 3) from the eye, in glTF's axes, with the signs
    of `KHR_gaussian_splatting`, degree 0 to 2."""
    x, y, z = (directions / np.linalg.norm(directions, axis=1, keepdims=True)).T
    found = [np.full(len(x), SH_ZERO)]
    if degree >= 1:
        found += [-_SH_ONE * y, _SH_ONE * z, -_SH_ONE * x]
    if degree >= 2:
        two, zero, square = _SH_TWO
        found += [two * x * y, -two * y * z, zero * (2 * z * z - x * x - y * y), -two * x * z, square * (x * x - y * y)]
    return np.stack(found, axis=1).astype(np.float32)
