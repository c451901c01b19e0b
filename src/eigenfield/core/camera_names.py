"""Cameras by the names of their photographs."""

from __future__ import annotations

import difflib
import posixpath
import unicodedata
from collections.abc import Sequence

from eigenfield.core.errors import OptionError


def name_key(name: str) -> str:
    """A file's name as file systems compare names that know neither case nor one way to write an accent."""
    return unicodedata.normalize("NFC", unicodedata.normalize("NFC", name).casefold())


def name_stem(name: str) -> str:
    """A photograph's name without its ending, by `name_key`: view_01.JPG and view_01.png are one."""
    return name_key(posixpath.splitext(name)[0])


def named_camera(name: str, names: Sequence[str], option: str) -> int:
    """The index of the camera that is called `name`, or of the only one that is called so but for its ending.

    Args:
        name: A photograph's name, with or without its ending.
        option: The error's `code`.

    Raises:
        OptionError: No camera, or more than one, is called so; it names those most like it.
    """
    alike = _called(name, names)
    if len(alike) == 1:
        return alike[0]
    near = [names[index] for index in alike[:3]] or difflib.get_close_matches(name, names, n=3, cutoff=0.0)
    raise OptionError(option, f"no camera is called {name}", remedy=f"nearest are {', '.join(near)}")


def named_cameras(text: str, names: Sequence[str], option: str) -> list[int]:
    """The indices of cameras that are named with commas between them.

    Names may hold commas themselves: of what could be meant, the longest name is.

    Raises:
        OptionError: As `named_camera`.
    """
    parts, found = text.split(","), []
    most = 1 + max((name.count(",") for name in names), default=0)
    while parts:
        runs = [",".join(parts[:count]).strip() for count in range(min(most, len(parts)), 0, -1)]
        # an ending is not compared, and must not pass for one: "a.jpg,b" is no a.png
        fitting = (run for run in runs if any(run.count(",") == names[i].count(",") for i in _called(run, names)))
        name = next(fitting, runs[-1])
        if name:
            found.append(named_camera(name, names, option))
        del parts[: name.count(",") + 1]
    return found


def _called(name: str, names: Sequence[str]) -> list[int]:
    """The index of the camera that is called so; else of all that are but for their ending."""
    if name in names:
        return [list(names).index(name)]
    return [index for index, other in enumerate(names) if name_stem(other) in (name_key(name), name_stem(name))]
