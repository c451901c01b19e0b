"""Intrinsics of one camera from its observations of a board: how many parameters they support, and the outliers.

A model with more parameters fits few observations better and everything else worse. Each model is therefore
cross-validated (four folds), and the one with the fewest parameters within a per cent of the best is taken.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.charts.corners import DetectedCorners
from eigenfield.calibration.charts.lens_models import LENS_MODEL_LADDER, LensModel, camera_matrix, project_points
from eigenfield.imaging.sampling import distances_to, farthest_points

log = logging.getLogger("eigenfield.calibration")

F64 = NDArray[np.float64]

INTRINSICS_MIN_BOARDS = 3  # fewer do not determine the intrinsics
INTRINSICS_MAX_BOARDS = 32  # for the fit: OpenCV solves one dense system with 6 unknowns for each
INTRINSICS_FOLDS = 4
INTRINSICS_MIN_GAIN_RATIO = 0.99  # a model with more parameters must reduce the error below this fraction
INTRINSICS_OUTLIER_MEDIANS = 4.0  # times the median error of a camera's observations
INTRINSICS_NOISE_PIXELS = 0.5  # a smaller error is never an outlier
INTRINSICS_ROUNDS = 3
INTRINSICS_MONOTONE_RADIUS_RATIO = 1.05  # up to this times the radius of the farthest corner


@dataclass(frozen=True, eq=False)
class IntrinsicsEstimate:
    """Intrinsics of one camera before the rig is known.

    Attributes:
        intrinsics: (9,), see `lens_models`.
        inliers: Indices of the observations that are no outliers.
    """

    intrinsics: F64
    model: LensModel
    inliers: tuple[int, ...]


def estimate_intrinsics(
    points: F64, observations: Sequence[DetectedCorners], size: tuple[int, int]
) -> IntrinsicsEstimate | None:
    """Intrinsics of a camera from its detections; None if they do not determine any.

    Args:
        points: (n, 3) corners on the board.
        size: (width, height) of its pictures.
    """
    inliers = list(range(len(observations)))
    if len(inliers) < INTRINSICS_MIN_BOARDS:
        return None
    found: IntrinsicsEstimate | None = None
    for _ in range(INTRINSICS_ROUNDS):
        fit = _select_model(points, _spread_observations([observations[i] for i in inliers], size), size)
        if fit is None:
            break
        found = IntrinsicsEstimate(fit[0], fit[1], tuple(inliers))
        errors = np.array([_reprojection_error(points, observations[i], fit[0]) for i in inliers])
        limit = max(INTRINSICS_OUTLIER_MEDIANS * float(np.median(errors)), INTRINSICS_NOISE_PIXELS)
        good = [i for i, error in zip(inliers, errors, strict=True) if error <= limit]
        if len(good) == len(inliers) or len(good) < INTRINSICS_MIN_BOARDS:
            break
        inliers = good
    return found


def board_pose(points: F64, corners: DetectedCorners, intrinsics: F64) -> list[tuple[F64, F64]]:
    """Poses (R, t) of the board in camera axes that fit a detection, best first.

    A distant plane has two poses that fit almost equally well. The second is returned if its error is less than twice
    the first's.

    Args:
        points: (n, 3) corners on the board.
        intrinsics: (9,) of the camera.

    Returns:
        At most two poses; none if no pose is in front of the camera.
    """
    found = _scored_poses(points, corners, intrinsics)
    return [(R, t) for error, R, t in found if error <= max(2 * found[0][0], INTRINSICS_NOISE_PIXELS)]


def _scored_poses(points: F64, corners: DetectedCorners, intrinsics: F64) -> list[tuple[float, F64, F64]]:
    """Poses of the board in camera axes with their root mean square errors in pixels, best first."""
    K, d = camera_matrix(intrinsics), intrinsics[4:]
    plane = points[corners.ids]
    try:
        _, rvecs, tvecs, _ = cv2.solvePnPGeneric(plane, corners.pixels, K, d, flags=cv2.SOLVEPNP_IPPE)
    except cv2.error:  # a degenerate homography
        return []
    found = []
    for rvec, tvec in zip(rvecs, tvecs, strict=True):
        if not (np.isfinite(rvec).all() and np.isfinite(tvec).all()):
            continue
        rvec, tvec = cv2.solvePnPRefineLM(plane, corners.pixels, K, d, rvec, tvec)
        R = np.asarray(cv2.Rodrigues(rvec)[0], np.float64)
        t = np.asarray(tvec, np.float64).ravel()
        inside = plane @ R.T + t
        if np.isfinite(inside).all() and (inside[:, 2] > 0).all():
            error = np.sqrt(np.mean(np.sum((project_points(inside, intrinsics) - corners.pixels) ** 2, axis=1)))
            found.append((float(error), R, t))
    return sorted(found, key=lambda pose: pose[0])


def _reprojection_error(points: F64, corners: DetectedCorners, intrinsics: F64) -> float:
    """Root mean square error in pixels at the board's best pose."""
    poses = _scored_poses(points, corners, intrinsics)
    return poses[0][0] if poses else np.inf


