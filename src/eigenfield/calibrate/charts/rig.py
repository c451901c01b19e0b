"""A rig from sightings of a board: how its cameras stand to each other, then everything refined together.

Two cameras that see the board at one moment stand to each other as the board's poses say. Each common moment proposes
such a relation; the one that explains the corners of most other common moments is taken (a board may have moved
between two shutters, a plane seen from afar has two poses, and some checkerboards look the same when turned). The
cameras are joined by a greatest spanning tree over moments that agree, boards take the pose that fits all cameras best,
and bundle adjustment does the rest, dropping sightings that stay out of line.
"""

from __future__ import annotations

import logging
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.charts.bundle import Rig, Sighting, adjust
from eigenfield.calibrate.charts.corners import Corners
from eigenfield.calibrate.charts.intrinsics import board_pose
from eigenfield.calibrate.charts.lens_models import project

log = logging.getLogger("eigenfield.calibrate")

PROPOSALS = 40  # common moments of a pair that propose a relation, and on which it is tried
CAP = 0.02  # of the picture's diagonal: an error beyond is as bad as any
AGREE = 0.5  # of the cap: the mean error up to which a moment agrees with a relation
OUTLIER = 4.0  # times the median error of all sightings
NOISE = 0.75  # pixels of error that are never an outlier
ROUNDS = 8
FEWEST = 3  # sightings that a camera's intrinsics need to be refined

Pose = tuple[NDArray[np.float64], NDArray[np.float64]]  # R, t


@dataclass(frozen=True, eq=False)
class Solution:
    """What was found.

    rig: cameras and boards; rows of cameras that are not joined mean nothing. joined: cameras of the rig, in order.
    kept, dropped: sightings (of joined cameras) that were used, and those that disagree with the rest.
    focal_deviations: (C,) pixels.
    """

    rig: Rig
    joined: tuple[int, ...]
    kept: tuple[Sighting, ...]
    dropped: tuple[Sighting, ...]
    focal_deviations: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Guess:
    """One way to read a sighting: its corners named so, the board at that pose in camera axes."""

    corners: Corners
    R: NDArray[np.float64]
    t: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Eye:
    """A camera while the rig is put together: its intrinsics, and every sighting's guesses by moment."""

    intrinsics: NDArray[np.float64]
    cap: float
    guesses: dict[int, list[_Guess]]


def solve_rig(
    points: NDArray[np.float64],
    symmetries: Sequence[NDArray[np.int64]],
    sightings: Sequence[Sighting],
    intrinsics: NDArray[np.float64],
    bases: Sequence[NDArray[np.float64]],
    sizes: Sequence[tuple[int, int]],
    moments: int,
) -> Solution:
    """Poses of all cameras that the board joins, the first of them at the origin; intrinsics refined.

    points: (n, 3) corners on the board. symmetries: see `Board.symmetries`. intrinsics: (C, 9) to start from.
    bases: (9, m) for each camera, as `adjust` takes them. sizes: (width, height) of each camera's pictures.
    """
    eyes = [
        _Eye(row, CAP * float(np.hypot(*size)), _guesses(points, symmetries, row, sightings, c))
        for c, (row, size) in enumerate(zip(intrinsics, sizes, strict=True))
    ]
    relations = {
        (a, b): relation
        for a in range(len(eyes))
        for b in range(a + 1, len(eyes))
        if (relation := _relation(points, symmetries, eyes[a], eyes[b])) is not None
    }
    poses = _joined(relations, [len(eye.guesses) for eye in eyes])
    rig, placed = _placed(points, symmetries, eyes, poses, moments)
    joined = tuple(sorted(poses))
    return _refined(points, rig, placed, bases, joined)


def _guesses(
    points: NDArray[np.float64],
    symmetries: Sequence[NDArray[np.int64]],
    intrinsics: NDArray[np.float64],
    sightings: Sequence[Sighting],
    camera: int,
) -> dict[int, list[_Guess]]:
    found: dict[int, list[_Guess]] = {}
    for sighting in sightings:
        if sighting.camera == camera:
            readings = [replace(sighting.corners, ids=turn[sighting.corners.ids]) for turn in symmetries]
            guesses = [_Guess(c, R, t) for c in readings for R, t in board_pose(points, c, intrinsics)]
            if guesses:
                found[sighting.moment] = guesses
    return found


