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
    if name in names:
        return list(names).index(name)
    alike = [index for index, other in enumerate(names) if name_stem(other) in (name_key(name), name_stem(name))]
    if len(alike) == 1:
        return alike[0]
    near = [names[index] for index in alike[:3]] or difflib.get_close_matches(name, names, n=3, cutoff=0.0)
    raise OptionError(option, f"no camera is called {name}", remedy=f"nearest are {', '.join(near)}")
