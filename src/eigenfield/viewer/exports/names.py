"""Cameras' names as names of files: inside the folder on every system, and unlike each other."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence

from eigenfield.capture.photographs.kinds import ALL_EXTENSIONS

NAME_MAX_BYTES = 120  # of a folder's or file's name, without its ending
PATH_MAX_PARTS = 6  # folders and file of a path
NAME_FORBIDDEN_CHARACTERS = '<>:"|?*/\\'  # on Windows; and everywhere what is not printable
NAME_RESERVED = re.compile(  # devices of Windows
    r"(con|prn|aux|nul|con(in|out)\$|com[0-9¹²³]|lpt[0-9¹²³]) *(\..*)?", re.IGNORECASE
)


def file_names(names: Sequence[str]) -> list[str]:
    """The relative path of a .png, with forward slashes, for each name.

    Sub-folders stay. What leads outside, or what some system does not allow, is left out or becomes `_`. Names that
    would then be the same file, also where case does not count, are numbered: `a.png`, `a-2.png`.

    Args:
        names: Of cameras; a photograph's own ending is replaced.
    """
    files: set[str] = set()
    folders: set[str] = set()
    return [_free_path(_parts(name), files, folders) for name in names]


def file_name(name: str, otherwise: str) -> str:
    """One part of a path that every system allows.

    Args:
        otherwise: Where nothing of `name` is left.
    """
    text = "".join(
        "_" if c in NAME_FORBIDDEN_CHARACTERS or not c.isprintable() else c for c in unicodedata.normalize("NFC", name)
    )
    text = text.strip(". ")
    if NAME_RESERVED.fullmatch(text):
        text = f"_{text}"
    return _truncate(text, NAME_MAX_BYTES).rstrip(". ") or otherwise


def _parts(name: str) -> list[str]:
    extension = next((ending for ending in ALL_EXTENSIONS if name.lower().endswith(ending)), "")
    stem = name[: len(name) - len(extension)]
    parts = list(filter(None, (file_name(part, "") for part in re.split(r"[/\\]", stem)))) or ["camera"]
    last = PATH_MAX_PARTS - 1
    return parts if len(parts) <= PATH_MAX_PARTS else [*parts[:last], "_".join(parts[last:])]


def _free_path(parts: list[str], files: set[str], folders: set[str]) -> str:
    """The path of `parts`, numbered where it is taken; adds it and its folders to `files` and `folders`."""
    parents = [_key("/".join(parts[:depth])) for depth in range(1, len(parts))]
    if any(parent in files for parent in parents):
        parts, parents = ["_".join(parts)], []
    number = 1
    while True:
        last = _truncate(parts[-1], NAME_MAX_BYTES) + (f"-{number}" if number > 1 else "") + ".png"
        path = "/".join([*parts[:-1], last])
        if _key(path) not in files | folders:
            break
        number += 1
    files.add(_key(path))
    folders.update(parents)
    return path


def _key(path: str) -> str:
    """The same for paths that are one file where case does not count."""
    return unicodedata.normalize("NFC", path.casefold())


def _truncate(text: str, most: int) -> str:
    return text.encode("utf-8")[:most].decode("utf-8", errors="ignore")
