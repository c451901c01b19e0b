"""COLMAP's model as a light field and sparse points, and the outcome for each photograph."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.align import natural_gauge, transform_camera
from eigenfield.calibration.lenses import KnownLens, distort_to_pixels
from eigenfield.calibration.motion.features import Features
from eigenfield.calibration.motion.mapping import SparseModel
from eigenfield.capture.lightfield import LightField
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.capture.points import SparsePoints
from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera
from eigenfield.core.errors import one_line

log = logging.getLogger("eigenfield.calibration")


@dataclass(frozen=True)
class ViewReport:
    """The outcome for one photograph.

    Attributes:
        name: The photograph's name.
        registered: Whether it has a camera now.
        code: Why not, for scripts: "unreadable", "few-features", "few-matches", "apart" (it matches only others without
            a camera), "no-pose" (it has matches, but no pose explains them); "" if it is registered.
        reason: Why not, for people; "" if it is registered.
        features: Features found in it.
        partners: Photographs with which it shares verified matches.
        observations: Points of the scene seen in it.
        error: Mean reprojection error in pixels; None if it is not registered.
    """

    name: str
    registered: bool
    code: str
    reason: str
    features: int
    partners: int
    observations: int
    error: float | None


@dataclass(frozen=True, eq=False)
class SfmResult:
    """The result of structure from motion.

    Attributes:
        light_field: The registered photographs with cameras and lenses, in the order of the set; `problems` lists the
            rest. The world is that of `natural_gauge`.
        points: The triangulated points; their views are those of the light field.
        report: One entry for each photograph of the set, in order.
    """

    light_field: LightField
    points: SparsePoints
    report: tuple[ViewReport, ...]

    __repr__ = brief_repr


def assemble(
    photos: PhotoSet,
    features: Sequence[Features],
    known: Sequence[KnownLens] | None,
    model: SparseModel,
    report: Sequence[ViewReport],
) -> SfmResult:
    """The light field and points of a model, in the world of `natural_gauge`.

    Args:
        features: Of each, as it shows them.
        report: An entry for each photograph; those with a camera get their figures.
    """
    chosen = list(model.registered)
    lenses, cameras = [], []
    for index in chosen:
        image = model.reconstruction.image(index + 1)
        lens = solved_lens(image.camera, None if known is None else known[index])
        lenses.append(lens)
        cameras.append(solved_camera(lens, image.cam_from_world(), photos.shots[index]))
    points = _points(model, chosen, features)
    scale, R, t = natural_gauge(cameras)
    cameras = [transform_camera(camera, scale, R, t) for camera in cameras]
    points = points.transform(scale, R, t)
    errors = _reprojection_errors(points, cameras, lenses)
    points = points.with_errors(errors)
    by_view = np.bincount(points.view, minlength=len(chosen))
    sums = np.bincount(points.view, weights=errors, minlength=len(chosen))
    entries = list(report)
    for place, index in enumerate(chosen):
        error = float(sums[place] / max(by_view[place], 1))
        entries[index] = replace(entries[index], observations=int(by_view[place]), error=error)
    log.info("%d of %d photographs have a camera", len(chosen), len(photos))
    light_field = photos.subset(chosen).with_cameras(cameras, [lens.lens for lens in lenses], lost(entries))
    return SfmResult(light_field, points, tuple(entries))


def lost(report: Sequence[ViewReport]) -> list[str]:
    """A line for each photograph without a camera.

    Args:
        report: An entry for each photograph.
    """
    return [f"{one_line(entry.name)} has no camera: {entry.reason}" for entry in report if not entry.registered]


def solved_lens(camera: Any, known: KnownLens | None) -> KnownLens:
    """The lens of a pycolmap.Camera.

    Args:
        camera: As `map_views` left it.
        known: The lens, if it was not refined.
    """
    if known is not None:
        return known
    focal, cx, cy, k = (float(v) for v in camera.params)
    lens = Lens("brown", (k, 0.0, 0.0, 0.0, 0.0))
    return KnownLens(np.array([[focal, 0, cx], [0, focal, cy], [0, 0, 1.0]]), None if lens.is_identity else lens)


def solved_camera(lens: KnownLens, cam_from_world: Any, shot: Shot) -> Camera:
    """The camera of a photograph.

    Args:
        cam_from_world: Its pycolmap.Rigid3d.
    """
    pose = np.asarray(cam_from_world.matrix())
    return Camera.from_matrices(lens.K, pose[:, :3], pose[:, 3], shot.width, shot.height, shot.name)


def _points(model: SparseModel, chosen: Sequence[int], features: Sequence[Features]) -> SparsePoints:
    """COLMAP's points in the order of their numbers."""
    place = {index: position for position, index in enumerate(chosen)}
    ids = sorted(model.reconstruction.point3D_ids())
    positions = np.zeros((len(ids), 3))
    seen: list[tuple[int, int, int]] = []
    for row, point_id in enumerate(ids):
        point = model.reconstruction.point3D(point_id)
        positions[row] = point.xyz
        track = {(e.image_id - 1, e.point2D_idx) for e in point.track.elements}
        seen += sorted((row, index, feature) for index, feature in track if index in place)
    rows, views, numbers = np.array(seen, np.int64).reshape(-1, 3).T
    pixels = np.array([features[i].points[k] for i, k in zip(views, numbers, strict=True)]).reshape(-1, 2)
    shades = np.array([features[i].colours[k] for i, k in zip(views, numbers, strict=True)], np.float64).reshape(-1, 3)
    count = np.maximum(np.bincount(rows, minlength=len(ids)), 1)
    sums = np.column_stack([np.bincount(rows, weights=shades[:, c], minlength=len(ids)) for c in range(3)])
    colours = np.rint(sums / count[:, None]).astype(np.uint8)
    where = np.array([place[int(i)] for i in views], np.int64)
    return SparsePoints(positions, colours, np.zeros(len(ids)), rows, where, pixels)


def _reprojection_errors(
    points: SparsePoints, cameras: Sequence[Camera], lenses: Sequence[KnownLens]
) -> NDArray[np.float64]:
    """(m,) pixels between each observation and the projection of its point."""
    errors = np.zeros(len(points.view))
    for index, (camera, known) in enumerate(zip(cameras, lenses, strict=True)):
        here = points.view == index
        local = points.positions[points.point[here]] @ camera.R.T + camera.t
        pixels = distort_to_pixels(local[:, :2] / local[:, 2:], known)
        errors[here] = np.linalg.norm(pixels - points.pixels[here], axis=1)
    return errors
