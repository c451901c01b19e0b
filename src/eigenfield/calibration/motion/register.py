"""Cameras of photographs that took no part in structure from motion, from their matches with its finished points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.lenses import KnownLens
from eigenfield.calibration.motion.colmap_core import pycolmap
from eigenfield.calibration.motion.features import Features
from eigenfield.calibration.motion.mapping import (
    MAPPING_LOSS_RANGE_PIXELS,
    MAPPING_MIN_OBSERVATIONS,
    MAPPING_OUTLIER_RANGE_PIXELS,
    MAPPING_OUTLIER_SPREADS,
    MAPPING_RELAXED_MIN_INLIER_RATIO,
    MAPPING_RELAXED_MIN_INLIERS,
    MAPPING_SIGMA_PER_MEDIAN,
    SparseModel,
)
from eigenfield.calibration.motion.matching import Match
from eigenfield.calibration.motion.result import SfmResult, ViewReport, lost, solved_camera, solved_lens
from eigenfield.capture.photoset import PhotoSet

# Constants of `find_pose`.
REGISTER_ERROR_PIXELS = 12.0  # RANSAC threshold, for a longer side of 2000 pixels
REGISTER_MIN_SIDE = 800  # longer side of the smallest photograph for which that threshold shrinks
REGISTER_GRADIENT_TOLERANCE = 1e-3  # at which the refinement ends


@dataclass(frozen=True, eq=False)
class Pose:
    """Where a camera stands.

    Attributes:
        cam_from_world: A pycolmap.Rigid3d.
        inliers: (n,) bool, the points that agree.
        error: Their mean reprojection error, pixels.
    """

    cam_from_world: Any
    inliers: NDArray[np.bool_]
    error: float


def find_pose(
    pixels: NDArray[np.float64], points: NDArray[np.float64], camera: Any, estimate_focal: bool, seed: int
) -> Pose | None:
    """The pose from which points are seen at pixels; None if too few agree on one.

    LO-RANSAC, then refinement under Cauchy's loss, whose scale and limit follow the residuals as in `map_views`.

    Args:
        pixels: (n, 2) of the camera.
        points: (n, 3) world.
        camera: A pycolmap.Camera.
        estimate_focal: Its focal length is estimated too, and changed.
    """
    if len(pixels) < MAPPING_RELAXED_MIN_INLIERS:
        return None
    options = pycolmap.AbsolutePoseEstimationOptions()
    options.estimate_focal_length = estimate_focal
    options.ransac.random_seed = seed
    longer = max(camera.width, camera.height, REGISTER_MIN_SIDE)
    options.ransac.max_error = REGISTER_ERROR_PIXELS * longer / 2000
    found = pycolmap.estimate_absolute_pose(pixels, points, camera, options)
    if found is None:
        return None
    refine = pycolmap.AbsolutePoseRefinementOptions()
    refine.refine_focal_length = estimate_focal
    refine.gradient_tolerance = REGISTER_GRADIENT_TOLERANCE
    pose, inliers = found["cam_from_world"], np.asarray(found["inlier_mask"], bool)
    errors = _errors(pose, pixels, points, camera)
    for times in MAPPING_OUTLIER_SPREADS:
        if inliers.sum() < max(MAPPING_RELAXED_MIN_INLIERS, MAPPING_RELAXED_MIN_INLIER_RATIO * len(pixels)):
            return None
        spread = MAPPING_SIGMA_PER_MEDIAN * float(np.median(errors[inliers]))
        refine.loss_function_scale = float(np.clip(spread, *MAPPING_LOSS_RANGE_PIXELS))
        found = pycolmap.refine_absolute_pose(pose, pixels, points, inliers, camera, refine)
        if found is None:
            return None
        pose = found["cam_from_world"]
        errors = _errors(pose, pixels, points, camera)
        spread = MAPPING_SIGMA_PER_MEDIAN * float(np.median(errors[inliers]))
        inliers = errors <= np.clip(times * spread, *MAPPING_OUTLIER_RANGE_PIXELS)
    if inliers.sum() < MAPPING_MIN_OBSERVATIONS:
        return None
    return Pose(pose, inliers, float(errors[inliers].mean()))


def _errors(pose: Any, pixels: NDArray[np.float64], points: NDArray[np.float64], camera: Any) -> NDArray[np.float64]:
    """(n,) pixels between each point's projection and its pixel; infinite behind the camera."""
    matrix = np.asarray(pose.matrix())
    local = points @ matrix[:, :3].T + matrix[:, 3]
    away = np.linalg.norm(np.asarray(camera.img_from_cam(local)) - pixels, axis=1)
    return np.where((local[:, 2] > 0) & np.isfinite(away), away, np.inf)


