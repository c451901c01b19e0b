"""Which photographs are compared, and which of their features are the same point: pairs, matches, verification.

Descriptors have the length 512 in whole numbers, so that their inner products are exact in float32 and a match does
not depend on the order of sums. Every pair has a seed of its own: the result is the same at any number of threads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from eigenfield.calibrate.motion import colmap_core as _quiet  # noqa: F401  its import silences COLMAP
from eigenfield.calibrate.motion.colmap_core import pycolmap
from eigenfield.calibrate.motion.features import Features
from eigenfield.calibrate.motion.matching_kernels import best_two, keep_on_lines
from eigenfield.capture.layout import Layout
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, track
from eigenfield.runtime.parallel import parallel_stream, pieces

Matching = Literal["auto", "exhaustive", "similar", "grid", "positions"]
Pair = tuple[int, int]

EXHAUSTIVE = 24  # photographs up to which `auto` compares all with all
PARTNERS = 14  # photographs that each is compared with otherwise
REACH = 2  # steps of the grid
LONG_STEPS = (4, 8)  # along rows and columns: wider base lines
BLOCK = 1024  # rows of the similarity matrix at a time
GLANCE = 2e12  # multiplications that choosing similar photographs may take
FEWEST_GLANCED, MOST_GLANCED = 128, 1000  # features a photograph looked at for that
LENGTH = 512.0
RATIO, ANGLE = 0.8, 0.7  # of the best to the second best angle between descriptors; radians
GUIDED_RATIO = 0.85
ON_LINE = 3.0  # pixels
ENOUGH = 400  # verified matches above which none is looked for along epipolar lines
EPIPOLAR_ERROR = 4.0  # pixels at 2000 along the longer side
FEWEST_INLIERS = 15


@dataclass(frozen=True, eq=False)
class Match:
    """What two photographs have in common.

    first, second: their numbers, first < second. putative: matches before verification.
    geometry: COLMAP's two-view geometry with the verified matches; None where nothing holds.
    """

    first: int
    second: int
    putative: int
    geometry: Any

    @property
    def inliers(self) -> int:
        return 0 if self.geometry is None else len(self.geometry.inlier_matches)


def choose_pairs(
    features: Sequence[Features],
    matching: Matching,
    layout: Layout | None,
    progress: Progress | None = None,
) -> list[Pair]:
    """Pairs (i, j), i < j, to compare, in order.

    "exhaustive": all. "similar": each with the PARTNERS that share most of their largest features. "grid": neighbours
    of the layout's rows and columns, with some long steps. "positions": the PARTNERS nearest in the layout. "auto":
    all when there are few, the layout's where there is one, similar ones otherwise.
    Raises OptionError as `check_matching`.
    """
    check_matching(matching, layout)
    count = len(features)
    if matching == "auto":
        if count <= EXHAUSTIVE:
            matching = "exhaustive"
        elif layout is None:
            matching = "similar"
        else:
            matching = "positions" if layout.measured else "grid"
    if matching == "exhaustive":
        return [(i, j) for i in range(count) for j in range(i + 1, count)]
    if matching == "similar":
        return _similar(features, progress)
    assert layout is not None
    return _grid_neighbours(layout) if matching == "grid" else _nearest(layout.positions)


def check_matching(matching: str, layout: Layout | None) -> None:
    """Before any work: OptionError `matching` (no way that is known), `matching-layout` (one that needs a layout)."""
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


def _grid_neighbours(layout: Layout) -> list[Pair]:
    node: dict[tuple[int, int], list[int]] = {}
    for index, key in enumerate(zip(layout.rows.tolist(), layout.columns.tolist(), strict=True)):
        node.setdefault(key, []).append(index)
    near = range(-REACH, REACH + 1)
    steps = {(r, c) for r in near for c in near}
    steps |= {(s * sign, 0) for s in LONG_STEPS for sign in (-1, 1)} | {
        (0, s * sign) for s in LONG_STEPS for sign in (-1, 1)
    }
    pairs = {
        (i, j)
        for (row, column), members in node.items()
        for i in members
        for r, c in steps
        for j in node.get((row + r, column + c), [])
        if i < j
    }
    return sorted(pairs)


def _nearest(positions: NDArray[np.float64]) -> list[Pair]:
    pairs: set[Pair] = set()
    for i, place in enumerate(positions):
        order = np.argsort(((positions - place) ** 2).sum(axis=1), kind="stable")
        others = [int(j) for j in order if j != i][:PARTNERS]
        pairs |= {(min(i, j), max(i, j)) for j in others}
    return sorted(pairs)


def _similar(features: Sequence[Features], progress: Progress | None) -> list[Pair]:
    """Each photograph's PARTNERS by matches among a few large features (Wu, *Towards Linear-Time Incremental
    Structure from Motion*, 3DV 2013), and its neighbours by name, which were often taken one after the other."""
    count = len(features)
    every = [(i, j) for i in range(count) for j in range(i + 1, count)]
    glanced = int(np.clip(np.sqrt(GLANCE / (256 * max(len(every), 1))), FEWEST_GLANCED, MOST_GLANCED))
    large = [_as_float(f.descriptors[:glanced]) for f in features]

    def shared(i: int) -> list[int]:
        return [len(mutual_matches(large[i], large[j])) for j in range(i + 1, count)]

    score = np.zeros((count, count), np.int64)
    with threadpool_limits(1, "blas"):
        rows = track(parallel_stream(shared, range(count)), "similar photographs", count, progress)
        for i, row in enumerate(rows):
            score[i, i + 1 :] = row
    score += score.T
    pairs = {(i, i + 1) for i in range(count - 1)}
    for i in range(count):
        best = np.argsort(-score[i], kind="stable")[:PARTNERS]
        pairs |= {(min(i, int(j)), max(i, int(j))) for j in best if score[i, j] > 0}
    return sorted(pairs)


def match_pairs(
    features: Sequence[Features],
    cameras: Sequence[Any],
    pairs: Sequence[Pair],
    seed: int = 0,
    progress: Progress | None = None,
) -> list[Match]:
    """Matches of each pair that hold under one two-view geometry.

    cameras: a pycolmap.Camera for each photograph; where both have a prior focal length, the essential matrix is
    estimated, else the fundamental.
    """
    count = len(features)

    def one(pair: Pair) -> Match:
        i, j = pair
        return _match(features, cameras, i, j, (seed * 7919 + i * count + j) % 2**31)

    with threadpool_limits(1, "blas"):
        return list(track(parallel_stream(one, pairs), "matches", len(pairs), progress))


def _match(features: Sequence[Features], cameras: Sequence[Any], i: int, j: int, seed: int) -> Match:
    a, b = features[i], features[j]
    left, right = _as_float(a.descriptors), _as_float(b.descriptors)
    matches = mutual_matches(left, right)
    geometry = _verify(a, b, cameras[i], cameras[j], matches, seed)
    if geometry is not None and len(geometry.inlier_matches) < ENOUGH and geometry.F is not None:
        guided = mutual_matches(left, right, (a.points, b.points, np.asarray(geometry.F)))
        both = np.unique(np.concatenate([guided, np.asarray(geometry.inlier_matches)]), axis=0)
        again = _verify(a, b, cameras[i], cameras[j], _one_to_one(both), seed)
        if again is not None and len(again.inlier_matches) > len(geometry.inlier_matches):
            geometry = again
    return Match(i, j, len(matches), geometry)


def _as_float(descriptors: NDArray[np.uint8]) -> NDArray[np.float32]:
    return descriptors.astype(np.float32)


def mutual_matches(
    left: NDArray[np.float32],
    right: NDArray[np.float32],
    lines: tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]] | None = None,
) -> NDArray[np.int64]:
    """(m, 2) rows that are each other's best and clearly better than the second best.

    left, right: (n, 128) descriptors of length 512 in whole numbers.
    lines: points of both and the fundamental matrix; only features near each other's epipolar lines are compared.
    """
    if len(left) == 0 or len(right) == 0:
        return np.zeros((0, 2), np.int64)
    row = np.empty(len(left), np.int64)
    top, second = np.empty(len(left), np.float32), np.empty(len(left), np.float32)
    column = np.full(len(right), -1, np.int64)
    column_top = np.full(len(right), -1, np.float32)
    transposed = np.ascontiguousarray(right.T)
    for start, stop in pieces(len(left), BLOCK):
        similarity = left[start:stop] @ transposed
        if lines is not None:
            keep_on_lines(similarity, start, *lines, ON_LINE)
        best_two(similarity, start, row, top, second, column, column_top)
    angle = np.arccos(np.clip(top / LENGTH**2, 0, 1))
    runner = np.arccos(np.clip(second / LENGTH**2, 0, 1))
    ratio = RATIO if lines is None else GUIDED_RATIO
    good = (row >= 0) & (angle <= ANGLE) & (angle <= ratio * runner)
    chosen = np.flatnonzero(good)
    chosen = chosen[column[row[chosen]] == chosen]
    return np.stack([chosen, row[chosen]], axis=1)


def _one_to_one(matches: NDArray[np.int64]) -> NDArray[np.int64]:
    """Of matches that share a feature, the first."""
    _, first = np.unique(matches[:, 0], return_index=True)
    matches = matches[np.sort(first)]
    _, first = np.unique(matches[:, 1], return_index=True)
    return matches[np.sort(first)]


def _verify(a: Features, b: Features, first: Any, second: Any, matches: NDArray[np.int64], seed: int) -> Any:
    """COLMAP's two-view geometry, or None."""
    if len(matches) < FEWEST_INLIERS:
        return None
    options = pycolmap.TwoViewGeometryOptions()
    options.min_num_inliers = FEWEST_INLIERS
    options.ransac.random_seed = seed
    options.ransac.max_error = EPIPOLAR_ERROR * max(first.width, first.height, second.width, second.height, 800) / 2000
    options.compute_relative_pose = False
    geometry = pycolmap.estimate_two_view_geometry(
        first, a.points, second, b.points, matches.astype(np.uint32), options
    )
    return geometry if len(geometry.inlier_matches) >= FEWEST_INLIERS else None
