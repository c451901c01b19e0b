"""Cameras side by side that look one way and share a plane without parallax: quilts, grids of views, two eyes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.proxy import opaque_mesh
from eigenfield.core.scene import Scene
from eigenfield.imaging.raster import rasterise_view
from eigenfield.rendering.novel import novel_camera
from eigenfield.rendering.software.renderer import at_resolution

PARALLEL_MIN_COSINE = 0.7  # between the array's X and the cameras' own x axis


@dataclass(frozen=True, eq=False)
class ParallelCameras:
    """Cameras at any place of an array, with the same axes; principal points are shifted so that one point stays.

    Attributes:
        base: The camera of the array's middle, for focal lengths and size.
        R: (3, 3) the axes of all, with x along the array's X.
        focus: (3,) what all see in the middle of the picture.
        depth: Of the focus along z, which is the same for all.
    """

    base: Camera
    R: NDArray[np.float64]
    focus: NDArray[np.float64]
    depth: float

    def at(self, centre: NDArray[np.float64]) -> Camera:
        """The camera that stands in a place (3,) of the world."""
        return camera_towards(self.base, self.R, centre, self.focus - centre)


def parallel_cameras(scene: Scene, size: tuple[int, int], *, square: bool = False) -> ParallelCameras:
    """The cameras of a scene whose focus is in the middle of the picture, at the median depth of what the array's
    middle sees.

    Args:
        size: (width, height) of the pictures.
        square: Whether both focal lengths are that of x.

    Raises:
        OptionError: `array-side`: the cameras do not stand side by side, or see nothing.
    """
    base = at_resolution(novel_camera(scene, (0.0, 0.0)), size)
    if square:
        K = base.K.copy()
        K[1, 1] = K[0, 0]
        base = Camera(K, base.R, base.t, base.width, base.height)
    right = scene.rig.view_plane.right
    if base.R[0] @ right < PARALLEL_MIN_COSINE:
        raise OptionError(
            "array-side",
            "the cameras do not stand side by side before the scene",
            remedy="this needs an array that looks one way",
        )
    forward = base.R[2] - (base.R[2] @ right) * right
    forward = forward / np.linalg.norm(forward)
    R = np.stack([right, np.cross(forward, right), forward])
    middle = base.R.T @ np.linalg.inv(base.K) @ (base.width / 2, base.height / 2, 1.0)
    towards = R @ middle
    near = inverse_depths(scene, camera_towards(base, R, base.centre, middle))
    if not len(near):
        raise OptionError(
            "array-side", "the array's middle sees nothing of the scene", remedy="there must be a surface before it"
        )
    depth = float(1 / np.median(near))
    return ParallelCameras(base, R, base.centre + middle * (depth / towards[2]), depth)


def inverse_depths(scene: Scene, camera: Camera) -> NDArray[np.float64]:
    """(n,) 1 / z of each pixel that shows the surface."""
    near = rasterise_view(opaque_mesh(scene.proxy), camera).inverse_depth
    return np.asarray(near[near > 0], np.float64)


def camera_towards(
    base: Camera, R: NDArray[np.float64], centre: NDArray[np.float64], direction: NDArray[np.float64]
) -> Camera:
    """A camera at `centre` with axes R and the focal lengths of `base`, which sees `direction` in its middle."""
    x, y, z = R @ direction
    fx, fy = base.K[0, 0], base.K[1, 1]
    K = np.array([[fx, 0, base.width / 2 - fx * x / z], [0, fy, base.height / 2 - fy * y / z], [0, 0, 1]])
    return Camera(K, R, -R @ centre, base.width, base.height)
