"""Lists of files in words, and in the order that people expect."""

from __future__ import annotations

import re
from collections.abc import Sequence

from eigenfield.capture.calibration import printable

NAMED = 5  # names that a problem line lists


def count(items: Sequence[object], one: str, many: str) -> str:
    """ "1 photograph has" or "3 photographs have"."""
    return f"{len(items)} {one if len(items) == 1 else many}"


def some(names: Sequence[str]) -> str:
    """The first few names, and how many more there are."""
    shown = ", ".join(printable(name) for name in names[:NAMED])
    return shown if len(names) <= NAMED else f"{shown} and {len(names) - NAMED} more"


def natural(name: str) -> list[tuple[int, str]]:
    """A key that sorts view_2 before view_10."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"([0-9]+)", name.casefold())]
