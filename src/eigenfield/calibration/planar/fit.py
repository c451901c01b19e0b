"""One Gauss-Newton step of cameras towards a texture with known depth."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.planar.array import ArrayModel
from eigenfield.calibration.planar.kernels import normal_equations
from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.reference_view import ReferenceView
from eigenfield.stereo.views import picture_bytes

FIT_MIN_VIEW_FRACTION = 0.15  # of the views, which must see a point that cameras are fitted to
FIT_MIN_GRADIENT_LEVELS = 2.0  # a pixel: weaker gradients do not constrain a camera
FIT_POINTS_PER_PARAMETER = 6_000  # of a camera, at most
FIT_CORRELATED_RESIDUALS = 100  # count as one: neighbouring pixels and channels are not independent


@dataclass(frozen=True, eq=False)
class PhotometricTarget:
    """What cameras are fitted to.

    Attributes:
        reference: The view in which the points lie.
        pictures: (n, H, W) packed pictures of the views.
        buffers: (n, H, W) their depth buffers.
        points: (k, 3) x, y, d in the reference view.
        colours: (k, 3) their colours.
        bias: Labels behind the depth buffer at which a point still counts as visible.
    """

    reference: ReferenceView
    pictures: NDArray[np.uint32]
    buffers: NDArray[np.float32]
    points: NDArray[np.float32]
    colours: NDArray[np.float32]
    bias: float


def select_textured_points(
    d: NDArray[np.float32], texture: NDArray[np.float32], count: NDArray[np.int32], views: int, parameters: int
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Points with texture that enough views see, evenly subsampled to FIT_POINTS_PER_PARAMETER each.

    Args:
        d: (h, w) labels.
        texture: (h, w, 3) mean texture, grey levels.
        count: (h, w) number of views that see each point.

    Returns:
        (k, 3) x, y, d, and (k, 3) colours.
    """
    grey = texture.mean(axis=-1)
    slope = np.hypot(cv2.Sobel(grey, cv2.CV_32F, 1, 0), cv2.Sobel(grey, cv2.CV_32F, 0, 1)) / 8
    good = np.flatnonzero((slope > FIT_MIN_GRADIENT_LEVELS) & (count > max(2, FIT_MIN_VIEW_FRACTION * views)))
    good = good[:: max(1, len(good) // (FIT_POINTS_PER_PARAMETER * parameters))]
    y, x = np.divmod(good, d.shape[1])
    points = np.stack([x, y, d.ravel()[good]], axis=1).astype(np.float32)
    return points, np.ascontiguousarray(texture.reshape(-1, 3)[good])


def gauss_newton_step(
    model: ArrayModel,
    views: NDArray[np.int64],
    parameters: NDArray[np.float64],
    target: PhotometricTarget,
    count: int,
    tau: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """One Gauss-Newton step of the first `count` parameters of each view.

    Args:
        views: (v,) indices.
        parameters: (v, 10) before the step.
        count: Number of free parameters.
        tau: Scale of the Cauchy loss, grey levels.

    Returns:
        (v, 10) parameters, and (v,) root mean square differences before the step, grey levels.
    """
    channels = picture_bytes(target.pictures)
    matrices = model.matrices(target.reference, views, parameters)
    derivatives = model.derivatives(target.reference, views, parameters, count)
    prior = 1 / model.sigma[:count] ** 2

    def step(k: int) -> tuple[NDArray[np.float64], float]:
        left, right = np.zeros((3, 3, 16)), np.zeros((3, 4))
        total, seen = normal_equations(
            channels[k], target.points, target.colours, matrices[k], target.buffers[k], target.bias, tau, left, right
        )
        chain = derivatives[k]  # of the matrix by each parameter
        hessian = np.einsum("pik,ijkl,qjl->pq", chain, left.reshape(3, 3, 4, 4), chain, optimize=True)
        gradient = np.einsum("pik,ik->p", chain, right)
        moved = parameters[k].copy()
        moved[:count] += np.linalg.solve(
            hessian / FIT_CORRELATED_RESIDUALS + np.diag(prior),
            gradient / FIT_CORRELATED_RESIDUALS - moved[:count] * prior,
        )
        return moved, (total / (3 * seen)) ** 0.5 if seen else np.nan

    results = parallel_map(step, range(len(views)))
    return np.array([moved for moved, _ in results]), np.array([error for _, error in results])