def _relation(
    points: NDArray[np.float64], symmetries: Sequence[NDArray[np.int64]], a: _Eye, b: _Eye
) -> tuple[int, float, Pose] | None:
    """How b's axes lie in a's (x_a = R x_b + t), how many common moments agree, and the mean error in pixels, each at
    most the cap; None without a common moment."""
    common = sorted(a.guesses.keys() & b.guesses.keys())
    if not common:
        return None
    tried = [common[i] for i in np.unique(np.linspace(0, len(common) - 1, PROPOSALS).round().astype(int))]
    into_b = _Transfer(points, symmetries, a, b, tried)
    into_a = _Transfer(points, symmetries, b, a, tried)
    best: tuple[float, int, Pose] | None = None
    for moment in tried:
        for in_a in a.guesses[moment]:
            for in_b in b.guesses[moment]:
                R = in_a.R @ in_b.R.T
                t = in_a.t - R @ in_b.t
                errors = np.maximum(into_b.errors(R.T, -R.T @ t), into_a.errors(R, t))
                error = float(errors.mean())
                if best is None or error < best[0]:
                    best = error, int((errors < AGREE).sum()), (R, t)
    assert best is not None
    agree = round(best[1] * len(common) / len(tried))
    return agree, best[0], best[2]


class _Transfer:
    """Boards as one camera sees them, carried over into another and held against what that one saw."""

    def __init__(
        self,
        points: NDArray[np.float64],
        symmetries: Sequence[NDArray[np.int64]],
        source: _Eye,
        target: _Eye,
        moments: Sequence[int],
    ) -> None:
        boards, pixels, case = [], [], []
        owner: list[int] = []
        for row, moment in enumerate(moments):
            seen = target.guesses[moment][0].corners
            for guess in source.guesses[moment]:
                for turn in symmetries:
                    boards.append(points[turn[seen.ids]] @ guess.R.T + guess.t)
                    pixels.append(seen.pixels)
                    case.append(np.full(len(seen.ids), len(owner)))
                    owner.append(row)
        self._boards, self._pixels = np.concatenate(boards), np.concatenate(pixels)
        self._case, self._owner = np.concatenate(case), np.array(owner)
        self._target, self._moments = target, len(moments)

    def errors(self, R: NDArray[np.float64], t: NDArray[np.float64]) -> NDArray[np.float64]:
        """(moments,) mean distance at each moment in units of the cap, at most 1; R, t: source to target axes."""
        away = _distances(self._boards @ R.T + t, self._pixels, self._target)
        count = np.bincount(self._case)
        by_case = np.minimum(np.bincount(self._case, away) / count, 1.0)
        out = np.ones(self._moments)
        np.minimum.at(out, self._owner, by_case)
        return out


def _distances(inside: NDArray[np.float64], pixels: NDArray[np.float64], eye: _Eye) -> NDArray[np.float64]:
    """(n,) in units of the camera's cap, at most 1."""
    away = np.ones(len(inside))
    ahead = inside[:, 2] > 1e-9
    with np.errstate(over="ignore", invalid="ignore"):  # points far to the side, where a lens polynomial means nothing
        error = np.linalg.norm(project(inside[ahead], eye.intrinsics) - pixels[ahead], axis=1) / eye.cap
    away[ahead] = np.where(error < 1, error, 1.0)
    return away


def _joined(relations: dict[tuple[int, int], tuple[int, float, Pose]], sightings: Sequence[int]) -> dict[int, Pose]:
    """World-to-camera poses of the largest set of cameras that is joined by relations, its first camera the world."""
    parent = list(range(len(sightings)))

    def root(camera: int) -> int:
        while parent[camera] != camera:
            camera = parent[camera]
        return camera

    edges: dict[int, list[tuple[int, Pose]]] = defaultdict(list)
    for (a, b), (agree, _, (R, t)) in sorted(relations.items(), key=lambda item: (-item[1][0], item[1][1], item[0])):
        if agree and root(a) != root(b):
            parent[root(a)] = root(b)
            edges[a].append((b, (R.T, -R.T @ t)))  # a's axes to b's
            edges[b].append((a, (R, t)))
    members: dict[int, list[int]] = defaultdict(list)
    for camera in range(len(sightings)):
        members[root(camera)].append(camera)
    largest = max(members.values(), key=lambda m: (len(m), sum(sightings[c] for c in m), -m[0]))
    poses: dict[int, Pose] = {largest[0]: (np.eye(3), np.zeros(3))}
    queue = [largest[0]]
    for camera in queue:
        R, t = poses[camera]
        for other, (step_R, step_t) in edges[camera]:
            if other not in poses:
                poses[other] = (step_R @ R, step_R @ t + step_t)
                queue.append(other)
    return poses


