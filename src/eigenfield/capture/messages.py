"""Lists of files for people: in words, and in natural order."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from eigenfield.core.errors import one_line

MESSAGE_MAX_NAMES = 5  # names that a problem line lists


class Note(str):
    """A line among the problems of a capture that says what is done, and is no problem."""

    __slots__ = ()


def count_phrase(items: Sequence[object], one: str, many: str) -> str:
    """ "1 photograph has" or "3 photographs have"."""
    return f"{len(items)} {one if len(items) == 1 else many}"


def list_names(names: Sequence[str]) -> str:
    """The first few names, and how many more there are."""
    shown = ", ".join(one_line(name) for name in names[:MESSAGE_MAX_NAMES])
    return shown if len(names) <= MESSAGE_MAX_NAMES else f"{shown} and {len(names) - MESSAGE_MAX_NAMES} more"


def describe(names: Sequence[str], one: str, many: str, rest: str) -> list[str]:
    """A line such as "3 photographs have no mask: a, b, c", of `one` or `many`, `rest` and names; none for no names."""
    return [f"{count_phrase(names, one, many)} {rest}: {list_names(names)}"] if names else []


def natural_key(name: str) -> tuple[list[tuple[int, str]], str]:
    """A key that sorts view_2 before view_10, and the same names with leading zeros as plain text."""
    parts = re.split(r"([0-9]+)", name.casefold())
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in parts], name


def unique_names(paths: Sequence[Path]) -> list[str]:
    """File names, or where several files have one name their paths relative to the folder above all of these; whole
    paths where they lie on several drives (Windows)."""
    times = Counter(path.name for path in paths)
    shared = [path for path in paths if times[path.name] > 1]
    try:
        common = os.path.commonpath([path.parent for path in shared]) if shared else ""
    except ValueError:
        return [one_line(path.name if times[path.name] == 1 else path.as_posix()) for path in paths]
    return [one_line(path.name if times[path.name] == 1 else path.relative_to(common).as_posix()) for path in paths]
