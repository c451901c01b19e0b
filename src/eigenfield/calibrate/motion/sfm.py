"""Structure from motion: cameras and sparse points from photographs alone.

    features ─▶ pairs ─▶ verified matches ─▶ incremental mapping ─▶ the natural gauge ─▶ Motion

Photographs that find no place are left out and named with the reason. The same photographs, options and seed give the
same cameras at any number of threads.
"""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.align import moved_camera, natural_gauge
from eigenfield.calibrate.lenses import KnownLens, distorted, undistorted
from eigenfield.calibrate.motion.colmap_core import pycolmap
from eigenfield.calibrate.motion.features import Features
from eigenfield.calibrate.motion.keep import kept_features, kept_matches
from eigenfield.calibrate.motion.mapping import SMALLEST_MODEL, Model, map_views
from eigenfield.calibrate.motion.matching import FEWEST_INLIERS, Match, Matching, check_matching
from eigenfield.capture.calibration import printable
from eigenfield.capture.lightfield import LightField
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.capture.points import SparsePoints
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.progress import Progress
from eigenfield.runtime.stages import Stages

log = logging.getLogger("eigenfield.calibrate")

FEWEST_FEATURES = 60  # below, a photograph is called blurred or bare
NOMINAL_FOCAL = 1.2  # of the longer side, where nothing says a focal length
NAMED = 5  # names that a line lists
NO_FEATURES: Features = Features(
    np.zeros((0, 2)), np.zeros(0, np.float32), np.zeros((0, 128), np.uint8), np.zeros((0, 3), np.uint8)
)


