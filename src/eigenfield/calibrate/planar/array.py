"""Cameras of an array that looks one way: each a base camera with ten small corrections.

A camera's parameters, in the axes of the reference camera (x right, y down, z forward):

    a, b     position in the array's plane, in steps
    sx, sy   shift in pixels of where the anchor is seen
    rz, ls   rotation about the optical axis (radians), logarithm of the scale
    rx, ry   rotations about x and y (radians)
    cz, asp  position along z (in `depth_unit`s), logarithm of the aspect

The anchor is a point in the middle of the scene; the principal point follows position and rotation so that they do not
move it. Shift, position and rotation then hardly influence one another.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.stereo.reference_view import ReferenceView, view_matrices

PARAMETERS = 10
POSITION = slice(0, 2)
SHIFT = slice(2, 4)
# Gaussian priors, one sigma. A gantry turns and tilts little; a regular grid says nothing sure of positions and shifts,
# a calibration that is given says much.
FREE = np.array([1e3, 1e3, 1e3, 1e3, 0.005, 0.005, 0.003, 0.003, 0.02, 0.003])
GIVEN = np.array([0.05, 0.05, 1.0, 1.0, 0.002, 0.002, 0.002, 0.002, 0.005, 0.001])
STEP = np.array([1e-3, 1e-3, 1e-2, 1e-2, 1e-5, 1e-5, 1e-5, 1e-5, 1e-4, 1e-5])  # of finite differences


@dataclass(frozen=True, eq=False)
class ArrayModel:
    """What the cameras of an array are corrections of.

    bases: one camera each. reference: the camera from which depth is seen. anchor: (3,) world point.
    step: world units of one step. depth_unit: world units of cz.
    offset, scale: 1/Z = offset + scale d in the reference camera (see `ReferenceView`).
    sigma: (10,) priors.
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
        """`count` times the camera at the origin that looks along -z, y up as in glTF: positions are all in the
        parameters. The anchor is at d = 0, and d is the disparity of one step: focal x step x scale = 1."""
        K = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1.0]])
        camera = Camera(K, np.diag([1.0, -1.0, -1.0]), np.zeros(3), width, height)
        anchor = np.array([0, 0, -1 / offset])
        return ArrayModel((camera,) * count, camera, anchor, 1 / (focal * scale), 1 / offset, offset, scale, FREE)

    def camera(self, view: int, parameters: NDArray[np.float64]) -> Camera:
        """The camera of `view` with (10,) parameters."""
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
        """The cameras of `views`, (len(views), 10) parameters."""
        return [self.camera(int(view), row) for view, row in zip(views, parameters, strict=True)]

    def canvas(self, margin: int) -> ReferenceView:
        """The reference camera's frame, widened by `margin` pixels."""
        return ReferenceView.with_margin(self.reference, margin, self.offset, self.scale)

    def matrices(
        self, canvas: ReferenceView, views: NDArray[np.int64], parameters: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(len(views), 3, 4) matrices on (x, y, d, 1)."""
        return view_matrices(canvas, self.cameras(views, parameters))

    def derivatives(
        self, canvas: ReferenceView, views: NDArray[np.int64], parameters: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """(len(views), 10, 3, 4): the matrices' derivatives by each parameter, by central differences."""
        result = np.zeros((len(views), PARAMETERS, 3, 4))
        for index, step in enumerate(STEP):
            moved = np.zeros(PARAMETERS)
            moved[index] = step
            plus, minus = (self.matrices(canvas, views, parameters + sign * moved) for sign in (1, -1))
            result[:, index] = (plus - minus) / (2 * step)
        return result

    def subset(self, views: Sequence[int]) -> ArrayModel:
        """The model of some of the views."""
        return replace(self, bases=tuple(self.bases[view] for view in views))
