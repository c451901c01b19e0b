"""Farthest point sampling, and pictures at half their size."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray


def farthest_points(
    distance_to: Callable[[int], NDArray[np.floating[Any]]], first: int, count: int
) -> NDArray[np.int64]:
    """Farthest point sampling (Gonzalez, "Clustering to minimize the maximum intercluster distance", 1985).

    Args:
        distance_to: From an index to (n,) distances of all points from that one. Points that must not be chosen have a
            negative distance.
        first: Index of the point chosen first.
        count: How many are chosen at most. Points that coincide with chosen ones are not.

    Returns:
        (k,) indices: `first`, then each time the point farthest from all those before it.
    """
    chosen = [first]
    distance = distance_to(first)
    while len(chosen) < count and distance.max() > 0:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, distance_to(chosen[-1]))
    return np.array(chosen, np.int64)


def distances_to(points: NDArray[np.floating[Any]]) -> Callable[[int], NDArray[np.floating[Any]]]:
    """Euclidean distances between points (n, d), as `farthest_points` asks for them."""
    return lambda index: np.linalg.norm(points - points[index], axis=1)


def halve_picture(picture: NDArray[np.float32]) -> NDArray[np.float32]:
    """(h / 2, w / 2, ...) means of four pixels of (h, w, ...), h and w even."""
    above = picture[0::2, 0::2], picture[0::2, 1::2]
    below = picture[1::2, 0::2], picture[1::2, 1::2]
    # Added in the order of numpy's mean over both axes, which takes ten times as long: results go into files
    if picture.shape[1] > 2 and picture.size == picture.shape[0] * picture.shape[1]:
        total = (above[0] + above[1]) + (below[0] + below[1])
    else:
        total = above[0] + above[1] + below[0] + below[1]
    return np.asarray(total * np.float32(0.25), np.float32)
