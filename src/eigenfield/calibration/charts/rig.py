"""A rig from observations of a board: relative poses of its cameras, then joint refinement.

The relative pose of two cameras follows from the board's poses at a moment at which both see it. Each common moment
proposes one, and the one that explains the corners of most other common moments is taken. The proposals may be wrong: a
board may move between two shutters, a distant plane has two poses, and some checkerboards have rotational symmetries.
A maximum spanning tree over the number of agreeing moments connects the cameras. Boards take the pose that fits all
cameras best. Bundle adjustment follows, which drops outliers.
"""

from __future__ import annotations

import itertools
import logging
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.charts.bundle import BoardObservation, RigEstimate, adjust_bundle
from eigenfield.calibration.charts.corners import DetectedCorners
from eigenfield.calibration.charts.intrinsics import board_pose
from eigenfield.calibration.charts.lens_models import project_points
from eigenfield.core.brief import brief_repr
from eigenfield.core.spread import spread_indices

log = logging.getLogger("eigenfield.calibration")

RIG_MAX_PROPOSALS = 40  # common moments of a pair that propose a relative pose, and on which it is tested
RIG_ERROR_CAP_DIAGONALS = 0.02  # larger errors count as this
RIG_AGREEMENT_CAPS = 0.5  # mean error up to which a moment agrees with a relative pose
RIG_OUTLIER_MEDIANS = 4.0  # times the median error of all observations
RIG_NOISE_PIXELS = 0.75  # a smaller error is never an outlier
RIG_MAX_ROUNDS = 8
RIG_MIN_REFINED_BOARDS = 3  # observations that a camera needs for its intrinsics to be refined

F64 = NDArray[np.float64]
RigPose = tuple[F64, F64]  # R, t


@dataclass(frozen=True, eq=False)
class RigSolution:
    """A solved rig.

    Attributes:
        rig: Cameras and boards. Rows of cameras that are not joined are meaningless.
        joined: Cameras of the rig, in order.
        inliers: Observations of joined cameras that were used.
        outliers: Those that disagree with the rest.
        focal_deviations: (C,) standard deviation of fx, pixels.
    """

    rig: RigEstimate
    joined: tuple[int, ...]
    inliers: tuple[BoardObservation, ...]
    outliers: tuple[BoardObservation, ...]
    focal_deviations: F64

    __repr__ = brief_repr


@dataclass(frozen=True, eq=False)
class _Reading:
    """One of the labellings of an observation's corners that the board's symmetries allow, and their places on it."""

    corners: DetectedCorners
    plane: F64


@dataclass(frozen=True, eq=False)
class _ObservingCamera:
    """A camera while the rig is assembled.

    Attributes:
        intrinsics: (9,), see `lens_models`.
        cap: Largest error that counts, pixels.
        readings: Of every observation, by moment.
        poses: The board in camera axes, one for each reading or two, by moment.
    """

    intrinsics: F64
    cap: float
    readings: dict[int, list[_Reading]]
    poses: dict[int, list[RigPose]]


def solve_rig(
    points: F64,
    symmetries: Sequence[NDArray[np.int64]],
    observations: Sequence[BoardObservation],
    intrinsics: F64,
    bases: Sequence[F64],
    sizes: Sequence[tuple[int, int]],
    moments: int,
) -> RigSolution:
    """Poses of all cameras that the board connects, the first of them at the origin, with refined intrinsics.

    Args:
        points: (n, 3) corners on the board.
        intrinsics: (C, 9) to start from.
        bases: (9, m) for each camera, as in `adjust_bundle`.
        sizes: (width, height) of each camera's pictures.
    """
    cameras = [
        _observing_camera(points, symmetries, row, size, [s for s in observations if s.camera == c])
        for c, (row, size) in enumerate(zip(intrinsics, sizes, strict=True))
    ]
    relative_poses = {
        (a, b): relative_pose
        for a, b in itertools.combinations(range(len(cameras)), 2)
        if (relative_pose := _relative_pose(cameras[a], cameras[b])) is not None
    }
    poses = _spanning_tree_poses(relative_poses, [len(camera.poses) for camera in cameras])
    rig, placed = _place_boards(cameras, poses, moments)
    return _refine(points, rig, placed, bases, tuple(sorted(poses)))


