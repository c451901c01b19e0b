"""A camera at a viewpoint between the captured ones, and ways through the array."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera, nearest_rotation
from eigenfield.core.errors import OptionError
from eigenfield.core.scene import Scene
from eigenfield.rendering.weights import place_weights

FLIGHT_PATHS = ("circle", "spiral", "grid")
FLIGHT_FRAMES = 120  # of a path, where none are asked for
FLIGHT_RADIUS_HALF_WIDTHS = 0.9  # half widths of the array; beyond its rim views are extrapolated
FLIGHT_SPIRAL_TURNS = 3
FLIGHT_GRID_ROWS = 5


def novel_camera(scene: Scene, at: tuple[float, float]) -> Camera:
    """The camera at a viewpoint, as large as the reference camera.

    Its centre is the point of the view plane. K is the mean of the captured cameras' with Delaunay weights: in a
    rectified array the principal point moves with the camera, which keeps the plane of zero parallax in its place. R is
    the rotation nearest to their weighted mean.

    Args:
        at: View-plane coordinates, clamped to the array's [-1, 1].

    Raises:
        OptionError: `viewpoint`.
    """
    cameras, weights = place_weights(scene, at)
    x, y = np.clip(np.asarray(at, dtype=np.float64), -1.0, 1.0)
    reference = scene.rig.cameras[scene.rig.reference]
    K, R = np.zeros((3, 3)), np.zeros((3, 3))
    for index, weight in zip(cameras, weights, strict=True):
        camera = scene.rig.cameras[index].resize(reference.width, reference.height)
        K += weight * camera.K
        R += weight * camera.R
    rotation = nearest_rotation(R)
    centre = scene.rig.view_plane.point(float(x), float(y))
    return Camera(K, rotation, -rotation @ centre, reference.width, reference.height)


def path_points(name: str, frames: int) -> NDArray[np.float64]:
    """(frames, 2) view-plane coordinates X, Y along a path.

    `circle`: once around, counter-clockwise as the cameras see it; the frame after the last would be the first.
    `spiral`: from the middle outwards in three turns, at an even pace. `grid`: five rows, top to bottom, to and fro.
    Cameras on a line follow X alone.

    Args:
        name: One of `FLIGHT_PATHS`.

    Raises:
        OptionError: `path`, `frames`.
    """
    if frames < 1:
        raise OptionError("frames", f"{frames} frames were asked for", remedy="ask for 1 or more")
    if name == "circle":
        angle = 2 * np.pi * np.arange(frames) / frames
        return FLIGHT_RADIUS_HALF_WIDTHS * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    if name == "spiral":
        radius = np.sqrt(np.linspace(0, 1, frames))  # even pace: the length of a turn grows with its radius
        angle = 2 * np.pi * FLIGHT_SPIRAL_TURNS * radius
        return FLIGHT_RADIUS_HALF_WIDTHS * radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    if name == "grid":
        ends = FLIGHT_RADIUS_HALF_WIDTHS * np.array([1.0, -1.0])
        y = np.repeat(np.linspace(FLIGHT_RADIUS_HALF_WIDTHS, -FLIGHT_RADIUS_HALF_WIDTHS, FLIGHT_GRID_ROWS), 2)
        x = np.concatenate([-ends if row % 2 == 0 else ends for row in range(FLIGHT_GRID_ROWS)])
        return _resample_evenly(np.stack([x, y], axis=1), frames)
    raise OptionError("path", f"no path is called {name!r}", remedy=f"use one of {', '.join(FLIGHT_PATHS)}")


def _resample_evenly(corners: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """(count, 2) points at even distances along a line through (n, 2) corners."""
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    at = np.linspace(0, length[-1], count)
    return np.stack([np.interp(at, length, corners[:, 0]), np.interp(at, length, corners[:, 1])], axis=1)
