"""The frame in which depth is estimated, and how its points project into the photographs.

A point is (x, y, d): a pixel of a reference camera and a label d that is affine in inverse depth,

    1 / Z = offset + scale d,    scale > 0: larger is nearer.

In a two-plane light field d is the disparity of one step of the array; anywhere it is chosen so that one unit of d
moves a point by about one pixel in a neighbouring view. A pinhole camera is then one 3x4 matrix on (x, y, d, 1).

Kernels count pixels by index: the centre of the top-left pixel is (0, 0) here, not (0.5, 0.5) as in cameras.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera

HALF = np.array([[1, 0, -0.5], [0, 1, -0.5], [0, 0, 1.0]])  # from pixels with centres at +0.5 to indices


@dataclass(frozen=True, eq=False)
class Canvas:
    """A reference camera and the meaning of its labels.

    camera: the reference camera; its frame may reach beyond the photograph's (`widened`).
    margin: by how many pixels it does, on every side.
    offset, scale: 1/Z = offset + scale d, Z along the reference camera's axis.
    """

    camera: Camera
    margin: int
    offset: float
    scale: float

    @staticmethod
    def around(camera: Camera, margin: int, offset: float, scale: float) -> Canvas:
        """The canvas of `camera` with its frame widened by `margin` pixels on every side."""
        K = camera.K.copy()
        K[:2, 2] += margin
        wide = replace(camera, K=K, width=camera.width + 2 * margin, height=camera.height + 2 * margin)
        return Canvas(wide, margin, offset, scale)

    @property
    def shape(self) -> tuple[int, int]:
        """(height, width) in pixels."""
        return self.camera.height, self.camera.width

    def points(self, x: NDArray[np.float64], y: NDArray[np.float64], d: NDArray[np.float64]) -> NDArray[np.float64]:
        """World points (..., 3) of index coordinates and labels; infinite or behind where offset + scale d <= 0."""
        rays = np.stack([x + 0.5, y + 0.5, np.ones_like(x)], axis=-1) @ np.linalg.inv(self.camera.K).T
        with np.errstate(divide="ignore"):
            local = rays / (self.offset + self.scale * d)[..., None]
        return (local - self.camera.t) @ self.camera.R

    def halved(self) -> Canvas:
        """The same canvas at half the resolution (sizes rounded up); labels keep their meaning."""
        width, height = (self.camera.width + 1) // 2, (self.camera.height + 1) // 2
        K = np.diag([0.5, 0.5, 1]) @ self.camera.K
        return replace(self, camera=replace(self.camera, K=K, width=width, height=height), margin=self.margin // 2)


def view_matrices(canvas: Canvas, cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """(V, 3, 4): each camera's matrix from (x, y, d, 1) to homogeneous index coordinates of its photograph.

    With the ray q = K_r^-1 (x + 0.5, y + 0.5, 1), the world point is R_r^T (q / w - t_r), w = offset + scale d;
    times w it projects to K R R_r^T q + w K (t - R R_r^T t_r).
    """
    reference = canvas.camera
    lift = np.linalg.inv(reference.K) @ np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1.0]])
    result = np.zeros((len(cameras), 3, 4))
    for matrix, camera in zip(result, cameras, strict=True):
        turn = camera.R @ reference.R.T
        shift = HALF @ camera.K @ (camera.t - turn @ reference.t)
        base = HALF @ camera.K @ turn @ lift
        matrix[:, :2] = base[:, :2]
        matrix[:, 2] = canvas.scale * shift
        matrix[:, 3] = base[:, 2] + canvas.offset * shift
    return result
