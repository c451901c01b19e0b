"""Photographs that are copies of the same file."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

from eigenfield.capture.messages import list_names
from eigenfield.core.errors import CaptureError
from eigenfield.runtime.parallel import parallel_map
from eigenfield.runtime.stages import file_digest


def find_duplicates(paths: Sequence[Path]) -> list[list[str]]:
    """The names of each group of files with the same bytes; only files of the same length are read."""
    by_length: dict[int, list[Path]] = defaultdict(list)
    for path in paths:
        by_length[path.stat().st_size].append(path)
    suspects = [path for alike in by_length.values() if len(alike) > 1 for path in alike]
    by_bytes: dict[str, list[str]] = defaultdict(list)
    for path, digest in zip(suspects, parallel_map(file_digest, suspects), strict=True):
        by_bytes[digest].append(path.name)
    return [names for names in by_bytes.values() if len(names) > 1]


def describe_duplicates(groups: Sequence[Sequence[str]]) -> list[str]:
    """A line for people for each group of the same photograph."""
    return [f"{len(names)} photographs are the same file, byte for byte: {list_names(names)}" for names in groups]


def refuse_duplicates(groups: Sequence[Sequence[str]], photographs: int, fewest: int, root: Path) -> None:
    """Raise CaptureError `photographs-same` where fewer than `fewest` of the photographs differ."""
    different = photographs - sum(len(names) - 1 for names in groups)
    if groups and different < fewest:
        raise CaptureError(
            "photographs-same",
            f"{len(groups[0])} of {photographs} photographs are the same file: of {fewest} that must differ there are "
            f"{different}",
            path=root,
            remedy="copy the photographs of the other cameras there again",
        )
