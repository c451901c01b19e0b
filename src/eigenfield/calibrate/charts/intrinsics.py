"""One camera from its sightings of a board: how loose a lens model they support, and which of them are outliers.

A loose model fits few sightings better and everything else worse. So each model of a ladder is judged on sightings that
it was not fitted to (four folds), and the stiffest one within a few per cent of the best is taken.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.charts.corners import Corners
from eigenfield.calibrate.charts.lens_models import LADDER, Freedom, matrix, project
from eigenfield.imaging.sampling import distances_to, farthest_points

log = logging.getLogger("eigenfield.calibrate")

FEWEST = 3  # sightings of a board from which intrinsics can be had
MOST = 32  # sightings that the start is fitted to: OpenCV solves one dense system of 6 unknowns each
FOLDS = 4
WORTH = 0.99  # of the error: a looser model must get below it
OUTLIER = 4.0  # times the median error of a camera's sightings
NOISE = 0.5  # pixels of error that are never an outlier
ROUNDS = 3
FOLD_BACK = 1.05  # times the pictures' farthest corner: up to there a lens must not fold back


@dataclass(frozen=True, eq=False)
class Start:
    """Intrinsics of one camera before the rig is known.

    intrinsics: (9,), see `lens_models`. freedom: the model that was chosen.
    kept: indices of the sightings that are no outliers.
    """

    intrinsics: NDArray[np.float64]
    freedom: Freedom
    kept: tuple[int, ...]


def start_intrinsics(points: NDArray[np.float64], sightings: Sequence[Corners], size: tuple[int, int]) -> Start | None:
    """Intrinsics of a camera of `size` (width, height) from its sightings; None where they do not give any.

    points: (n, 3) corners on the board.
    """
    kept = list(range(len(sightings)))
    if len(kept) < FEWEST:
        return None
    found: Start | None = None
    for _ in range(ROUNDS):
        fit = _choose(points, _spread([sightings[i] for i in kept], size), size)
        if fit is None:
            break
        found = Start(fit[0], fit[1], tuple(kept))
        errors = np.array([_view_error(points, sightings[i], fit[0]) for i in kept])
        limit = max(OUTLIER * float(np.median(errors)), NOISE)
        good = [i for i, error in zip(kept, errors, strict=True) if error <= limit]
        if len(good) == len(kept) or len(good) < FEWEST:
            break
        kept = good
    return found


def board_pose(
    points: NDArray[np.float64], corners: Corners, intrinsics: NDArray[np.float64]
) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Poses (R, t) of the board in camera axes that fit a sighting, best first.

    A plane seen from afar has two that fit almost equally well: the second is given where its error is less than twice
    the first's. Empty where none is in front of the camera.
    """
    K, d = matrix(intrinsics), intrinsics[4:]
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
            error = np.sqrt(np.mean(np.sum((project(inside, intrinsics) - corners.pixels) ** 2, axis=1)))
            found.append((float(error), R, t))
    found.sort(key=lambda pose: pose[0])
    return [(R, t) for error, R, t in found if error <= max(2 * found[0][0], NOISE)]


def _view_error(points: NDArray[np.float64], corners: Corners, intrinsics: NDArray[np.float64]) -> float:
    """Root mean square in pixels, the board's pose being free."""
    poses = board_pose(points, corners, intrinsics)
    if not poses:
        return np.inf
    R, t = poses[0]
    away = project(points[corners.ids] @ R.T + t, intrinsics) - corners.pixels
    return float(np.sqrt(np.mean(np.sum(away**2, axis=1))))


def _spread(sightings: Sequence[Corners], size: tuple[int, int]) -> list[Corners]:
    """At most MOST of the sightings, those that differ most in place, scale and tilt, in their order."""
    if len(sightings) <= MOST:
        return list(sightings)
    traits = np.array([_traits(s, size) for s in sightings])
    first = int(np.argmax([len(s.ids) for s in sightings]))
    return [sightings[i] for i in sorted(farthest_points(distances_to(traits), first, MOST))]


