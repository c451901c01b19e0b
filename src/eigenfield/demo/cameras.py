"""The demo's array: pinholes in one plane, shifted so that the same point of the scene stays in the middle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera

FOCAL = 2.15  # in widths of the picture
DISTANCE = 5.2  # from the array to the point that stays put
PITCH = np.radians(17)  # looking down
TARGET = np.array([0.02, 0.60, 0.0])
HALF_ARRAY = 0.5  # half the array's width; a near and a far point move by about 40 pixels of 512 across it
SEED = 20190916


def array_camera(x: float, y: float, size: int) -> Camera:
    """The camera at x to the right of and y above the middle of the array, for a picture of size x size."""
    up = np.array([0.0, np.cos(PITCH), -np.sin(PITCH)])
    forward = -np.array([0.0, np.sin(PITCH), np.cos(PITCH)])
    right = np.array([1.0, 0.0, 0.0])
    rotation = np.stack([right, -up, forward])
    centre = TARGET - DISTANCE * forward + x * right + y * up
    focal = FOCAL * size
    shift = focal / DISTANCE
    K = np.array([[focal, 0, size / 2 + shift * x], [0, focal, size / 2 - shift * y], [0, 0, 1]])
    return Camera(K, rotation, -rotation @ centre, size, size)


def array_centre() -> NDArray[np.float64]:
    """(3,) the middle of the array."""
    return array_camera(0.0, 0.0, 1).centre


def array_cameras(rows: int, columns: int, size: int) -> list[Camera]:
    """Row by row, the top row first; the spacing is uneven by a few parts in a hundred, as on a real gantry."""
    random = np.random.default_rng(SEED)
    jitter = random.uniform(-0.08, 0.08, (rows, columns, 2)) * (2 * HALF_ARRAY / max(columns - 1, rows - 1, 1))
    xs, ys = np.linspace(-1, 1, columns) if columns > 1 else [0.0], np.linspace(1, -1, rows) if rows > 1 else [0.0]
    return [
        array_camera(
            HALF_ARRAY * float(xs[c]) + float(jitter[r, c, 0]),
            0.94 * HALF_ARRAY * float(ys[r]) + float(jitter[r, c, 1]),
            size,
        )
        for r in range(rows)
        for c in range(columns)
    ]