@dataclass(frozen=True)
class ViewReport:
    """What became of one photograph.

    registered: whether it has a camera now. reason: why not, for people; code: the same for scripts: "unreadable",
        "few-features", "few-matches", "apart" (matches only others that have no camera), "no-pose" (matches, but no
        pose explains them); both empty where it is registered.
    features: found in it. partners: photographs that it shares verified matches with.
    observations: points of the scene seen in it. error: mean reprojection error in pixels, None where not registered.
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
class Motion:
    """The result of structure from motion.

    light_field: the registered photographs with cameras and lenses, in the order of the set; those left out are named
        in its problems. World: `natural_gauge`, the mean of the cameras at the origin, axes as theirs on average, the
        median distance to the nearest camera the unit.
    points: what was triangulated; its views count the light field's.
    report: one entry for each photograph of the set, in order.
    """

    light_field: LightField
    points: SparsePoints
    report: tuple[ViewReport, ...]


def structure_from_motion(
    photos: PhotoSet,
    *,
    intrinsics: KnownLens | Sequence[KnownLens] | None = None,
    camera_per_photo: bool = False,
    matching: Matching = "auto",
    work: Path | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Motion:
    """Find the cameras of `photos`, and points of the scene.

    intrinsics: known ones, for all or one for each photograph: they are kept as they are. Without, a focal length and
        one radial coefficient are estimated for each group of photographs of one size and one EXIF focal length.
    camera_per_photo: estimate them for each photograph alone.
    matching: which photographs are compared; see `matching.choose_pairs`.
    work: a folder that keeps features and matches for the next run.

    Raises CaptureError: `too-few` photographs, `planar-rectified` (a two-plane capture has no perspective in which the
    cameras could be told), `calibration-failed` (fewer than three fit together; the message says why); OptionError.
    """
    known = _known(intrinsics, photos)
    _refuse(photos)
    check_matching(matching, photos.layout)
    stages = None if work is None else Stages(work)
    found, key = kept_features(stages, photos, progress)
    flat, features = _flattened([f if isinstance(f, Features) else NO_FEATURES for f in found], known)
    cameras, shared = _cameras(photos.shots, known, camera_per_photo)
    each = [cameras[k] for k in shared]
    matches = kept_matches(stages, key, photos, flat, each, known, matching, seed, progress)
    model = map_views([f.points for f in flat], cameras, shared, matches, known is not None, seed, progress)
    report = _report(photos, found, matches, model)
    if model is None:
        raise _failed(photos, report)
    return _motion(photos, features, flat, known, model, report)


def _known(intrinsics: KnownLens | Sequence[KnownLens] | None, photos: PhotoSet) -> list[KnownLens] | None:
    if intrinsics is None:
        return None
    known = [intrinsics] * len(photos) if isinstance(intrinsics, KnownLens) else list(intrinsics)
    if len(known) != len(photos):
        raise OptionError(
            "intrinsics-count", f"{len(known)} intrinsics for {len(photos)} photographs", remedy="give one for each"
        )
    return known


def _refuse(photos: PhotoSet) -> None:
    if len(photos) < SMALLEST_MODEL:
        raise CaptureError(
            "too-few",
            f"holds {len(photos)} photograph{'' if len(photos) == 1 else 's'}, {SMALLEST_MODEL} are needed",
            path=photos.root,
            remedy="name a folder with more photographs of the scene",
        )
    if photos.layout is not None and photos.layout.rectified:
        raise CaptureError(
            "planar-rectified",
            "is a rectified grid: its photographs share one plane, and structure from motion cannot tell their cameras",
            path=photos.root,
            remedy="use `eigenfield encode`, which takes the cameras from the grid",
        )


def _flattened(
    features: Sequence[Features], known: Sequence[KnownLens] | None
) -> tuple[list[Features], list[Features]]:
    """The features as pinholes see them, and as the photographs show them; those beyond the lens are left out."""
    if known is None:
        return list(features), list(features)
    flat, seen = [], []
    for f, lens in zip(features, known, strict=True):
        points = undistorted(f.points, lens)
        good = np.asarray(np.isfinite(points).all(axis=1))
        seen.append(f.subset(good))
        flat.append(f.subset(good).at(points[good]))
    return flat, seen


def _cameras(
    shots: Sequence[Shot], known: Sequence[KnownLens] | None, camera_per_photo: bool
) -> tuple[list[Any], list[int]]:
    """COLMAP's cameras, and each photograph's."""
    cameras: list[Any] = []
    number: dict[Any, int] = {}
    shared = []
    for index, shot in enumerate(shots):
        key: Any = (shot.width, shot.height)
        if known is not None:
            K = known[index].K
            key = (*key, K[0, 0], K[1, 1], K[0, 2], K[1, 2])
        else:
            key = (*key, shot.focal, index if camera_per_photo else None)
        if key not in number:
            number[key] = len(cameras)
            cameras.append(_camera(shot, None if known is None else known[index].K))
        shared.append(number[key])
    return cameras, shared


def _camera(shot: Shot, K: NDArray[np.float64] | None) -> Any:
    if K is not None:
        camera = pycolmap.Camera(
            model="PINHOLE", width=shot.width, height=shot.height, params=[K[0, 0], K[1, 1], K[0, 2], K[1, 2]]
        )
    else:
        focal = NOMINAL_FOCAL * max(shot.width, shot.height) if shot.focal is None else shot.focal
        camera = pycolmap.Camera(
            model="SIMPLE_RADIAL",
            width=shot.width,
            height=shot.height,
            params=[focal, shot.width / 2, shot.height / 2, 0.0],
        )
    camera.has_prior_focal_length = K is not None or shot.focal is not None
    return camera


# what became of each photograph


def _report(
    photos: PhotoSet, found: Sequence[Features | CaptureError], matches: Sequence[Match], model: Model | None
) -> list[ViewReport]:
    registered = set() if model is None else set(model.registered)
    partners: list[dict[int, int]] = [{} for _ in photos.shots]
    for match in matches:
        if match.inliers:
            partners[match.first][match.second] = match.inliers
            partners[match.second][match.first] = match.inliers
    report = []
    for index, (shot, features) in enumerate(zip(photos.shots, found, strict=True)):
        count = len(features) if isinstance(features, Features) else 0
        if index in registered:
            code, reason = "", ""
        elif isinstance(features, CaptureError):
            code, reason = "unreadable", str(features)
        else:
            code, reason = _why(index, count, partners[index], registered, photos.names, model)
        report.append(ViewReport(shot.name, index in registered, code, reason, count, len(partners[index]), 0, None))
    return report


def _why(
    index: int,
    features: int,
    partners: dict[int, int],
    registered: set[int],
    names: Sequence[str],
    model: Model | None,
) -> tuple[str, str]:
    if features < FEWEST_FEATURES:
        return "few-features", f"too few features ({features}): blurred, dark, masked or without texture"
    if not partners:
        return (
            "few-matches",
            f"too few matches: of {features} features fewer than {FEWEST_INLIERS} agree with any other photograph; "
            "another scene, or taken from too far aside",
        )
    best = max(partners, key=lambda j: (partners[j], -j))
    if not registered & partners.keys():
        company = next((o for o in (() if model is None else model.others) if index in o), ())
        return "apart", (
            f"no view to register against: it matches only {_some([names[j] for j in sorted(partners)])}"
            + (f", a group of {len(company)} apart from the rest" if company else ", which have no camera either")
        )
    return "no-pose", (
        f"residual too large: it matches {_some([names[j] for j in sorted(partners)])} (best {printable(names[best])}, "
        f"{partners[best]} features), but no pose explains enough points"
    )


def _some(names: Sequence[str]) -> str:
    shown = ", ".join(printable(name) for name in names[:NAMED])
    return shown if len(names) <= NAMED else f"{shown} and {len(names) - NAMED} more"


def _failed(photos: PhotoSet, report: Sequence[ViewReport]) -> CaptureError:
    code, number = Counter(entry.code for entry in report).most_common(1)[0]
    of = f"{number} of {len(report)} photographs"
    why, remedy = {
        "unreadable": (f"{of} cannot be read", "copy them again"),
        "few-features": (
            f"{of} have too few features (blurred, dark, masked or without texture)",
            "take sharper photographs of a textured scene",
        ),
        "few-matches": (
            f"{of} share too little with any other",
            "take photographs that overlap, a few degrees apart",
        ),
    }.get(code, (f"{of} match others, but no cameras explain the matches", "give the lens with --intrinsics, or take "
                 "more photographs from places further apart"))  # fmt: skip
    if not code.startswith(("unreadable", "few")) and _perhaps_a_grid(photos):
        remedy = f"if the photographs are a rectified grid, say --grid RxC (rows x columns); else {remedy}"
    return CaptureError(
        "calibration-failed", f"no {SMALLEST_MODEL} photographs fit together: {why}", path=photos.root, remedy=remedy
    )


def _perhaps_a_grid(photos: PhotoSet) -> bool:
    """Whether nothing speaks against a grid: no layout is known, one size, and a number with two factors."""
    sizes = {(shot.width, shot.height) for shot in photos.shots}
    return (
        photos.layout is None and len(sizes) == 1 and any(len(photos) % k == 0 for k in range(2, 1 + len(photos) // 2))
    )


# the result in our own terms


def _motion(
    photos: PhotoSet,
    features: Sequence[Features],
    flat: Sequence[Features],
    known: Sequence[KnownLens] | None,
    model: Model,
    report: Sequence[ViewReport],
) -> Motion:
    chosen = list(model.registered)
    lenses, cameras = [], []
    for index in chosen:
        lens, camera = _solved(
            model.reconstruction.image(index + 1), photos.shots[index], None if known is None else known[index]
        )
        lenses.append(lens)
        cameras.append(camera)
    points = _points(model, chosen, features)
    scale, R, t = natural_gauge(cameras)
    cameras = [moved_camera(camera, scale, R, t) for camera in cameras]
    points = points.moved(scale, R, t)
    errors = _errors(points, cameras, lenses)
    points = points.with_errors(errors)
    by_view = np.bincount(points.view, minlength=len(chosen))
    sums = np.bincount(points.view, weights=errors, minlength=len(chosen))
    entries = list(report)
    for place, index in enumerate(chosen):
        entry = entries[index]
        entries[index] = ViewReport(
            entry.name, True, "", "", entry.features, entry.partners, int(by_view[place]),
            float(sums[place] / max(by_view[place], 1)),
        )  # fmt: skip
    problems = [f"{printable(e.name)} has no camera: {e.reason}" for e in entries if not e.registered]
    log.info("%d of %d photographs have a camera", len(chosen), len(photos))
    light_field = photos.subset(chosen).calibrated(cameras, [lens.lens for lens in lenses], problems)
    return Motion(light_field, points, tuple(entries))


def _solved(image: Any, shot: Shot, known: KnownLens | None) -> tuple[KnownLens, Camera]:
    if known is None:
        focal, cx, cy, k = (float(v) for v in image.camera.params)
        lens = Lens("brown", (k, 0.0, 0.0, 0.0, 0.0))
        known = KnownLens(np.array([[focal, 0, cx], [0, focal, cy], [0, 0, 1.0]]), None if lens.does_nothing else lens)
    pose = np.asarray(image.cam_from_world().matrix())
    return known, Camera.checked(known.K, pose[:, :3], pose[:, 3], shot.width, shot.height, shot.name)


def _points(model: Model, chosen: Sequence[int], features: Sequence[Features]) -> SparsePoints:
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


def _errors(points: SparsePoints, cameras: Sequence[Camera], lenses: Sequence[KnownLens]) -> NDArray[np.float64]:
    """(m,) pixels between where each point was seen and where its camera shows it."""
    errors = np.zeros(len(points.view))
    for index, (camera, known) in enumerate(zip(cameras, lenses, strict=True)):
        here = points.view == index
        local = points.positions[points.point[here]] @ camera.R.T + camera.t
        pixels = distorted(local[:, :2] / local[:, 2:], known)
        errors[here] = np.linalg.norm(pixels - points.pixels[here], axis=1)
    return errors