def _spread_observations(observations: Sequence[DetectedCorners], size: tuple[int, int]) -> list[DetectedCorners]:
    """At most INTRINSICS_MAX_BOARDS, those that differ most in place, scale and tilt, in their order."""
    if len(observations) <= INTRINSICS_MAX_BOARDS:
        return list(observations)
    traits = np.array([_pose_features(s, size) for s in observations])
    first = int(np.argmax([len(s.ids) for s in observations]))
    chosen = farthest_points(distances_to(traits), first, INTRINSICS_MAX_BOARDS)
    return [observations[i] for i in sorted(chosen)]


def _pose_features(corners: DetectedCorners, size: tuple[int, int]) -> F64:
    """Mean and second moments of the corners in the picture."""
    places = corners.pixels / max(size)
    spread = np.cov(places.T)
    return np.array([*places.mean(axis=0), *np.sqrt(np.diag(spread)), np.sign(spread[0, 1]) * abs(spread[0, 1]) ** 0.5])


def _select_model(
    points: F64, observations: Sequence[DetectedCorners], size: tuple[int, int]
) -> tuple[F64, LensModel] | None:
    """The model with the fewest parameters that predicts held-out observations about as well as any, fitted to all."""
    folds = min(INTRINSICS_FOLDS, len(observations))
    scores: list[tuple[float, LensModel]] = []
    for model in LENS_MODEL_LADDER:
        errors: list[float] = []
        for fold in range(folds):
            known = [s for i, s in enumerate(observations) if i % folds != fold]
            fit = _fit_model(points, known, size, model)
            unseen = [s for i, s in enumerate(observations) if i % folds == fold]
            errors += [np.inf] * len(unseen) if fit is None else [_reprojection_error(points, s, fit) for s in unseen]
        # outliers are still among them: mean of the middle half
        low, high = len(errors) // 4, -(-3 * len(errors) // 4)
        scores.append((float(np.mean(np.sort(errors)[low:high])), model))
    best = min(score for score, _ in scores)
    for score, model in scores:
        if score <= best / INTRINSICS_MIN_GAIN_RATIO:
            fit = _fit_model(points, observations, size, model)
            if fit is not None:
                log.info("lens model %s: held-out observations %.3f px, best of all %.3f px", model, score, best)
                return fit, model
    return None


def _fit_model(
    points: F64, observations: Sequence[DetectedCorners], size: tuple[int, int], model: LensModel
) -> F64 | None:
    """(9,) intrinsics; None if the solver fails or its result is implausible."""
    if len(observations) < 2:
        return None
    plane = [points[s.ids].astype(np.float32) for s in observations]
    pixels = [s.pixels.astype(np.float32) for s in observations]
    width, height = size
    focal = _initial_focal(plane, pixels, size)
    K = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1.0]])
    try:
        _, K, d, _, _ = cv2.calibrateCamera(
            plane, pixels, size, K, np.zeros(5), flags=model.flags | cv2.CALIB_USE_INTRINSIC_GUESS,
            criteria=(cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 60, 1e-9),
        )  # fmt: skip
    except cv2.error:
        return None
    found = np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2], *d.ravel()[:5]])
    sensible = np.isfinite(found).all() and 0.05 * max(size) < found[:2].min() and found[:2].max() < 100 * max(size)
    inside = 0 < found[2] < width and 0 < found[3] < height
    return found if sensible and inside and _is_monotone(found, observations) else None


def _initial_focal(
    plane: Sequence[NDArray[np.float32]], pixels: Sequence[NDArray[np.float32]], size: tuple[int, int]
) -> float:
    """Zhang's linear estimate, kept within the range of real lenses."""
    try:
        K = cv2.initCameraMatrix2D(plane, pixels, size, 1)
        focal = float(K[0, 0])
    except cv2.error:
        focal = np.nan
    return focal if 0.2 * max(size) < focal < 20 * max(size) else 1.2 * max(size)


def _is_monotone(intrinsics: F64, observations: Sequence[DetectedCorners]) -> bool:
    """Whether the distorted radius is monotone as far as there are corners."""
    k1, k2, k3 = intrinsics[4], intrinsics[5], intrinsics[8]
    max_radius = max(
        float(np.linalg.norm((s.pixels - intrinsics[2:4]) / intrinsics[:2], axis=1).max()) for s in observations
    )
    radius = np.linspace(0, 4 * INTRINSICS_MONOTONE_RADIUS_RATIO * max_radius, 400)
    r2 = radius**2
    distorted = radius * (1 + r2 * (k1 + r2 * (k2 + r2 * k3)))
    last = np.argmax(np.diff(distorted) <= 0) if (np.diff(distorted) <= 0).any() else len(distorted) - 1
    return bool(distorted[last] >= INTRINSICS_MONOTONE_RADIUS_RATIO * max_radius)
