"""Points of the central photograph, matched in the photographs around it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from eigenfield.runtime.parallel import parallel_map

TRACK_MAX_FEATURES = 2500  # SIFT features in a photograph
TRACK_MAX_SEARCH_PIXELS = 1024  # longer side at which features are detected
TRACK_MAX_DISTANCE_RATIO = 0.85  # of the best to the second-best descriptor distance


@dataclass(frozen=True, eq=False)
class Tracks:
    """Positions of one photograph's points in others.

    Attributes:
        points: (k, 2) pixels in the central photograph.
        found: (v, k, 2) pixels in the others; NaN where a point was not found.
    """

    points: NDArray[np.float64]
    found: NDArray[np.float64]


def find_tracks(pictures: Sequence[NDArray[np.uint8]], centre: int) -> Tracks:
    """SIFT features of the central picture, each with its mutual best match in every picture.

    Pixel centres are at +0.5.

    Args:
        pictures: v of (H, W, 3).
        centre: Index of the central picture, whose row of `found` holds the points themselves.
    """
    height, width = pictures[centre].shape[:2]
    scale = min(1.0, TRACK_MAX_SEARCH_PIXELS / max(height, width))
    features = parallel_map(lambda picture: find_features(picture, scale), pictures)
    points, descriptors = features[centre]
    found = np.full((len(pictures), len(points), 2), np.nan)
    if len(points) >= 2:

        def match(index: int) -> None:
            others, theirs = features[index]
            if len(others) >= 2:
                here, there = mutual_matches(descriptors, theirs)
                found[index, here] = others[there]

        with threadpool_limits(1, "blas"):  # the threads are those of parallel_map
            parallel_map(match, range(len(pictures)))
        found[centre] = points
    return Tracks(points, found)


def find_features(picture: NDArray[np.uint8], scale: float) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """(n, 2) pixels of a picture's SIFT features, centres at +0.5, and (n, 128) descriptors.

    Args:
        picture: (H, W, 3) R, G, B.
        scale: Of the size at which features are searched.
    """
    grey = cv2.cvtColor(np.ascontiguousarray(picture), cv2.COLOR_RGB2GRAY)
    if scale < 1:
        grey = cv2.resize(grey, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)
    sift = cv2.SIFT.create(nfeatures=TRACK_MAX_FEATURES, contrastThreshold=0.015, enable_precise_upscale=True)
    keys, descriptors = sift.detectAndCompute(grey, None)
    if descriptors is None or not keys:
        return np.zeros((0, 2)), np.zeros((0, 128), np.float32)
    positions = np.array([key.pt for key in keys], np.float64)
    order = np.lexsort((positions[:, 0], positions[:, 1]))
    root = np.sqrt(descriptors / np.maximum(descriptors.sum(axis=1, keepdims=True), 1e-6))  # RootSIFT
    return (positions[order] + 0.5) / scale, root[order].astype(np.float32)


def mutual_matches(a: NDArray[np.float32], b: NDArray[np.float32]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Indices of mutual best matches that are clearly better than the second best.

    Args:
        a: (n, 128) descriptors.
        b: (m, 128) of the other photograph, at least two.
    """
    here = np.arange(len(a))
    likeness = a @ b.T  # of descriptors of norm 1, whose distance is sqrt(2 - 2 likeness)
    there = likeness.argmax(axis=1)
    back = likeness.argmax(axis=0)
    best = likeness[here, there]
    likeness[here, there] = -1
    first, second = (np.sqrt(np.maximum(2 - 2 * each, 0)) for each in (best, likeness.max(axis=1)))
    good = (back[there] == here) & (first < TRACK_MAX_DISTANCE_RATIO * second)
    return here[good], there[good]