def _observing_camera(
    points: F64,
    symmetries: Sequence[NDArray[np.int64]],
    intrinsics: F64,
    size: tuple[int, int],
    observations: Sequence[BoardObservation],
) -> _ObservingCamera:
    camera = _ObservingCamera(intrinsics, RIG_ERROR_CAP_DIAGONALS * float(np.hypot(*size)), {}, {})
    for seen in observations:
        named = [replace(seen.corners, ids=permutation[seen.corners.ids]) for permutation in symmetries]
        poses = [pose for corners in named for pose in board_pose(points, corners, intrinsics)]
        if poses:
            camera.readings[seen.moment] = [_Reading(corners, points[corners.ids]) for corners in named]
            camera.poses[seen.moment] = poses
    return camera


def _relative_pose(a: _ObservingCamera, b: _ObservingCamera) -> tuple[int, float, RigPose] | None:
    """The pose of b in a's axes (x_a = R x_b + t), the number of agreeing moments, and the mean capped error.

    None without a common moment.
    """
    common = sorted(a.poses.keys() & b.poses.keys())
    if not common:
        return None
    tried = [common[i] for i in spread_indices(len(common), RIG_MAX_PROPOSALS)]
    into_b, into_a = _Transfer(a, b, tried), _Transfer(b, a, tried)
    best: tuple[float, int, RigPose] | None = None
    for moment in tried:
        for (R_a, t_a), (R_b, t_b) in itertools.product(a.poses[moment], b.poses[moment]):
            R = R_a @ R_b.T
            t = t_a - R @ t_b
            errors = np.maximum(into_b.errors(R.T, -R.T @ t), into_a.errors(R, t))
            error = float(errors.mean())
            if best is None or error < best[0]:
                best = error, int((errors < RIG_AGREEMENT_CAPS).sum()), (R, t)
    assert best is not None
    agree = round(best[1] * len(common) / len(tried))
    return agree, best[0], best[2]


class _Transfer:
    """Boards as one camera sees them, transferred into another camera and compared with what that one saw."""

    def __init__(self, source: _ObservingCamera, target: _ObservingCamera, moments: Sequence[int]) -> None:
        boards, pixels, case = [], [], []
        owner: list[int] = []
        for row, moment in enumerate(moments):
            for (R, t), reading in itertools.product(source.poses[moment], target.readings[moment]):
                boards.append(reading.plane @ R.T + t)
                pixels.append(reading.corners.pixels)
                case.append(np.full(len(reading.plane), len(owner)))
                owner.append(row)
        self._boards, self._pixels = np.concatenate(boards), np.concatenate(pixels)
        self._case, self._owner = np.concatenate(case), np.array(owner)
        self._target, self._moments = target, len(moments)

    def errors(self, R: F64, t: F64) -> F64:
        """(moments,) mean distance at each moment in units of the cap, at most 1.

        Args:
            R: (3, 3) source to target axes.
            t: (3,) source to target axes.
        """
        away = _capped_distances(self._boards @ R.T + t, self._pixels, self._target)
        count = np.bincount(self._case)
        by_case = np.minimum(np.bincount(self._case, away) / count, 1.0)
        out = np.ones(self._moments)
        np.minimum.at(out, self._owner, by_case)
        return out


def _capped_distances(inside: F64, pixels: F64, camera: _ObservingCamera) -> F64:
    """(n,) in units of the camera's cap, at most 1."""
    away = np.ones(len(inside))
    ahead = inside[:, 2] > 1e-9
    with np.errstate(over="ignore", invalid="ignore"):  # points far to the side, where a lens polynomial diverges
        error = np.linalg.norm(project_points(inside[ahead], camera.intrinsics) - pixels[ahead], axis=1) / camera.cap
    away[ahead] = np.where(error < 1, error, 1.0)
    return away


def _spanning_tree_poses(
    relative_poses: dict[tuple[int, int], tuple[int, float, RigPose]], observations: Sequence[int]
) -> dict[int, RigPose]:
    """World-to-camera poses of the largest connected set of cameras, its first camera the world."""
    parent = list(range(len(observations)))

    def root(camera: int) -> int:
        while parent[camera] != camera:
            camera = parent[camera]
        return camera

    edges: dict[int, list[tuple[int, RigPose]]] = defaultdict(list)
    for (a, b), (agree, _, (R, t)) in sorted(
        relative_poses.items(), key=lambda item: (-item[1][0], item[1][1], item[0])
    ):
        if agree and root(a) != root(b):
            parent[root(a)] = root(b)
            edges[a].append((b, (R.T, -R.T @ t)))  # a's axes to b's
            edges[b].append((a, (R, t)))
    members: dict[int, list[int]] = defaultdict(list)
    for camera in range(len(observations)):
        members[root(camera)].append(camera)
    largest = max(members.values(), key=lambda m: (len(m), sum(observations[c] for c in m), -m[0]))
    poses: dict[int, RigPose] = {largest[0]: (np.eye(3), np.zeros(3))}
    queue = [largest[0]]
    for camera in queue:
        R, t = poses[camera]
        for other, (step_R, step_t) in edges[camera]:
            if other not in poses:
                poses[other] = (step_R @ R, step_R @ t + step_t)
                queue.append(other)
    return poses


