"""Points of a scene with known cameras: features matched along epipolar lines, joined to tracks, triangulated."""

from __future__ import annotations

import logging
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.lenses import KnownLens
from eigenfield.calibration.motion.features import FeatureOptions, Features, extract_features, undistort_features
from eigenfield.calibration.motion.matching import mutual_matches
from eigenfield.capture.lightfield import LightField
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.core.camera import Camera
from eigenfield.core.progress import Progress
from eigenfield.imaging.graph import components
from eigenfield.runtime.parallel import tracked_map

log = logging.getLogger("eigenfield.calibration")


# Constants of `triangulate_points`.
TRIANGULATION_MAX_VIEWS = 32  # views that are used
TRIANGULATION_PARTNERS = 8  # views that each is compared with
TRIANGULATION_MIN_AXIS_COSINE = 0.2  # cosine between the axes of two cameras that may see the same side of an object
TRIANGULATION_MIN_DISTANCE_SIZES = 0.001  # distance between two compared cameras, relative to the size of the array
TRIANGULATION_MIN_MEDIAN_FEATURES = 1000  # features of the median photograph below which there is little texture
# Views of a track. Two views agree by chance wherever a feature lies on the epipolar line.
TRIANGULATION_MIN_TRACK_VIEWS = 3
TRIANGULATION_MAX_ERROR_PIXELS = 3.0  # largest reprojection error in a track, for a longer side of 2000 pixels
TRIANGULATION_MIN_ANGLE_DEGREES = 0.5  # angle between the widest rays of a track
TRIANGULATION_FEATURES = FeatureOptions(max_side=1200, max_features=3000)
TRIANGULATION_WEAK_FEATURES = FeatureOptions(max_side=1200, max_features=3000, peak_threshold=0.002)


def triangulate_points(light_field: LightField, *, progress: Progress | None = None) -> NDArray[np.float64]:
    """World points that at least three views agree on.

    The cameras are not changed. At most `TRIANGULATION_MAX_VIEWS` views are used.

    Returns:
        (n, 3) points; none if the photographs have no texture.

    Raises:
        CaptureError: A photograph cannot be read.
    """
    count = min(len(light_field), TRIANGULATION_MAX_VIEWS)
    views = np.linspace(0, len(light_field) - 1, count).astype(np.int64).tolist()
    cameras = [light_field.views[index].camera for index in views]
    shots = tuple(Shot.of(light_field.views[index]) for index in views)
    photos = PhotoSet(light_field.root, shots, None, (), "folder")
    features = _features(photos, TRIANGULATION_FEATURES, progress)
    if np.median([len(found) for found in features]) < TRIANGULATION_MIN_MEDIAN_FEATURES:
        features = _features(photos, TRIANGULATION_WEAK_FEATURES, progress)
    lenses = [KnownLens(camera.K, light_field.views[index].lens) for camera, index in zip(cameras, views, strict=True)]
    undistorted = [undistort_features(found, lens)[0] for found, lens in zip(features, lenses, strict=True)]
    matches = _match_views(undistorted, cameras, progress)
    points = _triangulate_tracks(undistorted, cameras, matches)
    log.info("points: %d triangulated from %d views", len(points), len(views))
    return points


def _features(photos: PhotoSet, options: FeatureOptions, progress: Progress | None) -> list[Features]:
    found = []
    for features in extract_features(photos, options, progress):
        if not isinstance(features, Features):
            raise features
        found.append(features)
    return found


def _pairs(cameras: Sequence[Camera]) -> list[tuple[int, int]]:
    """Each view with the partners most similar in position and direction, excluding those at the same place."""
    centres, axes = np.array([c.centre for c in cameras]), np.array([c.R[2] for c in cameras])
    size = float(np.linalg.norm(np.ptp(centres, axis=0))) or 1.0
    apart = np.linalg.norm(centres[:, None] - centres[None], axis=2) / size
    unlike = np.hypot(apart, np.linalg.norm(axes[:, None] - axes[None], axis=2))
    unlike[apart < TRIANGULATION_MIN_DISTANCE_SIZES] = np.inf
    unlike[axes @ axes.T < TRIANGULATION_MIN_AXIS_COSINE] = np.inf
    pairs = set()
    for i, row in enumerate(unlike):
        for j in np.argsort(row, kind="stable")[:TRIANGULATION_PARTNERS].tolist():
            if np.isfinite(row[j]):
                pairs.add((min(i, j), max(i, j)))
    return sorted(pairs)


