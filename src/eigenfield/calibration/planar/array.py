"""Cameras of a planar array with one viewing direction: a base camera each, with ten small corrections.

A camera's parameters, in the axes of the reference camera (x right, y down, z forward):

    a, b     position in the array's plane, in steps
    sx, sy   shift in pixels of the anchor's image
    rz, ls   rotation about the optical axis (radians), logarithm of the scale
    rx, ry   rotations about x and y (radians)
    cz, asp  position along z (in `depth_unit`s), logarithm of the aspect

The anchor is a point in the middle of the scene. The principal point follows position and rotation so that they do not
move its image. Shift, position and rotation are then almost uncorrelated.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.stereo.reference_view import ReferenceView, view_matrices

ARRAY_PARAMETERS = 10
ARRAY_POSITION = slice(0, 2)
ARRAY_SHIFT = slice(2, 4)
# Gaussian priors, one sigma. A gantry rotates and tilts little. A regular grid is a weak prior of positions and shifts,
# a given calibration a strong one.
ARRAY_FREE_SIGMA = np.array([1e3, 1e3, 1e3, 1e3, 0.005, 0.005, 0.003, 0.003, 0.02, 0.003])
ARRAY_GIVEN_SIGMA = np.array([0.05, 0.05, 1.0, 1.0, 0.002, 0.002, 0.002, 0.002, 0.005, 0.001])
ARRAY_DERIVATIVE_STEPS = np.array([1e-3, 1e-3, 1e-2, 1e-2, 1e-5, 1e-5, 1e-5, 1e-5, 1e-4, 1e-5])  # of finite differences


@dataclass(frozen=True, eq=False)
class ArrayModel:
    """The fixed part of an array's cameras.

    Attributes:
        bases: The base camera of each view.
        reference: The camera from which depth is seen.
        anchor: (3,) world point.
        step: World units of one step.
        depth_unit: World units of cz.
        offset: 1/Z = offset + scale d in the reference camera (see `ReferenceView`).
        scale: See `offset`.
        sigma: (10,) priors, one sigma.
    """

    bases: tuple[Camera, ...]
    reference: Camera
    anchor: NDArray[np.float64]
    step: float
    depth_unit: float
    offset: float
    scale: float
    sigma: NDArray[np.float64]

    @staticmethod
    def planar(count: int, width: int, height: int, focal: float, offset: float, scale: float) -> ArrayModel:
        """An array of equal cameras at the origin that look along -z, with y up as in glTF.

        All positions are in the parameters. The anchor is at d = 0, and d is the disparity of one step:
        focal x step x scale = 1.

        Args:
            count: Number of views.
            width: Pixels.
            height: Pixels.
            focal: Pixels.
        """
        K = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1.0]])
        camera = Camera(K, np.diag([1.0, -1.0, -1.0]), np.zeros(3), width, height)
        anchor = np.array([0, 0, -1 / offset])
        return ArrayModel(
            (camera,) * count, camera, anchor, 1 / (focal * scale), 1 / offset, offset, scale, ARRAY_FREE_SIGMA
        )

    def camera(self, view: int, parameters: NDArray[np.float64]) -> Camera:
        """The camera of a view.

        Args:
            parameters: (10,) of the view.
        """
        base = self.bases[view]
        a, b, sx, sy, rz, ls, rx, ry, cz, aspect = parameters
        R = cv2.Rodrigues(np.array([rx, ry, rz]))[0] @ base.R
        moved = np.array([a * self.step, b * self.step, cz * self.depth_unit])
        centre = base.centre + self.reference.R.T @ moved
        K = base.K.copy()
        K[0, 0] *= np.exp(ls + aspect)
        K[1, 1] *= np.exp(ls - aspect)
        before = base.K @ (base.R @ self.anchor + base.t)
        after = R @ (self.anchor - centre)
        K[0, 2] = before[0] / before[2] + sx - (K[0, 0] * after[0] + K[0, 1] * after[1]) / after[2]
        K[1, 2] = before[1] / before[2] + sy - K[1, 1] * after[1] / after[2]
        return Camera(K, R, -R @ centre, base.width, base.height)

    def cameras(self, views: NDArray[np.int64], parameters: NDArray[np.float64]) -> list[Camera]:
        """The cameras of several views.

        Args:
            views: (v,) indices.
            parameters: (v, 10).
        """
        return [self.camera(int(view), row) for view, row in zip(views, parameters, strict=True)]

    def reference_view(self, margin: int) -> ReferenceView:
        """The reference camera's view, widened.

        Args:
            margin: Pixels added on every side.
        """
        return ReferenceView.with_margin(self.reference, margin, self.offset, self.scale)

    def matrices(
        self, reference: ReferenceView, views: NDArray[np.int64], parameters: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(v, 3, 4) matrices on (x, y, d, 1).

        Args:
            reference: Whose points are projected.
            views: (v,) indices.
            parameters: (v, 10).
        """
        return view_matrices(reference, self.cameras(views, parameters))

    def derivatives(
        self, reference: ReferenceView, views: NDArray[np.int64], parameters: NDArray[np.float64], count: int
    ) -> NDArray[np.float64]:
        """(v, count, 3, 4) derivatives of the matrices by the first parameters, by central differences.

        Args:
            reference: Whose points are projected.
            views: (v,) indices.
            parameters: (v, 10).
        """
        result = np.zeros((len(views), count, 3, 4))
        for index, step in enumerate(ARRAY_DERIVATIVE_STEPS[:count]):
            moved = np.zeros(ARRAY_PARAMETERS)
            moved[index] = step
            plus, minus = (self.matrices(reference, views, parameters + sign * moved) for sign in (1, -1))
            result[:, index] = (plus - minus) / (2 * step)
        return result
