"""The demo's array: pinholes in one plane, shifted so that one point of the scene stays in the middle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera

DEMO_FOCAL_WIDTHS = 2.15  # focal length
DEMO_DISTANCE_UNITS = 5.2  # from the array to the point that stays in the middle
DEMO_PITCH_RADIANS = np.radians(17)  # downwards
DEMO_TARGET = np.array([0.02, 0.60, 0.0])
DEMO_HALF_ARRAY_UNITS = 0.5  # half the array's width; a near and a far point move by about 40 pixels of 512 across it
DEMO_JITTER_SEED = 20190916


def array_camera(x: float, y: float, size: int) -> Camera:
    """A camera of the array.

    Args:
        x: To the right of the array's middle.
        y: Above the array's middle.
        size: Side of the picture in pixels.
    """
    up = np.array([0.0, np.cos(DEMO_PITCH_RADIANS), -np.sin(DEMO_PITCH_RADIANS)])
    forward = -np.array([0.0, np.sin(DEMO_PITCH_RADIANS), np.cos(DEMO_PITCH_RADIANS)])
    right = np.array([1.0, 0.0, 0.0])
    rotation = np.stack([right, -up, forward])
    centre = DEMO_TARGET - DEMO_DISTANCE_UNITS * forward + x * right + y * up
    focal = DEMO_FOCAL_WIDTHS * size
    shift = focal / DEMO_DISTANCE_UNITS
    K = np.array([[focal, 0, size / 2 + shift * x], [0, focal, size / 2 - shift * y], [0, 0, 1]])
    return Camera(K, rotation, -rotation @ centre, size, size)


def array_centre() -> NDArray[np.float64]:
    """(3,) the middle of the array."""
    return array_camera(0.0, 0.0, 1).centre


def array_cameras(rows: int, columns: int, size: int) -> list[Camera]:
    """All cameras, row by row, the top row first.

    The spacing is uneven by a few per cent, as on a real gantry.

    Args:
        size: Side of the pictures in pixels.
    """
    random = np.random.default_rng(DEMO_JITTER_SEED)
    jitter = random.uniform(-0.08, 0.08, (rows, columns, 2)) * (
        2 * DEMO_HALF_ARRAY_UNITS / max(columns - 1, rows - 1, 1)
    )
    xs = np.linspace(-1, 1, columns) if columns > 1 else np.zeros(1)
    ys = np.linspace(1, -1, rows) if rows > 1 else np.zeros(1)
    places = np.stack(np.meshgrid(xs, ys), axis=-1) * (DEMO_HALF_ARRAY_UNITS, 0.94 * DEMO_HALF_ARRAY_UNITS) + jitter
    return [array_camera(x, y, size) for x, y in places.reshape(-1, 2).tolist()]
