"""Circles excluded from a second set of scores: a glass ball, a mirror, anything that the surface cannot represent."""

from __future__ import annotations

import codecs
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import FormatError, OptionError
from eigenfield.gltf import strict_json


@dataclass(frozen=True)
class ExcludedCircle:
    """A circle of centre and radius in pixels; the centre of the top-left pixel is (0.5, 0.5)."""

    cx: float
    cy: float
    r: float

    def outside(self, width: int, height: int) -> NDArray[np.bool_]:
        """(H, W) bool: pixels whose centre is not within the circle."""
        x, y = np.arange(width) + (0.5 - self.cx), np.arange(height) + (0.5 - self.cy)
        return np.asarray(y[:, None] ** 2 + x**2 > self.r**2)


def read_circles(path: str | os.PathLike[str], names: Sequence[str]) -> dict[str, ExcludedCircle]:
    """The circle of each camera, from a JSON file {"circles": {photograph: {"cx", "cy", "r"}}}.

    A photograph is matched by its name, or else by its file name alone if that is unique. Cameras without a circle are
    absent from the result.

    Raises:
        OptionError: `circles-unreadable`, `circles-malformed` or `circles-unmatched`.
    """
    try:
        document = strict_json.parse(Path(path).read_bytes().removeprefix(codecs.BOM_UTF8), finite=False)
    except (OSError, ValueError, FormatError) as error:  # ValueError: a path with a null byte
        reason = (error.strerror or "cannot be read") if isinstance(error, OSError) else f"is no JSON: {error}"
        raise OptionError(
            "circles-unreadable", reason, path=path, remedy='give {"circles": {"a.jpg": {"cx": ...}}}'
        ) from error
    entries = document.get("circles") if isinstance(document, dict) else None
    if not isinstance(entries, dict):
        raise OptionError("circles-malformed", 'has no "circles" object', path=path, remedy="key circles by photograph")
    circles = {str(key).replace("\\", "/"): _parse_circle(key, entry, path) for key, entry in entries.items()}
    found = _match_circles(circles, names)
    if not found:
        raise OptionError(
            "circles-unmatched",
            f"none of its {len(circles)} circles belongs to a camera of the scene",
            path=path,
            remedy=f"key circles by the photographs' names, such as {names[0]}",
        )
    return found


def _parse_circle(key: str, entry: object, path: str | os.PathLike[str]) -> ExcludedCircle:
    values = [entry.get(field) for field in ("cx", "cy", "r")] if isinstance(entry, dict) else []
    numbers = [float(v) for v in values if isinstance(v, (int, float)) and not isinstance(v, bool) and abs(v) < 1e9]
    if len(numbers) != 3 or numbers[2] < 0:
        raise OptionError(
            "circles-malformed", f"the circle of {key} needs a finite cx, cy and r", path=path, remedy="mend its entry"
        )
    return ExcludedCircle(*numbers)


def _match_circles(circles: Mapping[str, ExcludedCircle], names: Sequence[str]) -> dict[str, ExcludedCircle]:
    by_file: dict[str, list[ExcludedCircle]] = {}
    for key, circle in circles.items():
        by_file.setdefault(PurePosixPath(key).name, []).append(circle)
    ours = [PurePosixPath(name).name for name in names]
    found = {}
    for name, file in zip(names, ours, strict=True):
        alike = by_file.get(file, [])
        if name in circles:
            found[name] = circles[name]
        elif len(alike) == 1 and ours.count(file) == 1:
            found[name] = alike[0]
    return found