def _traits(corners: Corners, size: tuple[int, int]) -> NDArray[np.float64]:
    """Middle and second moments of the corners in the picture."""
    places = corners.pixels / max(size)
    spread = np.cov(places.T)
    return np.array([*places.mean(axis=0), *np.sqrt(np.diag(spread)), np.sign(spread[0, 1]) * abs(spread[0, 1]) ** 0.5])


def _choose(
    points: NDArray[np.float64], sightings: Sequence[Corners], size: tuple[int, int]
) -> tuple[NDArray[np.float64], Freedom] | None:
    """The stiffest model that explains unseen sightings about as well as any, fitted to all."""
    folds = min(FOLDS, len(sightings))
    scores: list[tuple[float, Freedom]] = []
    for freedom in LADDER:
        errors: list[float] = []
        for fold in range(folds):
            known = [s for i, s in enumerate(sightings) if i % folds != fold]
            fit = _fit(points, known, size, freedom)
            unseen = [s for i, s in enumerate(sightings) if i % folds == fold]
            errors += [np.inf] * len(unseen) if fit is None else [_view_error(points, s, fit) for s in unseen]
        # outliers are still among them: the middle half
        low, high = len(errors) // 4, -(-3 * len(errors) // 4)
        scores.append((float(np.mean(np.sort(errors)[low:high])), freedom))
    best = min(score for score, _ in scores)
    for score, freedom in scores:
        if score <= best / WORTH:
            fit = _fit(points, sightings, size, freedom)
            if fit is not None:
                log.info("lens model %s: unseen sightings %.3f px, best of all %.3f px", freedom, score, best)
                return fit, freedom
    return None


def _fit(
    points: NDArray[np.float64], sightings: Sequence[Corners], size: tuple[int, int], freedom: Freedom
) -> NDArray[np.float64] | None:
    """(9,) intrinsics, None where the solver fails or ends somewhere impossible."""
    if len(sightings) < 2:
        return None
    plane = [points[s.ids].astype(np.float32) for s in sightings]
    pixels = [s.pixels.astype(np.float32) for s in sightings]
    width, height = size
    focal = _first_focal(plane, pixels, size)
    K = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1.0]])
    try:
        _, K, d, _, _ = cv2.calibrateCamera(
            plane, pixels, size, K, np.zeros(5), flags=freedom.flags | cv2.CALIB_USE_INTRINSIC_GUESS,
            criteria=(cv2.TERM_CRITERIA_COUNT + cv2.TERM_CRITERIA_EPS, 60, 1e-9),
        )  # fmt: skip
    except cv2.error:
        return None
    found = np.array([K[0, 0], K[1, 1], K[0, 2], K[1, 2], *d.ravel()[:5]])
    sensible = np.isfinite(found).all() and 0.05 * max(size) < found[:2].min() and found[:2].max() < 100 * max(size)
    inside = 0 < found[2] < width and 0 < found[3] < height
    return found if sensible and inside and _is_monotone(found, sightings) else None


def _first_focal(
    plane: Sequence[NDArray[np.float32]], pixels: Sequence[NDArray[np.float32]], size: tuple[int, int]
) -> float:
    """Zhang's linear start, held within what lenses have."""
    try:
        K = cv2.initCameraMatrix2D(plane, pixels, size, 1)
        focal = float(K[0, 0])
    except cv2.error:
        focal = np.nan
    return focal if 0.2 * max(size) < focal < 20 * max(size) else 1.2 * max(size)


def _is_monotone(intrinsics: NDArray[np.float64], sightings: Sequence[Corners]) -> bool:
    """Whether the lens does not fold back where there are corners."""
    k1, k2, k3 = intrinsics[4], intrinsics[5], intrinsics[8]
    reach = max(float(np.linalg.norm((s.pixels - intrinsics[2:4]) / intrinsics[:2], axis=1).max()) for s in sightings)
    radius = np.linspace(0, 4 * FOLD_BACK * reach, 400)
    r2 = radius**2
    bent = radius * (1 + r2 * (k1 + r2 * (k2 + r2 * k3)))
    turn = np.argmax(np.diff(bent) <= 0) if (np.diff(bent) <= 0).any() else len(bent) - 1
    return bool(bent[turn] >= FOLD_BACK * reach)
