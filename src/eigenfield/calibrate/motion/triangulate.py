"""Points of a scene whose cameras are known: features matched along epipolar lines, joined to tracks, triangulated."""

from __future__ import annotations

import logging
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from eigenfield.calibrate.lenses import KnownLens, undistorted
from eigenfield.calibrate.motion.features import FeatureOptions, Features, extract_features
from eigenfield.calibrate.motion.matching import mutual_matches
from eigenfield.capture.lightfield import LightField
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.core.camera import Camera
from eigenfield.core.progress import Progress, track
from eigenfield.imaging.graph import components
from eigenfield.runtime.parallel import parallel_stream

log = logging.getLogger("eigenfield.calibrate")

MOST_VIEWS = 32
PARTNERS = 8  # views that each is compared with
FACING = 0.2  # cosine between the axes of two cameras that may see the same side of a thing
SAME_PLACE = 1e-3  # of the array's size
OPTIONS = FeatureOptions(side=1200, most=3000)
WEAK = FeatureOptions(side=1200, most=3000, peak=0.002)
LITTLE_TEXTURE = 1000  # features of the median photograph, below which weaker ones are looked for
FEWEST_VIEWS = 3  # of a track: two views agree by chance wherever a feature lies on the epipolar line
ERROR = 3.0  # pixels at 2000 along the longer side, largest of a track's
NARROWEST = 0.5  # degrees between the widest rays of a track


def triangulated_points(light_field: LightField, *, progress: Progress | None = None) -> NDArray[np.float64]:
    """(n, 3) world points that at least three views show alike; none where the photographs are bare.

    At most MOST_VIEWS views are looked at. Nothing of the cameras is changed. Raises CaptureError for a photograph
    that cannot be read.
    """
    count = min(len(light_field), MOST_VIEWS)
    views = np.linspace(0, len(light_field) - 1, count).astype(np.int64).tolist()
    shots = [_shot(light_field, index) for index in views]
    cameras = [light_field.views[index].camera for index in views]
    features = _features(PhotoSet(light_field.root, tuple(shots), None, (), "folder"), OPTIONS, progress)
    if np.median([len(found) for found in features]) < LITTLE_TEXTURE:
        features = _features(PhotoSet(light_field.root, tuple(shots), None, (), "folder"), WEAK, progress)
    flat = []
    for found, camera, index in zip(features, cameras, views, strict=True):
        points = undistorted(found.points, KnownLens(camera.K, light_field.views[index].lens))
        good = np.asarray(np.isfinite(points).all(axis=1))
        flat.append(found.subset(good).at(points[good]))
    matches = _matched(flat, cameras, progress)
    points = _triangulated(flat, cameras, matches)
    log.info("points: %d triangulated from %d views", len(points), len(views))
    return points


def _shot(light_field: LightField, index: int) -> Shot:
    view = light_field.views[index]
    return Shot(view.name, view.path, view.camera.width, view.camera.height, None, view.mask, view.upright)


def _features(photos: PhotoSet, options: FeatureOptions, progress: Progress | None) -> list[Features]:
    found = []
    for features in extract_features(photos, options, progress):
        if not isinstance(features, Features):
            raise features
        found.append(features)
    return found


def _pairs(cameras: Sequence[Camera]) -> list[tuple[int, int]]:
    """Each view with the PARTNERS most like it in place and direction, but not those at the same place."""
    centres, axes = np.array([c.centre for c in cameras]), np.array([c.R[2] for c in cameras])
    size = float(np.linalg.norm(np.ptp(centres, axis=0))) or 1.0
    apart = np.linalg.norm(centres[:, None] - centres[None], axis=2) / size
    unlike = np.hypot(apart, np.linalg.norm(axes[:, None] - axes[None], axis=2))
    unlike[(apart < SAME_PLACE) | (axes @ axes.T < FACING)] = np.inf
    pairs = set()
    for i, row in enumerate(unlike):
        for j in np.argsort(row, kind="stable")[:PARTNERS].tolist():
            if np.isfinite(row[j]):
                pairs.add((min(i, j), max(i, j)))
    return sorted(pairs)


