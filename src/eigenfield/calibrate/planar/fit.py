"""One Gauss-Newton step of cameras towards a texture whose depth is known."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.planar.array import PARAMETERS, ArrayModel
from eigenfield.calibrate.planar.kernels import normal_equations
from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.reference_view import ReferenceView

TEXTURED = 2.0  # grey levels a pixel: weaker gradients say nothing of a camera
POINTS = 60_000  # that cameras are fitted to
CORRELATED = 100  # residuals that count as one: neighbouring pixels and channels are not independent


@dataclass(frozen=True, eq=False)
class Sight:
    """What cameras are fitted to: packed pictures (n, H, W), depth buffers (n, H, W) of the views with their bias, and
    points of the canvas (k, 3) x, y, d with their colours (k, 3)."""

    canvas: ReferenceView
    pictures: NDArray[np.uint32]
    buffers: NDArray[np.float32]
    points: NDArray[np.float32]
    colours: NDArray[np.float32]
    bias: float


def textured_points(
    d: NDArray[np.float32], texture: NDArray[np.float32], seen: NDArray[np.bool_]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(k, 3) x, y, d of textured points among `seen`, evenly thinned to POINTS, and their colours (k, 3)."""
    grey = texture.mean(axis=-1)
    slope = np.hypot(cv2.Sobel(grey, cv2.CV_32F, 1, 0), cv2.Sobel(grey, cv2.CV_32F, 0, 1)) / 8
    good = np.flatnonzero((slope > TEXTURED) & seen)
    good = good[:: max(1, len(good) // POINTS)]
    y, x = np.divmod(good, d.shape[1])
    points = np.stack([x, y, d.ravel()[good]], axis=1).astype(np.float32)
    return points, np.ascontiguousarray(texture.reshape(-1, 3)[good])


def camera_step(
    model: ArrayModel,
    views: NDArray[np.int64],
    parameters: NDArray[np.float64],
    sight: Sight,
    count: int,
    tau: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """One Gauss-Newton step of the first `count` parameters of each of `views`.

    Returns the new (len(views), 10) parameters, and the root mean square differences before it, grey levels.
    """
    channels = sight.pictures.view(np.uint8).reshape(*sight.pictures.shape, 4)
    matrices = model.matrices(sight.canvas, views, parameters)
    derivatives = model.derivatives(sight.canvas, views, parameters)
    prior = 1 / model.sigma[:count] ** 2

    def step(k: int) -> tuple[NDArray[np.float64], float]:
        left, right = np.zeros((PARAMETERS, PARAMETERS)), np.zeros(PARAMETERS)
        total, seen = normal_equations(
            channels[k], sight.points, sight.colours, matrices[k], derivatives[k], sight.buffers[k],
            sight.bias, tau, left, right,
        )  # fmt: skip
        moved = parameters[k].copy()
        # neighbouring pixels and channels are not independent: a hundred of these residuals count as one
        moved[:count] += np.linalg.solve(
            left[:count, :count] / CORRELATED + np.diag(prior), right[:count] / CORRELATED - moved[:count] * prior
        )
        return moved, (total / (3 * seen)) ** 0.5 if seen else np.nan

    results = parallel_map(step, range(len(views)))
    return np.array([moved for moved, _ in results]), np.array([error for _, error in results])
