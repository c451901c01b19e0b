"""Which photographs are compared, and which of their features match: pairs, matches, geometric verification.

Descriptors are integer vectors of norm 512. Their inner products are exact in float32, so that a match does not depend
on the order of summation. Every pair has its own seed. The result is therefore the same at any number of threads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from eigenfield.calibration.motion.colmap_core import pycolmap
from eigenfield.calibration.motion.features import Features
from eigenfield.calibration.motion.matching_kernels import find_best_two, find_best_two_on_lines
from eigenfield.capture.layout import GridLayout
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, track
from eigenfield.runtime.parallel import parallel_stream, pieces, tracked_map

Matching = Literal["auto", "exhaustive", "similar", "grid", "positions"]
Pair = tuple[int, int]


# Constants of `choose_pairs` and `match_pairs`.
MATCHING_MAX_EXHAUSTIVE = 24  # photographs up to which `auto` compares all with all
MATCHING_PARTNERS = 14  # photographs that each is compared with otherwise
MATCHING_GRID_REACH_STEPS = 2  # neighbourhood in a grid
MATCHING_GRID_LONG_STEPS = (4, 8)  # further steps along rows and columns, for wider baselines
MATCHING_BLOCK_ROWS = 1024  # rows of the similarity matrix that are computed at a time
MATCHING_PREVIEW_MULTIPLICATIONS = 2e12  # multiplications that the choice of similar photographs may take
MATCHING_PREVIEW_MIN_FEATURES = 128  # features a photograph that the choice compares, at least
MATCHING_PREVIEW_MAX_FEATURES = 1000  # features a photograph that the choice compares, at most
MATCHING_DESCRIPTOR_LENGTH = 512.0  # norm of a descriptor
MATCHING_MAX_ANGLE_RATIO = 0.8  # largest ratio of the best to the second-best angle between descriptors
MATCHING_MAX_ANGLE_RADIANS = 0.7  # largest angle between matching descriptors
MATCHING_GUIDED_MAX_ANGLE_RATIO = 0.85  # as `max_angle_ratio`, for matches along epipolar lines
MATCHING_GUIDED_LINE_PIXELS = 3.0  # distance from an epipolar line within which features are compared
MATCHING_GUIDED_MAX_MATCHES = 400  # verified matches above which none is searched along epipolar lines
MATCHING_EPIPOLAR_ERROR_PIXELS = 4.0  # RANSAC threshold, for a longer side of 2000 pixels
MATCHING_MIN_INLIERS = 15  # verified matches of a pair


@dataclass(frozen=True, eq=False)
class Match:
    """The common features of two photographs.

    Attributes:
        second: Index of the second, larger than `first`.
        geometry: COLMAP's two-view geometry with the verified matches; None if there is none.
    """

    first: int
    second: int
    geometry: Any

    @property
    def inliers(self) -> int:
        """Number of verified matches."""
        return 0 if self.geometry is None else len(self.geometry.inlier_matches)


def choose_pairs(
    features: Sequence[Features], matching: Matching, layout: GridLayout | None, progress: Progress | None = None
) -> list[Pair]:
    """Pairs (i, j), i < j, to compare, in order.

    "exhaustive": all pairs. "similar": each photograph with the `partners` that share most of their largest features.
    "grid": neighbours of the layout's rows and columns, with some long steps. "positions": the `partners` nearest in
    the layout. "auto": all pairs if there are few, the layout's if there is one, similar photographs otherwise.

    Raises:
        OptionError: As `check_matching`.
    """
    check_matching(matching, layout)
    count = len(features)
    if matching == "auto":
        if count <= MATCHING_MAX_EXHAUSTIVE:
            matching = "exhaustive"
        elif layout is None:
            matching = "similar"
        else:
            matching = "positions" if layout.measured else "grid"
    if matching == "exhaustive":
        return [(i, j) for i in range(count) for j in range(i + 1, count)]
    if matching == "similar":
        return _similar_pairs(features, progress)
    assert layout is not None
    return _grid_neighbours(layout) if matching == "grid" else _nearest_pairs(layout.positions)


def check_matching(matching: str, layout: GridLayout | None) -> None:
    """Check the way of matching before any work.

    Raises:
        OptionError: `matching`: there is no such way. `matching-layout`: it needs a layout.
    """
    if matching not in get_args(Matching):
        raise OptionError(
            "matching", f"{matching!r} is no way to match", remedy=f"use one of {', '.join(get_args(Matching))}"
        )
    if matching in ("grid", "positions") and layout is None:
        raise OptionError(
            "matching-layout",
            f"matching by {matching} needs a layout, and the names of these photographs hold none",
            remedy="use --matching auto",
        )


def _grid_neighbours(layout: GridLayout) -> list[Pair]:
    node: dict[tuple[int, int], list[int]] = {}
    for index, key in enumerate(zip(layout.rows.tolist(), layout.columns.tolist(), strict=True)):
        node.setdefault(key, []).append(index)
    near = range(-MATCHING_GRID_REACH_STEPS, MATCHING_GRID_REACH_STEPS + 1)
    steps = {(r, c) for r in near for c in near}
    for s in MATCHING_GRID_LONG_STEPS:
        steps |= {(s, 0), (-s, 0), (0, s), (0, -s)}
    pairs = {
        (i, j)
        for (row, column), members in node.items()
        for i in members
        for r, c in steps
        for j in node.get((row + r, column + c), [])
        if i < j
    }
    return sorted(pairs)


def _nearest_pairs(positions: NDArray[np.float64]) -> list[Pair]:
    pairs: set[Pair] = set()
    for i, place in enumerate(positions):
        order = np.argsort(((positions - place) ** 2).sum(axis=1), kind="stable")
        others = [int(j) for j in order if j != i][:MATCHING_PARTNERS]
        pairs |= {(min(i, j), max(i, j)) for j in others}
    return sorted(pairs)


def _similar_pairs(features: Sequence[Features], progress: Progress | None) -> list[Pair]:
    """Each photograph's partners by matches among a few large features, and its neighbours by name.

    Wu, *Towards Linear-Time Incremental Structure from Motion*, 3DV 2013. Neighbours by name were often taken in
    sequence.
    """
    count = len(features)
    pairs_in_all = max(count * (count - 1) // 2, 1)
    wanted = np.sqrt(MATCHING_PREVIEW_MULTIPLICATIONS / (256 * pairs_in_all))
    preview = int(np.clip(wanted, MATCHING_PREVIEW_MIN_FEATURES, MATCHING_PREVIEW_MAX_FEATURES))
    large = [f.descriptors[:preview] for f in features]

    def count_shared(i: int) -> list[int]:
        return [len(mutual_matches(large[i], large[j])) for j in range(i + 1, count)]

    score = np.zeros((count, count), np.int64)
    with threadpool_limits(1, "blas"):
        rows = track(parallel_stream(count_shared, range(count)), "similar photographs", count, progress)
        for i, row in enumerate(rows):
            score[i, i + 1 :] = row
    score += score.T
    pairs = {(i, i + 1) for i in range(count - 1)}
    for i in range(count):
        best = np.argsort(-score[i], kind="stable")[:MATCHING_PARTNERS]
        pairs |= {(min(i, int(j)), max(i, int(j))) for j in best if score[i, j] > 0}
    return sorted(pairs)


def match_pairs(
    features: Sequence[Features],
    cameras: Sequence[Any],
    pairs: Sequence[Pair],
    seed: int = 0,
    progress: Progress | None = None,
) -> list[Match]:
    """Matches of each pair, verified by one two-view geometry.

    If both cameras have a prior focal length the essential matrix is estimated, else the fundamental matrix.

    Args:
        cameras: A pycolmap.Camera for each photograph.
        pairs: Pairs (i, j), i < j.
    """
    count = len(features)

    def match(pair: Pair) -> Match:
        i, j = pair
        return _match_pair(features, cameras, i, j, (seed * 7919 + i * count + j) % 2**31)

    with threadpool_limits(1, "blas"):
        return tracked_map(match, pairs, "matches", progress)


def _match_pair(features: Sequence[Features], cameras: Sequence[Any], i: int, j: int, seed: int) -> Match:
    a, b = features[i], features[j]
    matches = mutual_matches(a.descriptors, b.descriptors)
    geometry = _verify(a, b, cameras[i], cameras[j], matches, seed)
    few = geometry is not None and len(geometry.inlier_matches) < MATCHING_GUIDED_MAX_MATCHES
    if few and geometry.F is not None:
        guided = mutual_matches(a.descriptors, b.descriptors, (a.points, b.points, np.asarray(geometry.F)))
        both = np.unique(np.concatenate([guided, np.asarray(geometry.inlier_matches)]), axis=0)
        again = _verify(a, b, cameras[i], cameras[j], _one_to_one(both), seed)
        if again is not None and len(again.inlier_matches) > len(geometry.inlier_matches):
            geometry = again
    return Match(i, j, geometry)


def mutual_matches(
    left: NDArray[np.uint8],
    right: NDArray[np.uint8],
    epipolar: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]] | None = None,
) -> NDArray[np.int64]:
    """Rows of two descriptor arrays that are each other's best match and clearly better than the second best.

    Args:
        left: (n, 128) descriptors of norm 512.
        right: (m, 128) likewise.
        epipolar: Points of both and the fundamental matrix. Only features near each other's epipolar lines are
            compared.

    Returns:
        (k, 2) rows of `left` and `right`.
    """
    if len(left) == 0 or len(right) == 0:
        return np.zeros((0, 2), np.int64)
    row = np.empty(len(left), np.int64)
    top, second = np.empty(len(left), np.float32), np.empty(len(left), np.float32)
    column = np.full(len(right), -1, np.int64)
    column_top = np.full(len(right), -1, np.float32)
    if epipolar is None:
        transposed = np.ascontiguousarray(right.T, np.float32)
        for start, stop in pieces(len(left), MATCHING_BLOCK_ROWS):
            similarity = left[start:stop].astype(np.float32) @ transposed
            find_best_two(similarity, start, row, top, second, column, column_top)
    else:
        tolerance = MATCHING_GUIDED_LINE_PIXELS
        find_best_two_on_lines(left, right, *epipolar, tolerance, row, top, second, column, column_top)
    angle = np.arccos(np.clip(top / MATCHING_DESCRIPTOR_LENGTH**2, 0, 1))
    runner = np.arccos(np.clip(second / MATCHING_DESCRIPTOR_LENGTH**2, 0, 1))
    ratio = MATCHING_MAX_ANGLE_RATIO if epipolar is None else MATCHING_GUIDED_MAX_ANGLE_RATIO
    good = (row >= 0) & (angle <= MATCHING_MAX_ANGLE_RADIANS) & (angle <= ratio * runner)
    chosen = np.flatnonzero(good)
    chosen = chosen[column[row[chosen]] == chosen]
    return np.stack([chosen, row[chosen]], axis=1)


def _one_to_one(matches: NDArray[np.int64]) -> NDArray[np.int64]:
    """The first of the matches that share a feature."""
    _, first = np.unique(matches[:, 0], return_index=True)
    matches = matches[np.sort(first)]
    _, first = np.unique(matches[:, 1], return_index=True)
    return matches[np.sort(first)]


def _verify(a: Features, b: Features, first: Any, second: Any, matches: NDArray[np.int64], seed: int) -> Any:
    """COLMAP's two-view geometry, or None."""
    if len(matches) < MATCHING_MIN_INLIERS:
        return None
    options = pycolmap.TwoViewGeometryOptions()
    options.min_num_inliers = MATCHING_MIN_INLIERS
    options.ransac.random_seed = seed
    longer = max(first.width, first.height, second.width, second.height, 800)
    options.ransac.max_error = MATCHING_EPIPOLAR_ERROR_PIXELS * longer / 2000
    options.compute_relative_pose = False
    geometry = pycolmap.estimate_two_view_geometry(
        first, a.points, second, b.points, matches.astype(np.uint32), options
    )
    return geometry if len(geometry.inlier_matches) >= MATCHING_MIN_INLIERS else None
