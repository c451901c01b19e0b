"""Features and matches as finished stages in a work folder, so that an interrupted run continues."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield.calibration.lenses import KnownLens
from eigenfield.calibration.motion.colmap_core import pycolmap
from eigenfield.calibration.motion.features import FeatureOptions, Features, extract_features, extract_features_of
from eigenfield.calibration.motion.matching import Match, Matching, choose_pairs, match_pairs
from eigenfield.capture.calibration import or_error
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.core.errors import CaptureError
from eigenfield.core.progress import Progress
from eigenfield.runtime.stages import Stages, file_digest, stage_key

MATCH_CACHE_FILE = "matches.npz"


def cached_features(
    stages: Stages | None, photos: PhotoSet, progress: Progress | None
) -> tuple[list[Features | CaptureError], str]:
    """As `extract_features`, loaded from the stage if it is finished.

    Args:
        stages: Finished stages; None: nothing is stored.
        photos: The photographs.
        progress: Called for each photograph.

    Returns:
        The features of every photograph, and the stage's key.
    """
    if stages is None:
        return extract_features(photos, None, progress), ""
    key = stage_key(["features", *(_identity(shot) for shot in photos.shots)])

    def build(folder: Path) -> None:
        for index, features in enumerate(extract_features(photos, None, progress)):
            if isinstance(features, Features):
                np.savez(_file(folder, index), **vars(features))

    folder = stages.run("features", key, build)
    return [_load(_file(folder, index), shot) for index, shot in enumerate(photos.shots)], key


def _identity(shot: Shot) -> list[Any]:
    """What a photograph's features depend on. A file that cannot be read is identified by that."""
    try:
        mask = None if shot.mask is None else file_digest(shot.mask)
        return [file_digest(shot.path), mask, shot.width, shot.height, shot.upright, shot.exposure]
    except OSError:
        return [str(shot.path), "unreadable"]


def _file(folder: Path, index: int) -> Path:
    return folder / f"{index:06d}.npz"


def _load(file: Path, shot: Shot) -> Features | CaptureError:
    if not file.is_file():  # it could not be read when the stage was built: repeat the reason
        return or_error(partial(extract_features_of, options=FeatureOptions()))(shot)
    with np.load(file) as stored:
        return Features(**stored)


def cached_matches(
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
    """As `match_pairs` over `choose_pairs`, loaded from the stage if it is finished.

    Args:
        stages: Finished stages; None: nothing is stored.
        features_key: The key of the features' stage.
        photos: The photographs.
        features: Of each photograph, undistorted.
        cameras: A pycolmap.Camera for each photograph.
        known: Known lenses, if any.
        matching: Which photographs are compared.
        seed: Of RANSAC.
        progress: Called for each pair.
    """

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
    folder = stages.run("matches", key, lambda place: _write_matches(place / MATCH_CACHE_FILE, compute()))
    return _read_matches(folder / MATCH_CACHE_FILE)


def _write_matches(path: Path, matches: Sequence[Match]) -> None:
    good = [match for match in matches if match.geometry is not None]
    kinds: dict[str, Any] = {
        name: np.array([_matrix(getattr(m.geometry, name)) for m in good]).reshape(-1, 3, 3) for name in "EFH"
    }
    np.savez(
        path,
        pairs=np.array([(m.first, m.second) for m in matches], np.int64).reshape(-1, 2),
        verified=np.array([m.geometry is not None for m in matches], bool),
        config=np.array([int(m.geometry.config) for m in good], np.int64),
        count=np.array([m.inliers for m in good], np.int64),
        inliers=np.concatenate([np.zeros((0, 2), np.uint32), *(np.asarray(m.geometry.inlier_matches) for m in good)]),
        **kinds,
    )


def _matrix(value: Any) -> Any:
    return np.full((3, 3), np.nan) if value is None else np.asarray(value)


def _read_matches(path: Path) -> list[Match]:
    with np.load(path) as file:
        stored = {name: file[name] for name in file.files}
    ends = np.cumsum(stored["count"])
    matches, number = [], 0
    for (first, second), verified in zip(stored["pairs"].tolist(), stored["verified"], strict=True):
        geometry = None
        if verified:
            geometry = pycolmap.TwoViewGeometry()
            geometry.config = int(stored["config"][number])
            geometry.inlier_matches = stored["inliers"][ends[number] - stored["count"][number] : ends[number]]
            for name in "EFH":
                if np.isfinite(stored[name][number]).all():
                    setattr(geometry, name, stored[name][number])
            number += 1
        matches.append(Match(first, second, geometry))
    return matches
