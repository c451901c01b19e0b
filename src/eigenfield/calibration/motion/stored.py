"""Files of features and matches."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield.calibration.motion.colmap_core import pycolmap
from eigenfield.calibration.motion.features import FeatureOptions, Features, extract_features_of
from eigenfield.calibration.motion.matching import Match
from eigenfield.capture.calibration import or_error
from eigenfield.capture.photoset import Shot
from eigenfield.core.errors import CaptureError

MATCHES_FILE = "matches.npz"


def write_features(folder: Path, found: Sequence[Features | CaptureError]) -> None:
    """Write the features of photographs into a folder, a file each. A photograph that cannot be read has none.

    Args:
        found: Of each photograph, or its error.
    """
    for index, features in enumerate(found):
        if isinstance(features, Features):
            np.savez(_file(folder, index), **vars(features))


def read_features(folder: Path, shots: Sequence[Shot]) -> list[Features | CaptureError]:
    """The features that `write_features` wrote. Where there is no file, the photograph is read again for its error."""
    return [_read(_file(folder, index), shot) for index, shot in enumerate(shots)]


def _file(folder: Path, index: int) -> Path:
    return folder / f"{index:06d}.npz"


def _read(file: Path, shot: Shot) -> Features | CaptureError:
    if not file.is_file():
        return or_error(partial(extract_features_of, options=FeatureOptions()))(shot)
    with np.load(file) as stored:
        return Features(**stored)


def write_matches(path: Path, matches: Sequence[Match]) -> None:
    """Write matches to a file."""
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


def read_matches(path: Path) -> list[Match]:
    """The matches that `write_matches` wrote."""
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
