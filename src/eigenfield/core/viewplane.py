"""Geometry of the camera array: the plane through its cameras, coordinates on it, and its grid, if it has one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera

VIEW_PLANE_LINE_RATIO = 0.02  # of the smaller to the larger extent, up to which an array is a line


@dataclass(frozen=True, eq=False)
class ViewPlane:
    """Least-squares plane through the camera centres, with coordinates X, Y.

    Attributes:
        origin: (3,) world point at X = Y = 0, the middle of the array's bounding box in the plane.
        right: (3,) world direction in which X grows, a unit vector, as the cameras see it.
        up: (3,) world direction in which Y grows, perpendicular to `right`.
        extent: (2,) half the width and height of the bounding box, world units; the second is 0 for cameras on a line.
    """

    origin: NDArray[np.float64]
    right: NDArray[np.float64]
    up: NDArray[np.float64]
    extent: NDArray[np.float64]

    __repr__ = brief_repr

    @property
    def is_line(self) -> bool:
        return bool(self.extent[1] == 0)

    def coordinates(self, points: ArrayLike) -> NDArray[np.float64]:
        """(n, 3) world points to (n, 2) X, Y of their projections onto the plane, ±1 at the array's edges."""
        offset = np.asarray(points, dtype=np.float64).reshape(-1, 3) - self.origin
        lengths = np.stack([offset @ self.right, offset @ self.up], axis=1)
        return np.divide(lengths, self.extent, out=np.zeros_like(lengths), where=self.extent > 0)

    def point(self, x: float, y: float) -> NDArray[np.float64]:
        """(3,) the world point at X, Y."""
        return self.origin + x * self.extent[0] * self.right + y * self.extent[1] * self.up


def fit_view_plane(cameras: Sequence[Camera]) -> ViewPlane:
    """The view plane of an array (design: least-squares plane, X right and Y up as the cameras see them).

    `right` is the cameras' mean x axis laid into the plane, so X runs along the rows of an upright grid. Cameras on a
    line make X run along it, to the right, and Y is 0 everywhere.
    """
    centres = np.array([camera.centre for camera in cameras])
    axes = np.mean([camera.R for camera in cameras], axis=0)  # rows: x right, y down, z forward
    middle = centres.mean(axis=0)
    _, spread, directions = np.linalg.svd(centres - middle, full_matrices=True)
    line = len(spread) < 2 or spread[1] <= VIEW_PLANE_LINE_RATIO * spread[0]
    if line:
        right = directions[0] if directions[0] @ axes[0] >= 0 else -directions[0]
        down = axes[1] - (axes[1] @ right) * right
        if np.linalg.norm(down) < 1e-6:  # a line along the cameras' own vertical
            down = np.cross(axes[2], right)
        up = -down / np.linalg.norm(down)
    else:
        normal = directions[2] if directions[2] @ axes[2] >= 0 else -directions[2]
        right = axes[0] - (axes[0] @ normal) * normal
        if np.linalg.norm(right) < 1e-6:  # cameras that look along the plane
            right = directions[0]
        right = right / np.linalg.norm(right)
        up = -np.cross(normal, right)  # z forward, x right: y = z x x is down
    flat = (centres - middle) @ np.stack([right, up], axis=1)
    low, high = flat.min(axis=0), flat.max(axis=0)
    centre2, extent = (low + high) / 2, (high - low) / 2
    if line:
        centre2[1], extent[1] = 0.0, 0.0
    return ViewPlane(middle + centre2[0] * right + centre2[1] * up, right, up, extent)


@dataclass(frozen=True, eq=False)
class Grid:
    """A regular (possibly jittering) grid of cameras.

    Attributes:
        rows: Row 0 is the lowest Y.
        columns: Column 0 is the lowest X.
        index: (rows, columns) int, the camera at each node.
    """

    rows: int
    columns: int
    index: NDArray[np.int64]

    __repr__ = brief_repr


def find_grid(coordinates: ArrayLike) -> Grid | None:
    """The grid on which (n, 2) view-plane coordinates lie, or None: every node occupied once, jitter below a quarter
    of the spacing. A line is a grid of one row."""
    points = np.asarray(coordinates, dtype=np.float64)
    total = len(points)
    for rows in range(1, int(np.sqrt(total)) + 1):
        if total % rows:
            continue
        for r, c in {(rows, total // rows), (total // rows, rows)}:
            grid = _fit_grid(points, r, c)
            if grid is not None:
                return grid
    return None


def _fit_grid(points: NDArray[np.float64], rows: int, columns: int) -> Grid | None:
    by_row = np.argsort(points[:, 1], kind="stable").reshape(rows, columns)
    index = np.take_along_axis(by_row, np.argsort(points[by_row, 0], axis=1, kind="stable"), axis=1)
    placed = points[index]
    x, y = placed[..., 0].mean(axis=0), placed[..., 1].mean(axis=1)
    step = (np.diff(x).min(initial=np.inf), np.diff(y).min(initial=np.inf))
    jitter = (np.abs(placed[..., 0] - x).max(), np.abs(placed[..., 1] - y[:, None]).max())
    if (rows == 1 and np.ptp(points[:, 1]) > 0) or (columns == 1 and np.ptp(points[:, 0]) > 0):
        return None
    if min(step) <= 0 or any(j > s / 4 for j, s in zip(jitter, step, strict=True)):
        return None
    return Grid(rows, columns, index.astype(np.int64))