def _placed(
    points: NDArray[np.float64],
    symmetries: Sequence[NDArray[np.int64]],
    eyes: Sequence[_Eye],
    poses: dict[int, Pose],
    moments: int,
) -> tuple[Rig, list[Sighting]]:
    """The board of every moment at the pose that fits all cameras best, and the sightings named accordingly."""
    rig = Rig(
        np.array([eye.intrinsics for eye in eyes]),
        np.array([poses[c][0] if c in poses else np.eye(3) for c in range(len(eyes))]),
        np.array([poses[c][1] if c in poses else np.zeros(3) for c in range(len(eyes))]),
        np.full((moments, 3, 3), np.nan),
        np.full((moments, 3), np.nan),
    )
    sightings: list[Sighting] = []
    for moment in range(moments):
        here = [c for c in sorted(poses) if moment in eyes[c].guesses]
        best: tuple[float, Pose, list[Corners]] | None = None
        for c in here:
            for guess in eyes[c].guesses[moment]:
                R = rig.R[c].T @ guess.R
                t = rig.R[c].T @ (guess.t - rig.t[c])
                read = [
                    _reading(points, symmetries, eyes[o], rig.R[o] @ R, rig.R[o] @ t + rig.t[o], moment) for o in here
                ]
                error = sum(e for e, _ in read)
                if best is None or error < best[0]:
                    best = error, (R, t), [corners for _, corners in read]
        if best is not None:
            rig.board_rotation[moment], rig.board_shift[moment] = best[1]
            sightings += [Sighting(c, moment, corners) for c, corners in zip(here, best[2], strict=True)]
    return rig, sightings


def _reading(
    points: NDArray[np.float64],
    symmetries: Sequence[NDArray[np.int64]],
    eye: _Eye,
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    moment: int,
) -> tuple[float, Corners]:
    """The naming of a sighting's corners that fits a board at R, t in camera axes, and the mean error."""
    seen = eye.guesses[moment][0].corners
    named = [replace(seen, ids=turn[seen.ids]) for turn in symmetries]
    errors = [float(_distances(points[c.ids] @ R.T + t, c.pixels, eye).mean()) for c in named]
    best = int(np.argmin(errors))
    return errors[best], named[best]


def _refined(
    points: NDArray[np.float64],
    rig: Rig,
    sightings: list[Sighting],
    bases: Sequence[NDArray[np.float64]],
    joined: tuple[int, ...],
) -> Solution:
    """Bundle adjustment: poses first, then intrinsics too, without the sightings that stay out of line."""
    held = [basis[:, :0] for basis in bases]
    kept = [s for s in sightings if _is_ahead(points, rig, s)]
    dropped = [s for s in sightings if not _is_ahead(points, rig, s)]
    rig, _ = adjust(points, kept, rig, held, joined[0])
    for number in range(ROUNDS):
        out = _out_of_line(points, rig, kept)
        if number and not out:
            break
        log.info("round %d: %d sightings, %d out of line", number, len(kept), len(out))
        dropped += out
        kept = [s for s in kept if all(s is not other for other in out)]
        counts = [sum(s.camera == c for s in kept) for c in range(len(bases))]
        free = [basis if n >= FEWEST else basis[:, :0] for basis, n in zip(bases, counts, strict=True)]
        rig, deviations = adjust(points, kept, rig, free, joined[0])
    return Solution(rig, joined, tuple(kept), tuple(dropped), deviations)


def _is_ahead(points: NDArray[np.float64], rig: Rig, sighting: Sighting) -> bool:
    return bool((rig.in_camera(points, sighting)[:, 2] > 0).all())


def _out_of_line(points: NDArray[np.float64], rig: Rig, sightings: Sequence[Sighting]) -> list[Sighting]:
    """At each moment the worst sighting, where it is far worse than sightings are: it spoils those of its moment, so
    they are judged again without it."""
    errors = [float(np.sqrt(np.mean(np.sum(rig.residuals(points, s) ** 2, axis=1)))) for s in sightings]
    limit = max(OUTLIER * float(np.median(errors)), NOISE)
    worst: dict[int, tuple[float, Sighting]] = {}
    for error, sighting in zip(errors, sightings, strict=True):
        if error > limit and (sighting.moment not in worst or error > worst[sighting.moment][0]):
            worst[sighting.moment] = error, sighting
    return [sighting for _, sighting in worst.values()]
