"""Features and matches as finished stages in a work folder, so that an interrupted run continues."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from eigenfield.calibration.lenses import KnownLens
from eigenfield.calibration.motion.features import Features, extract_features, extract_here
from eigenfield.calibration.motion.matching import Match, Matching, choose_pairs, match_pairs
from eigenfield.calibration.motion.on_workers import extract_on_workers, match_on_workers
from eigenfield.calibration.motion.stored import (
    MATCHES_FILE,
    read_features,
    read_matches,
    write_features,
    write_matches,
)
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.core.errors import CaptureError
from eigenfield.core.progress import Progress
from eigenfield.runtime.parts import Parts
from eigenfield.runtime.stages import Stages, file_digest, stage_key


def cached_features(
    stages: Stages | None,
    photos: PhotoSet,
    parts: Parts | None,
    progress: Progress | None,
    blind: Sequence[int] = (),
) -> tuple[list[Features | CaptureError], str]:
    """As `extract_features`, loaded from the stage if it is finished.

    Args:
        stages: Finished stages; None: nothing is stored.
        parts: Workers that find them; None: this process does.

    Returns:
        The features of every photograph, and the stage's key.
    """
    extract = extract_here if parts is None else partial(extract_on_workers, parts)
    if stages is None:
        return extract_features(photos, None, progress, extract, blind), ""
    key = stage_key(["features", list(blind), *(_identity(shot) for shot in photos.shots)])

    def build(folder: Path) -> None:
        write_features(folder, extract_features(photos, None, progress, extract, blind))

    folder = stages.run("features", key, build)
    return read_features(folder, photos.shots), key


def _identity(shot: Shot) -> list[Any]:
    """What a photograph's features depend on. A file that cannot be read is identified by that."""
    try:
        mask = None if shot.mask is None else file_digest(shot.mask)
        which = [] if shot.picture is None else shot.picture.identity()
        return [file_digest(shot.path), mask, shot.width, shot.height, shot.upright, shot.exposure, *which]
    except OSError:
        return [str(shot.path), "unreadable"]


def cached_matches(
    stages: Stages | None,
    features_key: str,
    photos: PhotoSet,
    features: Sequence[Features],
    cameras: Sequence[Any],
    known: Sequence[KnownLens] | None,
    matching: Matching,
    seed: int,
    parts: Parts | None,
    progress: Progress | None,
) -> list[Match]:
    """As `match_pairs` over `choose_pairs`, loaded from the stage if it is finished.

    Args:
        stages: Finished stages; None: nothing is stored.
        features: Of each photograph, undistorted.
        cameras: A pycolmap.Camera for each photograph.
        parts: Workers that compare the pairs; None: this process does.
    """

    def compute() -> list[Match]:
        pairs = choose_pairs(features, matching, photos.layout, progress)
        match = match_pairs if parts is None else partial(match_on_workers, parts)
        return match(features, cameras, pairs, seed, progress)

    if stages is None:
        return compute()
    layout = photos.layout
    key = stage_key([
        "matches", features_key, matching, seed, [[c.has_prior_focal_length, c.params.tolist()] for c in cameras],
        known and [[k.K.tolist(), k.lens and [k.lens.model, k.lens.coefficients]] for k in known],
        layout and [layout.rows.tolist(), layout.columns.tolist(), layout.positions.tolist(), layout.measured],
    ])  # fmt: skip
    folder = stages.run("matches", key, lambda place: write_matches(place / MATCHES_FILE, compute()))
    return read_matches(folder / MATCHES_FILE)
