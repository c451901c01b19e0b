"""Features and matches as finished stages in a work folder, so that a run that was cut short goes on."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield.calibrate.lenses import KnownLens
from eigenfield.calibrate.motion.colmap_core import pycolmap
from eigenfield.calibrate.motion.features import FeatureOptions, Features, extract_features, features_of
from eigenfield.calibrate.motion.matching import Match, Matching, choose_pairs, match_pairs
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.core.errors import CaptureError
from eigenfield.core.progress import Progress
from eigenfield.runtime.stages import Stages, file_digest, stage_key

MATCHES = "matches.npz"


def kept_features(
    stages: Stages | None, photos: PhotoSet, progress: Progress | None
) -> tuple[list[Features | CaptureError], str]:
    """As `extract_features`, and the stage's key; taken up from the stage where it is finished."""
    if stages is None:
        return extract_features(photos, None, progress), ""
    key = stage_key(["features", *(_identity(shot) for shot in photos.shots)])

    def build(folder: Path) -> None:
        for index, features in enumerate(extract_features(photos, None, progress)):
            if isinstance(features, Features):
                np.savez(
                    _file(folder, index),
                    points=features.points,
                    scales=features.scales,
                    descriptors=features.descriptors,
                    colours=features.colours,
                )

    folder = stages.run("features", key, build)
    return [_load(_file(folder, index), shot) for index, shot in enumerate(photos.shots)], key


def _identity(shot: Shot) -> list[Any]:
    """What a photograph's features depend on. A file that cannot be read is told apart by that."""
    try:
        mask = None if shot.mask is None else file_digest(shot.mask)
        return [file_digest(shot.path), mask, shot.width, shot.height, shot.upright]
    except OSError:
        return [str(shot.path), "unreadable"]


def _file(folder: Path, index: int) -> Path:
    return folder / f"{index:06d}.npz"


def _load(file: Path, shot: Shot) -> Features | CaptureError:
    if not file.is_file():  # it could not be read when the stage was built: say why once more
        try:
            return features_of(shot, FeatureOptions())
        except CaptureError as error:
            return error
    with np.load(file) as kept:
        return Features(kept["points"], kept["scales"], kept["descriptors"], kept["colours"])


def kept_matches(
    stages: Stages | None,
    features_key: str,
    photos: PhotoSet,
    features: Sequence[Features],
    cameras: Sequence[Any],
    known: Sequence[KnownLens] | None,
    matching: Matching,
    seed: int,
    progress: Progress | None,
) -> list[Match]:
    """As `match_pairs` over `choose_pairs`; taken up from the stage where it is finished."""

    def compute() -> list[Match]:
        pairs = choose_pairs(features, matching, photos.layout, progress)
        return match_pairs(features, cameras, pairs, seed, progress)

    if stages is None:
        return compute()
    layout = photos.layout
    key = stage_key([
        "matches", features_key, matching, seed, [[c.has_prior_focal_length, c.params.tolist()] for c in cameras],
        known and [[k.K.tolist(), k.lens and [k.lens.model, k.lens.coefficients]] for k in known],
        layout and [layout.rows.tolist(), layout.columns.tolist(), layout.positions.tolist(), layout.measured],
    ])  # fmt: skip
    folder = stages.run("matches", key, lambda place: _write(place / MATCHES, compute()))
    return _read(folder / MATCHES)


def _write(path: Path, matches: Sequence[Match]) -> None:
    good = [match for match in matches if match.geometry is not None]
    kinds: dict[str, Any] = {
        name: np.array([_matrix(getattr(m.geometry, name)) for m in good]).reshape(-1, 3, 3) for name in "EFH"
    }
    np.savez(
        path,
        pairs=np.array([(m.first, m.second, m.putative) for m in matches], np.int64).reshape(-1, 3),
        verified=np.array([m.geometry is not None for m in matches], bool),
        config=np.array([int(m.geometry.config) for m in good], np.int64),
        count=np.array([m.inliers for m in good], np.int64),
        inliers=np.concatenate([np.zeros((0, 2), np.uint32), *(np.asarray(m.geometry.inlier_matches) for m in good)]),
        **kinds,
    )


def _matrix(value: Any) -> Any:
    return np.full((3, 3), np.nan) if value is None else np.asarray(value)


def _read(path: Path) -> list[Match]:
    with np.load(path) as file:
        kept = {name: file[name] for name in file.files}
    ends = np.cumsum(kept["count"])
    matches, number = [], 0
    for (first, second, putative), verified in zip(kept["pairs"].tolist(), kept["verified"], strict=True):
        geometry = None
        if verified:
            geometry = pycolmap.TwoViewGeometry()
            geometry.config = int(kept["config"][number])
            geometry.inlier_matches = kept["inliers"][ends[number] - kept["count"][number] : ends[number]]
            for name in "EFH":
                if np.isfinite(kept[name][number]).all():
                    setattr(geometry, name, kept[name][number])
            number += 1
        matches.append(Match(first, second, putative, geometry))
    return matches
