"""Cameras' names as names of files: inside the folder on every system, and unlike each other."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence

from eigenfield.capture.photographs.read import PHOTOGRAPH_EXTENSIONS

LONGEST = 120  # bytes of a folder's or file's name, before its ending
DEEPEST = 6  # folders in a path
FORBIDDEN = '<>:"|?*'  # on Windows; and everywhere what is not printable
RESERVED = re.compile(r"(con|prn|aux|nul|com[0-9¹²³]|lpt[0-9¹²³])(\..*)?", re.IGNORECASE)  # devices of Windows


def file_names(names: Sequence[str], ending: str = ".png") -> list[str]:
    """For each name a relative path with forward slashes that ends in `ending`, in place of a photograph's own.

    Sub-folders stay. What leads outside, or what some system does not allow, is left out or becomes `_`; names that
    would then be the same file, also where upper and lower case are, are numbered: `a.png`, `a-2.png`.
    """
    files: set[str] = set()
    folders: set[str] = set()
    return [_free(_parts(name), ending, files, folders) for name in names]


def file_name(name: str, otherwise: str) -> str:
    """One part of a path that every system allows; `otherwise` where nothing of `name` is left."""
    text = "".join("_" if c in FORBIDDEN or not c.isprintable() else c for c in unicodedata.normalize("NFC", name))
    text = text.strip(". ")
    if RESERVED.fullmatch(text):
        text = f"_{text}"
    return _cut(text, LONGEST).rstrip(". ") or otherwise


def _parts(name: str) -> list[str]:
    stem = name
    for extension in PHOTOGRAPH_EXTENSIONS:
        if name.lower().endswith(extension):
            stem = name[: -len(extension)]
            break
    parts = [file_name(part, "") for part in re.split(r"[/\\]", stem)]
    kept = [part for part in parts if part]
    if not kept:
        return ["camera"]
    return [*kept[: DEEPEST - 1], "_".join(kept[DEEPEST - 1 :])] if len(kept) > DEEPEST else kept


def _free(parts: list[str], ending: str, files: set[str], folders: set[str]) -> str:
    """The path of `parts`, numbered where it is taken; it and its folders are taken from now on."""
    parents = [_key("/".join(parts[:depth])) for depth in range(1, len(parts))]
    if any(parent in files for parent in parents):
        parts, parents = ["_".join(parts)], []
    number = 1
    while True:
        last = _cut(parts[-1], LONGEST) + (f"-{number}" if number > 1 else "") + ending
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


def _cut(text: str, most: int) -> str:
    return text.encode("utf-8")[:most].decode("utf-8", errors="ignore")
