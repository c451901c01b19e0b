"""Structure from motion: cameras and sparse points from photographs alone.

    features ─▶ pairs ─▶ verified matches ─▶ incremental mapping ─▶ the natural gauge ─▶ SfmResult

Photographs that cannot be registered are left out and listed with the reason. The same photographs, options and seed
give the same cameras at any number of threads.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.lenses import KnownLens
from eigenfield.calibration.motion.cache import cached_features, cached_matches
from eigenfield.calibration.motion.colmap_core import pycolmap
from eigenfield.calibration.motion.features import NO_FEATURES, Features, join_features, undistort_features
from eigenfield.calibration.motion.mapping import MAPPING_MIN_VIEWS, SparseModel, map_views
from eigenfield.calibration.motion.matching import (
    MATCHING_MIN_INLIERS,
    Match,
    Matching,
    check_matching,
    choose_pairs,
    match_pairs,
)
from eigenfield.calibration.motion.on_workers import match_on_workers
from eigenfield.calibration.motion.register import register_photographs
from eigenfield.calibration.motion.result import SfmResult, ViewReport, assemble
from eigenfield.capture.messages import count_phrase, list_names
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.core.errors import CaptureError, OptionError, one_line
from eigenfield.core.progress import Progress
from eigenfield.runtime.parts import Parts
from eigenfield.runtime.stages import Stages, stage_key

T = TypeVar("T")

SFM_MIN_FEATURES = 60  # with fewer, a photograph is called blurred or textureless
SFM_NOMINAL_FOCAL_SIDES = 1.2  # of the longer side, if no focal length is known


def structure_from_motion(
    photos: PhotoSet,
    *,
    intrinsics: KnownLens | Sequence[KnownLens] | None = None,
    camera_per_photo: bool = False,
    matching: Matching = "auto",
    work: Path | None = None,
    seed: int = 0,
    parts: Parts | None = None,
    progress: Progress | None = None,
    blind: Collection[int] = (),
    also: Sequence[PhotoSet] = (),
) -> SfmResult:
    """Estimate the cameras of photographs, and points of the scene.

    Args:
        intrinsics: Known ones, for all or for each photograph; they are not refined. Without, a focal length and one
            radial coefficient are estimated for each group of photographs of one size and EXIF focal length.
        camera_per_photo: Estimate them for each photograph separately.
        matching: Which photographs are compared; see `choose_pairs`.
        work: A folder that stores features and matches for the next run.
        parts: Workers that find features and compare pairs; None: this process does.
        blind: Indices of photographs that take no part in cameras and points: each only registers its own camera.
        also: The same cameras at other instants, in the same order, whose features are joined to those of `photos`.

    Raises:
        CaptureError: `too-few`: too few photographs. `planar-rectified`: a two-plane capture, which has no perspective
            that determines the cameras. `calibration-failed`: fewer than three fit together; the message says why.
        OptionError: As `check_matching`; `intrinsics-count`.
    """
    known = _check_intrinsics(intrinsics, photos)
    out = frozenset(blind)
    shown = [index for index in range(len(photos)) if index not in out]
    part = photos.subset(shown)
    _check_photographs(part)
    check_matching(matching, part.layout)
    stages = None if work is None else Stages(work)
    found, key = cached_features(stages, photos, parts, progress, sorted(out))
    if also:
        instants = [(found, key), *(cached_features(stages, one, parts, progress, sorted(out)) for one in also)]
        found = [_joined(one) for one in zip(*(each for each, _ in instants), strict=True)]
        key = stage_key([own for _, own in instants])
    undistorted, features = _undistort_features([f if isinstance(f, Features) else NO_FEATURES for f in found], known)
    cameras, shared = _cameras(photos.shots, known, camera_per_photo, [*shown, *sorted(out)])
    each = [cameras[k] for k in shared]

    def of_part(values: Sequence[T]) -> list[T]:
        return [values[index] for index in shown]

    lenses = None if known is None else of_part(known)
    seen, own = of_part(undistorted), of_part(shared)
    matches = cached_matches(stages, key, part, seen, of_part(each), lenses, matching, seed, parts, progress)
    model = map_views(
        [f.points for f in seen], cameras[: max(own) + 1], own, matches, known is not None, seed, progress
    )
    report = _report(part, of_part(found), matches, model)
    if model is None:
        raise _failure_error(part, report, matches)
    motion = assemble(part, of_part(features), lenses, model, report)
    if not out:
        return motion
    registered = {shown[index] for index in model.registered}
    pairs = [
        pair for pair in choose_pairs(undistorted, matching, photos.layout, progress)
        if len(registered.intersection(pair)) == 1 and len(out.intersection(pair)) == 1
    ]  # fmt: skip
    match = match_pairs if parts is None else partial(match_on_workers, parts, name="held-out")
    matches = match(undistorted, each, pairs, seed, progress)
    waiting = {index: _blind_report(index, photos, found[index], matches) for index in sorted(out)}
    return register_photographs(photos, motion, model, shown, undistorted, each, known, matches, waiting, seed)


def _joined(instants: Sequence[Features | CaptureError]) -> Features | CaptureError:
    """What a camera shows at all of its instants; the first one's error where it can be read at none."""
    seen = [one for one in instants if isinstance(one, Features)]
    return join_features(seen) if seen else instants[0]


