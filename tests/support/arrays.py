"""A grid of cameras, its weights and triangles: tables of numbers as the coders of arrays get them."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from eigenfield.core.camera import Camera

ROWS, COLUMNS = 7, 9
GRID = np.arange(ROWS * COLUMNS).reshape(ROWS, COLUMNS)


def smooth_weights(components=5, noise=0.0):
    """(63, N) float32 of unit variance over GRID: waves, and white noise on top."""
    y, x = np.mgrid[:ROWS, :COLUMNS] / 8.0
    random = np.random.default_rng(3)
    tables = [np.cos(3 * (k + 1) * x / 2 + k) * np.sin(2 * y + k) for k in range(components)]
    weights = np.stack([table.reshape(-1) for table in tables], axis=1) + noise * random.normal(
        size=(GRID.size, components)
    )
    return ((weights - weights.mean(axis=0)) / weights.std(axis=0)).astype(np.float32)


def array_cameras(rows=ROWS, columns=COLUMNS, jitter=0.01):
    """Cameras on a grid that look one way, each a little off it."""
    random = np.random.default_rng(4)
    cameras = []
    for row in range(rows):
        for column in range(columns):
            R = Rotation.from_rotvec(jitter * random.normal(size=3) + [0.3, 2.0, -0.4]).as_matrix()
            centre = np.array([0.1 * column, 0.12 * row, 0.0]) + jitter * 0.1 * random.normal(size=3)
            K = np.array([[500 + random.normal(), 0, 320 - 4.0 * column], [0, 501, 240 - 5.0 * row], [0, 0, 1]])
            cameras.append(Camera(K, R, -R @ centre, 640, 480))
    return cameras


def array_triangles():
    """(T, 3) of the cells of GRID, cut either way."""
    corners = np.stack([GRID[:-1, :-1], GRID[:-1, 1:], GRID[1:, :-1], GRID[1:, 1:]], axis=-1).reshape(-1, 4)
    cut = np.random.default_rng(6).integers(0, 2, len(corners)).astype(bool)
    one = np.where(cut[:, None], corners[:, [3, 0, 1]], corners[:, [1, 2, 0]])
    other = np.where(cut[:, None], corners[:, [2, 0, 3]], corners[:, [2, 1, 3]])
    return np.concatenate([other, one]).astype(np.int32)
