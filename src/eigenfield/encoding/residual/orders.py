"""The order of an array's cameras in which one view predicts the next one best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.viewplane import find_grid, fit_view_plane


def video_order(cameras: Sequence[Camera]) -> NDArray[np.int64]:
    """The order of the cameras: a grid's row by row, to and fro; else from each to the nearest that is left.

    On Tarot the grid's rows all in one direction take 3 % more bytes at equal luma, from the middle outwards 9 %.
    """
    centres = np.array([camera.centre for camera in cameras])
    grid = find_grid(fit_view_plane(cameras).coordinates(centres))
    if grid is None:
        return _nearest(centres)
    order = grid.index.astype(np.int64)
    order[1::2] = order[1::2, ::-1].copy()
    return np.ascontiguousarray(order.ravel())


def _nearest(centres: NDArray[np.float64]) -> NDArray[np.int64]:
    """From the camera farthest from the middle, each time to the nearest one left."""
    left = np.ones(len(centres), bool)
    order = [int(np.argmax(np.linalg.norm(centres - centres.mean(axis=0), axis=1)))]
    left[order[0]] = False
    while left.any():
        distance = np.linalg.norm(centres - centres[order[-1]], axis=1)
        order.append(int(np.argmin(np.where(left, distance, np.inf))))
        left[order[-1]] = False
    return np.array(order, np.int64)