def _check_intrinsics(intrinsics: KnownLens | Sequence[KnownLens] | None, photos: PhotoSet) -> list[KnownLens] | None:
    if intrinsics is None:
        return None
    known = [intrinsics] * len(photos) if isinstance(intrinsics, KnownLens) else list(intrinsics)
    if len(known) != len(photos):
        raise OptionError(
            "intrinsics-count", f"{len(known)} intrinsics for {len(photos)} photographs", remedy="give one for each"
        )
    return known


def _check_photographs(photos: PhotoSet) -> None:
    if len(photos) < MAPPING_MIN_VIEWS:
        raise CaptureError(
            "too-few",
            f"holds {count_phrase(photos.shots, 'photograph', 'photographs')}, {MAPPING_MIN_VIEWS} are needed",
            path=photos.root,
            remedy="name a folder with more photographs of the scene",
        )
    if photos.layout is not None and photos.layout.rectified:
        raise CaptureError(
            "planar-rectified",
            "is a rectified grid: its photographs share one plane, and structure from motion cannot tell their cameras",
            path=photos.root,
            remedy="use `eigenfield encode CAPTURE -o scene.glb`, which takes the cameras from the grid",
        )


def _undistort_features(
    features: Sequence[Features], known: Sequence[KnownLens] | None
) -> tuple[list[Features], list[Features]]:
    """The features as pinholes see them, and as the photographs show them; those beyond the lens are dropped."""
    if known is None:
        return list(features), list(features)
    both = [undistort_features(f, lens) for f, lens in zip(features, known, strict=True)]
    return [undistorted for undistorted, _ in both], [seen for _, seen in both]


def _cameras(
    shots: Sequence[Shot], known: Sequence[KnownLens] | None, camera_per_photo: bool, order: Sequence[int]
) -> tuple[list[Any], list[int]]:
    """COLMAP's cameras, in the order in which photographs of `order` need them, and the index of each photograph's."""
    cameras: list[Any] = []
    number: dict[Any, int] = {}
    shared = [0] * len(shots)
    for index in order:
        shot = shots[index]
        key: Any = (shot.width, shot.height)
        if known is not None:
            K = known[index].K
            key = (*key, K[0, 0], K[1, 1], K[0, 2], K[1, 2])
        else:
            key = (*key, shot.focal, index if camera_per_photo else None)
        if key not in number:
            number[key] = len(cameras)
            cameras.append(_camera(shot, None if known is None else known[index].K))
        shared[index] = number[key]
    return cameras, shared


def _camera(shot: Shot, K: NDArray[np.float64] | None) -> Any:
    if K is not None:
        model, params = "PINHOLE", [K[0, 0], K[1, 1], K[0, 2], K[1, 2]]
    else:
        focal = SFM_NOMINAL_FOCAL_SIDES * max(shot.width, shot.height) if shot.focal is None else shot.focal
        model, params = "SIMPLE_RADIAL", [focal, shot.width / 2, shot.height / 2, 0.0]
    camera = pycolmap.Camera(model=model, width=shot.width, height=shot.height, params=params)
    camera.has_prior_focal_length = K is not None or shot.focal is not None
    return camera


# the outcome for each photograph


