"""Which photographs are to be compared: those that show the same things from somewhat aside."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.imaging.sampling import distances_to, farthest_points

BEST_ANGLE = 6.0  # degrees between two views of a point
NARROWER, WIDER = 3.0, 12.0  # widths of the bell on its two sides
FACING = 0.2  # cosine between the axes of two cameras that may see the same side of a thing
WORTH = 0.2  # of the best one's score, below which a view is not worth comparing with
LEAST = 3  # are taken all the same
APART = 0.35  # of the distance from the reference: a view nearer than that to one chosen already counts less


def frustum_points(camera: Camera, w_low: float, w_high: float) -> NDArray[np.float64]:
    """(75, 3) world points all over what a camera sees between two inverse depths."""
    x, y, w = np.meshgrid([0.1, 0.3, 0.5, 0.7, 0.9], [0.1, 0.3, 0.5, 0.7, 0.9], np.linspace(w_low, w_high, 3))
    pixels = np.stack([x.ravel() * camera.width, y.ravel() * camera.height, np.ones(x.size)], axis=1)
    rays = pixels @ np.linalg.inv(camera.K).T
    return (rays / w.ravel()[:, None] - camera.t) @ camera.R


def inside_frame(camera: Camera, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n,) which world points a camera has in its frame."""
    pixels, depth = camera.project(points)
    with np.errstate(invalid="ignore"):
        within = (pixels > 0).all(axis=1) & (pixels[:, 0] < camera.width) & (pixels[:, 1] < camera.height)
    return np.asarray((depth > 0) & within)


def choose_neighbours(reference: int, cameras: Sequence[Camera], points: NDArray[np.float64], count: int) -> list[int]:
    """At most `count` other cameras, the best first: the sum over the points that both see of a bell of the angle
    between their rays; one that stands beside a better one counts less, one at the same place not at all.

    points: (n, 3), what the reference sees.
    """
    own = cameras[reference]
    to_own = own.centre - points
    scores = np.zeros(len(cameras))
    for index, camera in enumerate(cameras):
        if index == reference or camera.R[2] @ own.R[2] < FACING:
            continue
        seen = inside_frame(camera, points)
        rays = camera.centre - points[seen]
        cosine = (rays * to_own[seen]).sum(axis=1) / (
            np.linalg.norm(rays, axis=1) * np.linalg.norm(to_own[seen], axis=1) + 1e-300
        )
        angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
        bell = np.exp(-(((angle - BEST_ANGLE) / np.where(angle < BEST_ANGLE, NARROWER, WIDER)) ** 2) / 2)
        # a narrow array has only small angles: they count by their size, and two at one place for nothing
        scores[index] = (np.minimum(bell, angle / BEST_ANGLE)).sum()
    centres = np.array([camera.centre for camera in cameras])
    distance = np.linalg.norm(centres - own.centre, axis=1)
    chosen: list[int] = []
    worth = scores.copy()
    while len(chosen) < count and worth.max() > 1e-3 * scores.max() > 0:
        best = int(worth.argmax())
        if len(chosen) >= LEAST and scores[best] < WORTH * scores.max():
            break
        chosen.append(best)
        apart = np.linalg.norm(centres - centres[best], axis=1) / np.maximum(APART * distance, 1e-300)
        worth = worth * np.minimum(apart, 1.0)
        worth[best] = 0
    return chosen


def spread_views(cameras: Sequence[Camera], count: int) -> list[int]:
    """At most `count` cameras, the first nearest the middle, each as far as possible from those before (places, and
    directions of view in units of the array's size); in rising order."""
    if len(cameras) <= count:
        return list(range(len(cameras)))
    centres = np.array([camera.centre for camera in cameras])
    size = float(np.linalg.norm(np.ptp(centres, axis=0))) or 1.0
    places = np.hstack([centres / size, np.array([camera.R[2] for camera in cameras])])
    middle = int(np.linalg.norm(places - places.mean(axis=0), axis=1).argmin())
    return sorted(farthest_points(distances_to(places), middle, count).tolist())