def fundamental(first: Camera, second: Camera) -> NDArray[np.float64]:
    """(3, 3) F with x2 . F x1 = 0 for homogeneous pixels of one point in both."""
    R = second.R @ first.R.T
    x, y, z = second.t - R @ first.t
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    F = np.linalg.inv(second.K).T @ cross @ R @ np.linalg.inv(first.K)
    return np.asarray(F / np.linalg.norm(F))


def _matched(
    features: Sequence[Features], cameras: Sequence[Camera], progress: Progress | None
) -> list[tuple[int, int, NDArray[np.int64]]]:
    descriptors = [found.descriptors.astype(np.float32) for found in features]
    pairs = _pairs(cameras)

    def one(pair: tuple[int, int]) -> tuple[int, int, NDArray[np.int64]]:
        i, j = pair
        lines = features[i].points, features[j].points, fundamental(cameras[i], cameras[j])
        return i, j, mutual_matches(descriptors[i], descriptors[j], lines)

    with threadpool_limits(1, "blas"):
        return list(track(parallel_stream(one, pairs), "matches", len(pairs), progress))


def _triangulated(
    features: Sequence[Features], cameras: Sequence[Camera], matches: Sequence[tuple[int, int, NDArray[np.int64]]]
) -> NDArray[np.float64]:
    """The point nearest to the rays of each track (least squares), where all of its views show it there."""
    start = np.cumsum([0, *(len(found) for found in features)])
    left = np.concatenate([start[i] + found[:, 0] for i, _, found in matches] or [np.zeros(0, np.int64)])
    right = np.concatenate([start[j] + found[:, 1] for _, j, found in matches] or [np.zeros(0, np.int64)])
    track_of = components(int(start[-1]), left, right)
    view = np.repeat(np.arange(len(features)), np.diff(start))
    count = np.bincount(track_of)
    twice = np.zeros(len(count), np.bool_)  # two features of one view: a mix of points
    key = np.sort(track_of.astype(np.int64) * len(features) + view)
    twice[key[1:][np.diff(key) == 0] // len(features)] = True
    chosen = np.flatnonzero(((count >= FEWEST_VIEWS) & ~twice)[track_of])
    if len(chosen) == 0:
        return np.zeros((0, 3))
    _, number = np.unique(track_of[chosen], return_inverse=True)
    view = view[chosen]
    pixels = np.concatenate([found.points for found in features])[chosen]
    centres = np.array([camera.centre for camera in cameras])
    middle, size = centres.mean(axis=0), float(np.ptp(centres, axis=0).max()) or 1.0
    origin = (centres[view] - middle) / size
    lift = np.array([camera.R.T @ np.linalg.inv(camera.K) for camera in cameras])
    rays = np.einsum("nij,nj->ni", lift[view], np.hstack([pixels, np.ones((len(pixels), 1))]))
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    across = np.eye(3) - rays[:, :, None] * rays[:, None]
    normal, side = np.zeros((number.max() + 1, 3, 3)), np.zeros((number.max() + 1, 3))
    np.add.at(normal, number, across)
    np.add.at(side, number, np.einsum("nij,nj->ni", across, origin))
    total = np.bincount(number)
    sharp = np.sin(np.radians(NARROWEST)) ** 2 / 4  # of two rays apart by a the least eigenvalue is 2 sin^2(a / 2)
    normal[np.linalg.eigvalsh(normal)[:, 0] < sharp * total / 2] = np.nan
    known = np.isfinite(normal).all(axis=(1, 2))
    points = np.full((len(total), 3), np.nan)
    points[known] = np.linalg.solve(normal[known], side[known][..., None])[..., 0] * size + middle
    wrong = np.asarray(~known)
    for index, camera in enumerate(cameras):
        own = view == index
        seen, depth = camera.project(np.nan_to_num(points[number[own]]))
        off = np.linalg.norm(seen - pixels[own], axis=1)
        limit = ERROR * max(camera.width, camera.height) / 2000
        with np.errstate(invalid="ignore"):
            wrong[number[own][~((depth > 0) & (off < limit))]] = True
    return points[~wrong]
