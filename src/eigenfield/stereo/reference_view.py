"""The reference view in which depth is estimated, and how its points project into the photographs.

A point is (x, y, d): a pixel of a reference camera and a label d that is affine in inverse depth,

    1 / Z = offset + scale d,    scale > 0: a larger label is nearer.

In a two-plane light field d is the disparity between neighbouring cameras of the array. For other captures it is chosen
so that one unit of d moves a point by about one pixel in a neighbouring view. A pinhole camera is then a 3x4 matrix on
(x, y, d, 1).

Kernels use index coordinates: the centre of the top-left pixel is (0, 0), not (0.5, 0.5) as in `Camera`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera

INDEX_FROM_PIXEL = np.array(
    [[1, 0, -0.5], [0, 1, -0.5], [0, 0, 1.0]]
)  # takes pixel coordinates (centres at +0.5) to indices


@dataclass(frozen=True, eq=False)
class ReferenceView:
    """A reference camera and the meaning of its labels.

    Attributes:
        camera: The reference camera. Its frame may be larger than the photograph (`with_margin`).
        margin: Pixels by which the frame extends beyond the photograph on every side.
        offset: Inverse depth of label 0 along the camera's axis, 1 / world unit.
        scale: Inverse depth of one label, 1 / world unit: 1/Z = offset + scale d.
    """

    camera: Camera
    margin: int
    offset: float
    scale: float

    @staticmethod
    def with_margin(camera: Camera, margin: int, offset: float, scale: float) -> ReferenceView:
        """The reference view of a camera whose frame is widened on every side."""
        K = camera.K.copy()
        K[:2, 2] += margin
        wide = replace(camera, K=K, width=camera.width + 2 * margin, height=camera.height + 2 * margin)
        return ReferenceView(wide, margin, offset, scale)

    @property
    def shape(self) -> tuple[int, int]:
        """(height, width) in pixels."""
        return self.camera.height, self.camera.width

    @property
    def photograph_size(self) -> tuple[int, int]:
        """(width, height) within the margin."""
        return self.camera.width - 2 * self.margin, self.camera.height - 2 * self.margin

    def points(self, x: NDArray[np.float64], y: NDArray[np.float64], d: NDArray[np.float64]) -> NDArray[np.float64]:
        """World points of index coordinates and labels.

        Returns:
            (..., 3) points; infinite or behind the camera where offset + scale d <= 0.
        """
        rays = np.stack([x + 0.5, y + 0.5, np.ones_like(x)], axis=-1) @ np.linalg.inv(self.camera.K).T
        with np.errstate(divide="ignore"):
            local = rays / (self.offset + self.scale * d)[..., None]
        return (local - self.camera.t) @ self.camera.R

    def at_half_resolution(self) -> ReferenceView:
        """The same view at half the resolution, with sizes rounded up. Labels keep their meaning."""
        width, height = (self.camera.width + 1) // 2, (self.camera.height + 1) // 2
        K = np.diag([0.5, 0.5, 1]) @ self.camera.K
        return replace(self, camera=replace(self.camera, K=K, width=width, height=height), margin=self.margin // 2)


def view_matrices(reference: ReferenceView, cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """Each camera's matrix from (x, y, d, 1) to homogeneous index coordinates of its photograph.

    With the ray q = K_r^-1 (x + 0.5, y + 0.5, 1), the world point is R_r^T (q / w - t_r), w = offset + scale d;
    times w it projects to K R R_r^T q + w K (t - R R_r^T t_r).

    Returns:
        (V, 3, 4) matrices.
    """
    source = reference.camera
    unproject = np.linalg.inv(source.K) @ np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1.0]])
    result = np.zeros((len(cameras), 3, 4))
    for matrix, camera in zip(result, cameras, strict=True):
        rotation = camera.R @ source.R.T
        shift = INDEX_FROM_PIXEL @ camera.K @ (camera.t - rotation @ source.t)
        base = INDEX_FROM_PIXEL @ camera.K @ rotation @ unproject
        matrix[:, :2] = base[:, :2]
        matrix[:, 2] = reference.scale * shift
        matrix[:, 3] = base[:, 2] + reference.offset * shift
    return result