def fundamental_matrix(first: Camera, second: Camera) -> NDArray[np.float64]:
    """(3, 3) F with x2 . F x1 = 0 for homogeneous pixels x1, x2 of one point.

    Args:
        first: Camera of x1.
        second: Camera of x2.
    """
    R = second.R @ first.R.T
    x, y, z = second.t - R @ first.t
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    F = np.linalg.inv(second.K).T @ cross @ R @ np.linalg.inv(first.K)
    return np.asarray(F / np.linalg.norm(F))


def _match_views(
    features: Sequence[Features], cameras: Sequence[Camera], progress: Progress | None
) -> list[tuple[int, int, NDArray[np.int64]]]:
    pairs = _pairs(cameras)

    def match(pair: tuple[int, int]) -> tuple[int, int, NDArray[np.int64]]:
        i, j = pair
        lines = features[i].points, features[j].points, fundamental_matrix(cameras[i], cameras[j])
        return i, j, mutual_matches(features[i].descriptors, features[j].descriptors, lines)

    return tracked_map(match, pairs, "matches", progress)


def _triangulate_tracks(
    features: Sequence[Features], cameras: Sequence[Camera], matches: Sequence[tuple[int, int, NDArray[np.int64]]]
) -> NDArray[np.float64]:
    """The least-squares intersection of each track's rays, kept if all of its views confirm it."""
    start = np.cumsum([0, *(len(found) for found in features)])
    left = np.concatenate([start[i] + found[:, 0] for i, _, found in matches] or [np.zeros(0, np.int64)])
    right = np.concatenate([start[j] + found[:, 1] for _, j, found in matches] or [np.zeros(0, np.int64)])
    track_of = components(int(start[-1]), left, right)
    view = np.repeat(np.arange(len(features)), np.diff(start))
    count = np.bincount(track_of)
    twice = np.zeros(len(count), np.bool_)  # two features of one view: the track mixes points
    key = np.sort(track_of.astype(np.int64) * len(features) + view)
    twice[key[1:][np.diff(key) == 0] // len(features)] = True
    chosen = np.flatnonzero(((count >= TRIANGULATION_MIN_TRACK_VIEWS) & ~twice)[track_of])
    if len(chosen) == 0:
        return np.zeros((0, 3))
    _, number = np.unique(track_of[chosen], return_inverse=True)
    view = view[chosen]
    pixels = np.concatenate([found.points for found in features])[chosen]
    centres = np.array([camera.centre for camera in cameras])
    middle, size = centres.mean(axis=0), float(np.ptp(centres, axis=0).max()) or 1.0
    origin = (centres[view] - middle) / size
    unproject = np.array([camera.R.T @ np.linalg.inv(camera.K) for camera in cameras])
    rays = np.einsum("nij,nj->ni", unproject[view], np.hstack([pixels, np.ones((len(pixels), 1))]))
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    across = np.eye(3) - rays[:, :, None] * rays[:, None]
    normal, side = np.zeros((number.max() + 1, 3, 3)), np.zeros((number.max() + 1, 3))
    np.add.at(normal, number, across)
    np.add.at(side, number, np.einsum("nij,nj->ni", across, origin))
    total = np.bincount(number)
    # for two rays at angle a the smallest eigenvalue is 2 sin^2(a / 2)
    sharp = np.sin(np.radians(TRIANGULATION_MIN_ANGLE_DEGREES)) ** 2 / 4
    normal[np.linalg.eigvalsh(normal)[:, 0] < sharp * total / 2] = np.nan
    known = np.isfinite(normal).all(axis=(1, 2))
    points = np.full((len(total), 3), np.nan)
    points[known] = np.linalg.solve(normal[known], side[known][..., None])[..., 0] * size + middle
    wrong = np.asarray(~known)
    for index, camera in enumerate(cameras):
        here = view == index
        seen, depth = camera.project(np.nan_to_num(points[number[here]]))
        off = np.linalg.norm(seen - pixels[here], axis=1)
        limit = TRIANGULATION_MAX_ERROR_PIXELS * max(camera.width, camera.height) / 2000
        with np.errstate(invalid="ignore"):
            wrong[number[here][~((depth > 0) & (off < limit))]] = True
    return points[~wrong]