def _report(
    photos: PhotoSet, found: Sequence[Features | CaptureError], matches: Sequence[Match], model: SparseModel | None
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
            code, reason = _failure_reason(index, count, partners[index], photos.names, model)
        report.append(ViewReport(shot.name, index in registered, code, reason, count, len(partners[index]), 0, None))
    return report


def _blind_report(
    index: int, photos: PhotoSet, features: Features | CaptureError, matches: Sequence[Match]
) -> ViewReport:
    """What is said of a photograph that took no part, if its camera is not found."""
    name = photos.names[index]
    partners = sum(index in (match.first, match.second) for match in matches if match.inliers)
    if isinstance(features, CaptureError):
        return ViewReport(name, False, "unreadable", str(features), 0, 0, 0, None)
    code, why = "no-pose", "no pose explains enough points of the photographs that took part"
    if len(features) < SFM_MIN_FEATURES:
        code, why = "few-features", f"too few features ({len(features)}): blurred, dark, masked or without texture"
    elif not partners:
        code, why = "few-matches", "too few matches with the photographs that took part"
    return ViewReport(name, False, code, f"held out, and {why}", len(features), partners, 0, None)


def _failure_reason(
    index: int, features: int, partners: dict[int, int], names: Sequence[str], model: SparseModel | None
) -> tuple[str, str]:
    if features < SFM_MIN_FEATURES:
        return "few-features", f"too few features ({features}): blurred, dark, masked or without texture"
    if not partners:
        return (
            "few-matches",
            f"too few matches: of {features} features fewer than {MATCHING_MIN_INLIERS} agree with any other "
            "photograph; another scene, or taken from too far aside",
        )
    best = max(partners, key=lambda j: (partners[j], -j))
    matched = list_names([names[j] for j in sorted(partners)])
    if model is None or not set(model.registered) & partners.keys():
        company = next((o for o in (() if model is None else model.separate) if index in o), ())
        return "apart", (
            f"no view to register against: it matches only {matched}"
            + (f", a group of {len(company)} apart from the rest" if company else ", which have no camera either")
        )
    return "no-pose", (
        f"residual too large: it matches {matched} (best {one_line(names[best])}, {partners[best]} features), "
        "but no pose explains enough points"
    )


def _failure_error(photos: PhotoSet, report: Sequence[ViewReport], matches: Sequence[Match]) -> CaptureError:
    code, number = Counter(entry.code for entry in report).most_common(1)[0]
    of = f"{number} of {len(report)} photographs"
    masked = any(shot.mask is not None for shot in photos.shots)
    why, remedy = {
        "unreadable": (f"{of} cannot be read", "copy them again"),
        "few-features": (
            f"{of} have too few features (blurred, dark, masked or without texture)",
            "look at the masks: white counts, black is left out" if masked
            else "take sharper photographs of a textured scene",
        ),
        "few-matches": (f"{of} share too little with any other", "take photographs that overlap, a few degrees apart"),
    }.get(code, (f"{of} match others, but no cameras explain the matches", "give the lens with --intrinsics, or take "
                 "more photographs from places further apart"))  # fmt: skip
    has_matches = not code.startswith(("unreadable", "few"))
    if has_matches and _shows_no_depth(matches):
        why = "a turn of the camera explains what each two share, so that they show no depth"
        remedy = "step aside between photographs, and take more than one flat thing"
    if has_matches and _may_be_grid(photos):
        remedy = f"if the photographs are a rectified grid, say --grid RxC (rows x columns); else {remedy}"
    return CaptureError(
        "calibration-failed",
        f"no {MAPPING_MIN_VIEWS} photographs fit together: {why}",
        path=photos.root,
        remedy=remedy,
    )


def _shows_no_depth(matches: Sequence[Match]) -> bool:
    """Whether most pairs that match do so by a homography: seen from one place, or one plane."""
    kinds = pycolmap.TwoViewGeometryConfiguration
    flat = {int(kind) for kind in (kinds.PLANAR, kinds.PANORAMIC, kinds.PLANAR_OR_PANORAMIC)}
    known = [int(match.geometry.config) in flat for match in matches if match.geometry is not None]
    return 2 * sum(known) > len(known)


def _may_be_grid(photos: PhotoSet) -> bool:
    """Whether the photographs may be a grid: no layout is known, one size, and a number with two factors."""
    has_factors = any(len(photos) % k == 0 for k in range(2, 1 + len(photos) // 2))
    return photos.layout is None and len(set(photos.sizes)) == 1 and has_factors
