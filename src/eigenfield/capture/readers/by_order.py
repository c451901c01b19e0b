"""Calibrations that name no photograph: their entries go with the photographs of a folder in name order."""

from __future__ import annotations

import os
import re
from pathlib import Path

from eigenfield.capture.locate import photographs_in
from eigenfield.capture.photographs.kinds import may_be_renamed
from eigenfield.core.errors import CaptureError

# LLFF's images_4, images_8: the same photographs, so many times smaller
REDUCED_IMAGES_FOLDER = re.compile(r"images_(\d+)")


def photographs_in_order(root: Path, count: int, path: Path) -> list[str]:
    """Names of photographs relative to `root`, sorted as plain text: from `images`, else the least reduced `images_N`,
    else `root` itself, whichever holds exactly `count`.

    Raises:
        CaptureError: `calibration-count` where no folder fits.
    """
    seen = []
    for folder in _candidate_folders(root):
        names = sorted(photograph.name for photograph in photographs_in(root / folder))
        usual = [name for name in names if not may_be_renamed(name)]
        for chosen in (usual, names):  # others among them may be copies and posters
            if len(chosen) == count:
                return [f"{folder}/{name}" if folder else name for name in chosen]
        if names:
            seen.append(f"{len(names)} in {folder or root.name or 'the folder'}")
    raise CaptureError(
        "calibration-count",
        f"has {count} cameras and names no photograph, but there are {', '.join(seen) or 'none'}",
        path=path,
        remedy="put exactly its photographs into images/: they are taken in the order of their names",
    )


def _candidate_folders(root: Path) -> list[str]:
    reduced = []
    if root.is_dir():
        with os.scandir(root) as entries:
            for entry in entries:
                match = REDUCED_IMAGES_FOLDER.fullmatch(entry.name)
                if match and entry.is_dir():
                    reduced.append((len(match[1]), match[1], entry.name))
    return ["images", *(name for _, _, name in sorted(reduced)), ""]
