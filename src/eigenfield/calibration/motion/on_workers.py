"""Features and matches that workers find: a task has a few photographs, or a few pairs of them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from eigenfield.calibration.motion.features import NO_FEATURES, FeatureOptions, Features, extract_here
from eigenfield.calibration.motion.matching import Match, Pair, match_pairs
from eigenfield.calibration.motion.stored import (
    MATCHES_FILE,
    read_features,
    read_matches,
    write_features,
    write_matches,
)
from eigenfield.capture.photoset import Shot
from eigenfield.core.errors import CaptureError
from eigenfield.core.progress import Progress, track
from eigenfield.runtime.parallel import pieces
from eigenfield.runtime.parts import Parts
from eigenfield.runtime.shared import Shared, share

PHOTOGRAPHS_A_TASK = 4
PAIRS_A_TASK = 32
# Measured: 0.89 GB for four photographs of half a megapixel, 3.09 for four of twelve
PROGRAM_MEMORY_BYTES, PHOTOGRAPH_MEMORY_BYTES, PIXEL_MEMORY_BYTES = 0.25e9, 0.18e9, 48.0
MATCHES_MEMORY_BYTES = 1.3e9  # measured: 6,000 features each, 16 threads; 0.4 with one


def extract_on_workers(
    parts: Parts, shots: Sequence[Shot], options: FeatureOptions, stage: str, progress: Progress | None
) -> list[Features | CaptureError]:
    """As `extract_here`, with the same features."""
    groups = [shots[first:last] for first, last in pieces(len(shots), PHOTOGRAPHS_A_TASK)]
    most = max((sum(shot.width * shot.height for shot in group) for group in groups), default=0)
    memory = PROGRAM_MEMORY_BYTES + PHOTOGRAPHS_A_TASK * PHOTOGRAPH_MEMORY_BYTES + PIXEL_MEMORY_BYTES * most
    made = parts.make(stage.replace(" ", "-"), build_features, [(group, options) for group in groups], memory)
    found = track(made, stage, len(groups), progress)
    return [each for folder, group in zip(found, groups, strict=True) for each in read_features(folder, group)]


def build_features(folder: Path, shots: Sequence[Shot], options: FeatureOptions) -> None:
    """Write the features of photographs, on a worker."""
    write_features(folder, extract_here(shots, options, "features", None))


def match_on_workers(
    parts: Parts,
    features: Sequence[Features],
    cameras: Sequence[Any],
    pairs: Sequence[Pair],
    seed: int,
    progress: Progress | None,
    name: str = "matches",
) -> list[Match]:
    """As `match_pairs`, with the same matches.

    Args:
        name: Of the parts: each list of pairs has its own.
    """
    groups = [pairs[first:last] for first, last in pieces(len(pairs), PAIRS_A_TASK)]
    with share(zip(features, cameras, strict=True), parts.folder) as shared:
        made = parts.make(name, build_matches, [(shared, group, seed) for group in groups], MATCHES_MEMORY_BYTES)
        found = track(made, "matches", len(groups), progress)
        return [match for folder in found for match in read_matches(folder / MATCHES_FILE)]


def build_matches(
    folder: Path, shared: Sequence[Shared[tuple[Features, Any]]], pairs: Sequence[Pair], seed: int
) -> None:
    """Write the matches of pairs, on a worker.

    Args:
        folder: That takes the file.
        shared: Features and camera of each photograph.
        pairs: Pairs (i, j), i < j.
    """
    needed = {index for pair in pairs for index in pair}
    photographs = [each.value() if index in needed else (NO_FEATURES, None) for index, each in enumerate(shared)]
    features, cameras = zip(*photographs, strict=True)
    write_matches(folder / MATCHES_FILE, match_pairs(features, cameras, pairs, seed))