def _place_boards(
    cameras: Sequence[_ObservingCamera], poses: dict[int, RigPose], moments: int
) -> tuple[RigEstimate, list[BoardObservation]]:
    """The board of every moment at the pose that fits all cameras best, and the observations labelled accordingly."""
    intrinsics = np.array([camera.intrinsics for camera in cameras])
    R, t = map(np.array, zip(*(poses.get(c, (np.eye(3), np.zeros(3))) for c in range(len(cameras))), strict=True))
    rig = RigEstimate(intrinsics, R, t, np.full((moments, 3, 3), np.nan), np.full((moments, 3), np.nan))
    observations: list[BoardObservation] = []
    for moment in range(moments):
        here = [c for c in sorted(poses) if moment in cameras[c].poses]
        best: tuple[float, RigPose, list[DetectedCorners]] | None = None
        for c in here:
            for R_c, t_c in cameras[c].poses[moment]:
                R = rig.R[c].T @ R_c
                t = rig.R[c].T @ (t_c - rig.t[c])
                read = [_best_labelling(cameras[o], rig.R[o] @ R, rig.R[o] @ t + rig.t[o], moment) for o in here]
                error = sum(e for e, _ in read)
                if best is None or error < best[0]:
                    best = error, (R, t), [corners for _, corners in read]
        if best is not None:
            rig.board_rotation[moment], rig.board_shift[moment] = best[1]
            observations += [BoardObservation(c, moment, corners) for c, corners in zip(here, best[2], strict=True)]
    return rig, observations


def _best_labelling(camera: _ObservingCamera, R: F64, t: F64, moment: int) -> tuple[float, DetectedCorners]:
    """The labelling of an observation's corners that fits a board at R, t in camera axes, and its mean error."""
    readings = camera.readings[moment]
    errors = [float(_capped_distances(r.plane @ R.T + t, r.corners.pixels, camera).mean()) for r in readings]
    best = int(np.argmin(errors))
    return errors[best], readings[best].corners


def _refine(
    points: F64, rig: RigEstimate, observations: list[BoardObservation], bases: Sequence[F64], joined: tuple[int, ...]
) -> RigSolution:
    """Bundle adjustment: poses first, then intrinsics too, without outliers."""
    held = [basis[:, :0] for basis in bases]
    inliers = [s for s in observations if _is_in_front(points, rig, s)]
    outliers = [s for s in observations if not _is_in_front(points, rig, s)]
    rig, _ = adjust_bundle(points, inliers, rig, held, joined[0])
    for number in range(RIG_MAX_ROUNDS):
        out = _worst_outliers(points, rig, inliers)
        if number and not out:
            break
        log.info("round %d: %d observations, %d outliers", number, len(inliers), len(out))
        outliers += out
        inliers = [s for s in inliers if all(s is not other for other in out)]
        counts = [sum(s.camera == c for s in inliers) for c in range(len(bases))]
        free = [basis if n >= RIG_MIN_REFINED_BOARDS else basis[:, :0] for basis, n in zip(bases, counts, strict=True)]
        rig, deviations = adjust_bundle(points, inliers, rig, free, joined[0])
    return RigSolution(rig, joined, tuple(inliers), tuple(outliers), deviations)


def _is_in_front(points: F64, rig: RigEstimate, observation: BoardObservation) -> bool:
    return bool((rig.in_camera(points, observation)[:, 2] > 0).all())


def _worst_outliers(points: F64, rig: RigEstimate, observations: Sequence[BoardObservation]) -> list[BoardObservation]:
    """At each moment the worst observation, if it is an outlier.

    An outlier spoils the other observations of its moment, so these are judged again without it.
    """
    errors = [float(np.sqrt(np.mean(np.sum(rig.residuals(points, s) ** 2, axis=1)))) for s in observations]
    limit = max(RIG_OUTLIER_MEDIANS * float(np.median(errors)), RIG_NOISE_PIXELS)
    worst: dict[int, tuple[float, BoardObservation]] = {}
    for error, observation in zip(errors, observations, strict=True):
        if error > limit and (observation.moment not in worst or error > worst[observation.moment][0]):
            worst[observation.moment] = error, observation
    return [observation for _, observation in worst.values()]
