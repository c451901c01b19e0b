"""Calibrations that name no photograph: their entries go with the photographs of a folder in name order."""

from __future__ import annotations

import os
import re
from pathlib import Path

from eigenfield.capture.locate import photographs_in
from eigenfield.core.errors import CaptureError

REDUCED = re.compile(r"images_(\d+)")  # LLFF's images_4, images_8: the same photographs, so many times smaller


def photographs_in_order(root: Path, count: int, path: Path) -> list[str]:
    """Names of `count` photographs relative to `root`, sorted as plain text: from `images`, else the least reduced
    `images_N`, else `root` itself, whichever holds exactly `count`.

    path: the calibration, for the message. CaptureError `calibration-count` where no folder fits.
    """
    seen = []
    for folder in _folders(root):
        names = sorted(photograph.name for photograph in photographs_in(root / folder))
        if len(names) == count:
            return [f"{folder}/{name}" if folder else name for name in names]
        if names:
            seen.append(f"{len(names)} in {folder or root.name or 'the folder'}")
    raise CaptureError(
        "calibration-count",
        f"has {count} cameras and names no photograph, but there are {', '.join(seen) or 'none'}",
        path=path,
        remedy="put exactly its photographs into images/: they are taken in the order of their names",
    )


def _folders(root: Path) -> list[str]:
    reduced = []
    if root.is_dir():
        with os.scandir(root) as entries:
            for entry in entries:
                match = REDUCED.fullmatch(entry.name)
                if match and entry.is_dir():
                    reduced.append((len(match[1]), match[1], entry.name))
    return ["images", *(name for _, _, name in sorted(reduced)), ""]