def register_photographs(
    photos: PhotoSet,
    motion: SfmResult,
    model: SparseModel,
    shown: Sequence[int],
    features: Sequence[Features],
    cameras: Sequence[Any],
    known: Sequence[KnownLens] | None,
    matches: Sequence[Match],
    waiting: Mapping[int, ViewReport],
    seed: int,
) -> SfmResult:
    """The result with cameras of photographs that took no part in it. Its own cameras and points stay.

    Args:
        photos: All photographs.
        motion: Of those that took part.
        model: Theirs.
        shown: Their indices among all.
        features: Of all photographs, undistorted.
        cameras: A pycolmap.Camera for each of all photographs, before any is refined.
        matches: Between photographs that took part and those that did not.
        waiting: What is reported of each that took no part if it gets no camera.
    """
    report = dict(waiting) | dict(zip(shown, motion.report, strict=True))
    views = [shown[number] for number in model.registered]
    found = {i: (view.camera, view.lens) for i, view in zip(views, motion.light_field.views, strict=True)}
    point_of = _points_of_features(model, shown)
    refined = {image.camera_id for image in model.reconstruction.images.values()}
    for index in sorted(waiting):
        rows, numbers = _matched_points(index, matches, point_of)
        shared = cameras[index].camera_id in refined
        camera = model.reconstruction.camera(cameras[index].camera_id) if shared else copy(cameras[index])
        estimate_focal = not shared and not camera.has_prior_focal_length
        points = motion.points.positions[numbers]
        pose = find_pose(features[index].points[rows], points, camera, estimate_focal, seed + index)
        if pose is not None:
            lens = solved_lens(camera, None if known is None else known[index])
            found[index] = solved_camera(lens, pose.cam_from_world, photos.shots[index]), lens.lens
            seen = int(pose.inliers.sum())
            report[index] = replace(
                report[index], registered=True, code="", reason="", observations=seen, error=pose.error
            )
    entries = tuple(report[index] for index in range(len(photos)))
    order = sorted(found)
    solved, lenses = zip(*(found[index] for index in order), strict=True)
    light_field = photos.subset(order).with_cameras(solved, lenses, lost(entries))
    place = np.searchsorted(order, views)
    return SfmResult(light_field, replace(motion.points, view=place[motion.points.view]), entries)


def _points_of_features(model: SparseModel, shown: Sequence[int]) -> dict[int, NDArray[np.int64]]:
    """(n,) the point that each feature of a registered photograph shows, or -1, by the photograph's index."""
    row = {number: place for place, number in enumerate(sorted(model.reconstruction.point3D_ids()))}
    return {
        shown[own]: np.array(
            [row.get(p.point3D_id, -1) for p in model.reconstruction.image(own + 1).points2D], np.int64
        )
        for own in model.registered
    }


def _matched_points(
    index: int, matches: Sequence[Match], point_of: Mapping[int, NDArray[np.int64]]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(n,) features of a photograph and (n,) the points that they show, by its matches with registered photographs."""
    pairs = [np.zeros((0, 2), np.int64)]
    for match in matches:
        if match.geometry is not None and index in (match.first, match.second):
            rows = np.asarray(match.geometry.inlier_matches, np.int64)
            mine, other = (0, match.second) if index == match.first else (1, match.first)
            pairs.append(np.stack([rows[:, mine], point_of[other][rows[:, 1 - mine]]], axis=1))
    both = np.unique(np.concatenate(pairs), axis=0)
    both = both[both[:, 1] >= 0]
    return both[:, 0], both[:, 1]
