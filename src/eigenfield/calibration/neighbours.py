"""How far neighbouring photographs are apart: parallax, overlap and brightness, from points that both show.

It is a look beforehand, in seconds: a few pairs, at a small size.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree
from threadpoolctl import threadpool_limits

from eigenfield.calibration.planar.tracks import find_features, mutual_matches
from eigenfield.capture import Capture
from eigenfield.core.progress import Progress
from eigenfield.core.spread import spread_indices
from eigenfield.imaging.colour import LUMA_BT709
from eigenfield.imaging.metrics import to_codes
from eigenfield.runtime.parallel import parallel_map, tracked_map

NEIGHBOUR_MAX_PARALLAX_RATIO = 0.03  # of the longer side, up to which views between were drawn well: docs/captures.md
NEIGHBOUR_PLACE_RATIO = 0.01  # of the array's extent, within which photographs are of one place
NEIGHBOUR_PLACE_STEPS = 0.25  # likewise, of the step if all stood along a line, which is less where they are many


# Constants of `measure_neighbours`.
NEIGHBOUR_MAX_PAIRS = 6  # pairs that are looked at, evenly spread
NEIGHBOUR_MAX_SIDE_PIXELS = 640  # longer side of the photographs there
NEIGHBOUR_MIN_MATCHES = 30  # points that both photographs must show
NEIGHBOUR_EPIPOLAR_PIXELS = 1.5  # from its epipolar line, at that size, up to which a match counts
NEIGHBOUR_OUTER_PERCENTILE = 5.0  # of the points' shifts, left out at either end
NEIGHBOUR_OVERLAP_SAMPLES = 24  # along each side of the frame
NEIGHBOUR_GAMMA = 2.2  # of the photographs' values, for brightness


@dataclass(frozen=True)
class NeighbourPair:
    """Two neighbouring photographs.

    Attributes:
        parallax: Pixels of the first by which near and far things that both show shift against each other, beside the
            similarity that fits all shifts best.
        overlap: Part of the first that the second shows, too.
        stops: By which the second is the brighter.
    """

    first: int
    second: int
    parallax: float
    overlap: float
    stops: float


@dataclass(frozen=True, eq=False)
class _Look:
    """Features of a photograph: (n, 2) pixels, (n, 128) descriptors, and (n,) luma around each."""

    points: NDArray[np.float64]
    descriptors: NDArray[np.float32]
    luma: NDArray[np.float32]


def measure_neighbours(capture: Capture, sound: Sequence[int], progress: Progress | None = None) -> list[NeighbourPair]:
    """Pairs of neighbours, those left out of which too little is seen in both.

    Neighbours are the nearest cameras or places of a grid; without either, those that follow by name.

    Args:
        sound: Indices of those that can be decoded.
    """
    chosen = spread_pairs(neighbours_of(capture, sound))
    wanted = sorted({index for pair in chosen for index in pair})
    looks = dict(
        zip(wanted, tracked_map(lambda index: _look(capture, index), wanted, "neighbours", progress), strict=True)
    )

    def measure(pair: tuple[int, int]) -> NeighbourPair | None:
        a, b = pair
        return _measure(pair, looks[a], looks[b], capture.sizes[a], capture.sizes[b])

    with threadpool_limits(1, "blas"):  # the threads are those of parallel_map
        return [found for found in parallel_map(measure, chosen) if found is not None]


def neighbours_of(capture: Capture, sound: Sequence[int]) -> list[tuple[int, int]]:
    """Each photograph with its nearest, by cameras or the places of a grid; without either with the next by name.

    Of photographs from one place, the first alone takes part.

    Args:
        sound: Indices of those that take part.
    """
    if len(sound) < 2:
        return []
    if capture.light_field is not None:
        places = np.array([capture.light_field.cameras[index].centre for index in sound])
    elif capture.layout is not None:
        places = np.asarray(capture.layout.positions, np.float64)[list(sound)]
    else:
        return list(pairwise(sound))
    return [(sound[i], sound[j]) for i, j in nearest_pairs(places)]


def first_of_place(places: NDArray[np.float64]) -> NDArray[np.int64]:
    """(n,) of each photograph the first from its place, which is itself where no other is: two shots are one place.

    Args:
        places: (n, 2) or (n, 3).
    """
    extent = float(np.linalg.norm(np.ptp(places, axis=0)))
    first = np.arange(len(places))
    if extent > 0:
        reach = extent * min(NEIGHBOUR_PLACE_RATIO, NEIGHBOUR_PLACE_STEPS / (len(places) - 1))
        around: Any = KDTree(places).query_ball_point(places, reach)
        for index, near in enumerate(around):
            first[index] = min(other for other in near if first[other] == other)
    return first


def nearest_pairs(places: NDArray[np.float64]) -> list[tuple[int, int]]:
    """Each place with its nearest, every pair once, by the first photograph of each.

    Args:
        places: (n, 2) or (n, 3), two or more.
    """
    kept = np.unique(first_of_place(places))
    nearest = np.asarray(KDTree(places[kept]).query(places[kept], k=2)[1])
    # where all are in one place, either may come first
    other = np.where(nearest[:, 0] == np.arange(len(kept)), nearest[:, 1], nearest[:, 0])
    return sorted({(min(i, j), max(i, j)) for i, j in zip(kept.tolist(), kept[other].tolist(), strict=True)})


def spread_pairs(pairs: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """`NEIGHBOUR_MAX_PAIRS` of them at most, evenly spread.

    Args:
        pairs: In order.
    """
    return [pairs[place] for place in spread_indices(len(pairs), NEIGHBOUR_MAX_PAIRS)]


def _look(capture: Capture, index: int) -> _Look:
    codes = to_codes(capture.photograph(index).pixels)
    scale = min(1.0, NEIGHBOUR_MAX_SIDE_PIXELS / max(codes.shape[:2]))
    points, descriptors = find_features(codes, scale)
    luma = cv2.boxFilter(cv2.transform(codes, np.array([LUMA_BT709])), -1, (9, 9)).astype(np.float32)
    column, row = np.minimum(points, np.array(luma.shape[::-1]) - 1).astype(int).T
    return _Look(points, descriptors, luma[row, column])


def _measure(
    pair: tuple[int, int], a: _Look, b: _Look, size: tuple[int, int], other: tuple[int, int]
) -> NeighbourPair | None:
    """As `measure_neighbours`, of one pair with (width, height) each."""
    if min(len(a.points), len(b.points)) < NEIGHBOUR_MIN_MATCHES:
        return None
    here, there = mutual_matches(a.descriptors, b.descriptors)
    if len(here) < NEIGHBOUR_MIN_MATCHES:
        return None
    reach = NEIGHBOUR_EPIPOLAR_PIXELS * max(1.0, max(size) / NEIGHBOUR_MAX_SIDE_PIXELS)
    kept = epipolar_matches(a.points[here], b.points[there], reach)
    here, there = here[kept], there[kept]
    if len(here) < NEIGHBOUR_MIN_MATCHES:
        return None
    source, target = a.points[here], b.points[there]
    similarity = fit_similarity(source, target)
    if similarity is None:
        return None
    ratio = (np.maximum(b.luma[there], 1) / np.maximum(a.luma[here], 1)) ** NEIGHBOUR_GAMMA
    return NeighbourPair(
        *pair,
        parallax_beside(similarity, source, target),
        _overlap(similarity, size, other),
        float(np.median(np.log2(ratio))),
    )


def epipolar_matches(source: NDArray[np.floating], target: NDArray[np.floating], reach: float) -> NDArray[np.bool_]:
    """(n,) which pairs of points agree with one fundamental matrix.

    Args:
        source: (n, 2) pixels.
        target: (n, 2) pixels.
        reach: Pixels by which a point may be off its epipolar line.
    """
    try:
        good = cv2.findFundamentalMat(source, target, cv2.USAC_MAGSAC, reach, 0.999)[1]
    except cv2.error:  # OpenCV 5 fails an assertion of its own on a sample that gives no matrix
        good = cv2.findFundamentalMat(source, target, cv2.FM_RANSAC, reach, 0.999)[1]
    return np.zeros(len(source), np.bool_) if good is None else np.asarray(good).reshape(-1) > 0


def _moved(points: NDArray[np.float64], similarity: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(points @ similarity[:, :2].T + similarity[:, 2], np.float64)


def fit_similarity(source: NDArray[np.float64], target: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """(2, 3) the similarity that moves most points best; None where there is none.

    Args:
        source: (n, 2) pixels.
        target: (n, 2) pixels in the other photograph.
    """
    fitted = cv2.estimateAffinePartial2D(source, target, method=cv2.LMEDS)[0]
    return None if fitted is None else np.asarray(fitted, np.float64)


def parallax_beside(similarity: NDArray[np.float64], source: NDArray[np.float64], target: NDArray[np.float64]) -> float:
    """Pixels by which points shift against each other beside a similarity, along the direction of the greatest shifts.

    Args:
        similarity: Of `fit_similarity`.
        source: (n, 2) pixels.
        target: (n, 2) pixels in the other photograph.
    """
    shifts = target - _moved(source, similarity)
    away = shifts - np.median(shifts, axis=0)
    axis = np.linalg.svd(away, full_matrices=False)[2][0]
    outer = NEIGHBOUR_OUTER_PERCENTILE
    low, high = np.percentile(away @ axis, [outer, 100 - outer])
    return float(high - low)


def _overlap(similarity: NDArray[np.float64], size: tuple[int, int], other: tuple[int, int]) -> float:
    steps = (np.arange(NEIGHBOUR_OVERLAP_SAMPLES) + 0.5) / NEIGHBOUR_OVERLAP_SAMPLES
    grid = np.stack(np.meshgrid(steps * size[0], steps * size[1]), axis=-1).reshape(-1, 2)
    seen = _moved(grid, similarity)
    return float(((seen > 0) & (seen < other)).all(axis=1).mean())
