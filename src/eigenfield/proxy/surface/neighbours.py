"""The choice of photographs to compare: those that show the same points from somewhat different directions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.imaging.sampling import distances_to, farthest_points

NEIGHBOUR_BEST_ANGLE_DEGREES = 6.0  # between two views of a point
NEIGHBOUR_NARROW_SIGMA_DEGREES, NEIGHBOUR_WIDE_SIGMA_DEGREES = 3.0, 12.0  # of the score's bell on its two sides
NEIGHBOUR_MIN_AXIS_COSINE = 0.2  # between the axes of two cameras that may see the same side of an object
NEIGHBOUR_MIN_SCORE_RATIO = 0.2  # relative to the best score: a view with less is not compared
NEIGHBOUR_MIN_COUNT = 3  # views that are taken in any case
NEIGHBOUR_MIN_DISTANCE_RATIO = 0.35  # relative to the reference's distance: a view nearer to a chosen one counts less


def frustum_points(camera: Camera, w_low: float, w_high: float) -> NDArray[np.float64]:
    """(75, 3) world points throughout a camera's frustum between two inverse depths.

    Args:
        w_low: Inverse depth of the far end.
        w_high: Inverse depth of the near end.
    """
    x, y, w = np.meshgrid([0.1, 0.3, 0.5, 0.7, 0.9], [0.1, 0.3, 0.5, 0.7, 0.9], np.linspace(w_low, w_high, 3))
    pixels = np.stack([x.ravel() * camera.width, y.ravel() * camera.height, np.ones(x.size)], axis=1)
    rays = pixels @ np.linalg.inv(camera.K).T
    return (rays / w.ravel()[:, None] - camera.t) @ camera.R


def project_inside(
    camera: Camera, points: NDArray[np.floating[Any]]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Pixels (n, 2) and depths (n,) of world points, and (n,) which of them a camera has in its frame."""
    pixels, depth = camera.project(points)
    with np.errstate(invalid="ignore"):
        within = (pixels > 0).all(axis=1) & (pixels < (camera.width, camera.height)).all(axis=1)
    return pixels, depth, (depth > 0) & within


def inside_frame(camera: Camera, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n,) which world points a camera has in its frame."""
    return project_inside(camera, points)[2]


def choose_neighbours(reference: int, cameras: Sequence[Camera], points: NDArray[np.float64], count: int) -> list[int]:
    """Other cameras to compare with, the best first.

    The score is the sum over the points that both see of a bell-shaped function of the angle between their rays. A
    camera beside a better one counts less, one at the same place not at all.

    Args:
        points: (n, 3) points that the reference sees.
    """
    reference_camera = cameras[reference]
    to_own = reference_camera.centre - points
    scores = np.zeros(len(cameras))
    for index, camera in enumerate(cameras):
        if index == reference or camera.R[2] @ reference_camera.R[2] < NEIGHBOUR_MIN_AXIS_COSINE:
            continue
        seen = inside_frame(camera, points)
        rays = camera.centre - points[seen]
        lengths = np.linalg.norm(rays, axis=1) * np.linalg.norm(to_own[seen], axis=1)
        cosine = (rays * to_own[seen]).sum(axis=1) / (lengths + 1e-300)
        angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
        narrow = angle < NEIGHBOUR_BEST_ANGLE_DEGREES
        sigma = np.where(narrow, NEIGHBOUR_NARROW_SIGMA_DEGREES, NEIGHBOUR_WIDE_SIGMA_DEGREES)
        bell = np.exp(-(((angle - NEIGHBOUR_BEST_ANGLE_DEGREES) / sigma) ** 2) / 2)
        # a narrow array has only small angles: they count by their size, and two cameras at one place not at all
        scores[index] = (np.minimum(bell, angle / NEIGHBOUR_BEST_ANGLE_DEGREES)).sum()
    centres = np.array([camera.centre for camera in cameras])
    distance = np.linalg.norm(centres - reference_camera.centre, axis=1)
    chosen: list[int] = []
    worth = scores.copy()
    while len(chosen) < count and worth.max() > 1e-3 * scores.max() > 0:
        best = int(worth.argmax())
        if len(chosen) >= NEIGHBOUR_MIN_COUNT and scores[best] < NEIGHBOUR_MIN_SCORE_RATIO * scores.max():
            break
        chosen.append(best)
        apart = np.linalg.norm(centres - centres[best], axis=1)
        worth = worth * np.minimum(apart / np.maximum(NEIGHBOUR_MIN_DISTANCE_RATIO * distance, 1e-300), 1.0)
        worth[best] = 0
    return chosen


def spread_views(cameras: Sequence[Camera], count: int) -> list[int]:
    """Cameras spread evenly over places and directions, in increasing order.

    The first is nearest the middle, each other as far as possible from those before. Places are in units of the array's
    size.
    """
    if len(cameras) <= count:
        return list(range(len(cameras)))
    centres = np.array([camera.centre for camera in cameras])
    size = float(np.linalg.norm(np.ptp(centres, axis=0))) or 1.0
    places = np.hstack([centres / size, np.array([camera.R[2] for camera in cameras])])
    middle = int(np.linalg.norm(places - places.mean(axis=0), axis=1).argmin())
    return sorted(farthest_points(distances_to(places), middle, count).tolist())
