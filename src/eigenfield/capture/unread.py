"""Lines about the files that lie among photographs and are not read, each with its remedy."""

from __future__ import annotations

import os
from collections import defaultdict, deque
from collections.abc import Iterable
from pathlib import Path

from eigenfield.capture.locate import IMAGES_FOLDER, content_format, files_named, photographs_in
from eigenfield.capture.messages import count_phrase, list_names
from eigenfield.capture.photographs.kinds import (
    ALL_EXTENSIONS,
    PASSED_OVER_EXTENSIONS,
    PLACEHOLDER_KIND,
    VIDEO_EXTENSIONS,
    may_be_renamed,
    placeholder_of,
    unread_kind,
)
from eigenfield.core.camera_names import name_key
from eigenfield.core.shell import shell_word

UNREAD_COPIES = "they are of photographs that are read"  # a RAW beside its JPEG, the film of a live photograph
UNREAD_NAMES = "pictures by their content: give them the endings of their formats, if they show the scene"
NAMED_EXTENSIONS = (*ALL_EXTENSIONS, *VIDEO_EXTENSIONS)
SEARCH_MAX_FOLDERS, SEARCH_MAX_DEPTH = 1000, 6  # that are looked into where a folder holds no photographs
UNREAD_PLACEHOLDERS = f"{PLACEHOLDER_KIND.what}: {PLACEHOLDER_KIND.remedy}"


def describe_unread(folders: Iterable[Path], *, photographs_only: bool = False) -> list[str]:
    """A line for each remedy, such as "4 files were not read: .heic (pip install 'eigenfield[photos]')".

    Args:
        folders: Those that are looked into, not what is inside of folders in them.
        photographs_only: Name only photographs that another package or name would read, and those that are elsewhere.
    """
    found: dict[str, list[str]] = defaultdict(list)
    for folder in sorted(set(folders)):
        photographs = photographs_in(folder)
        read, stems = set(photographs), {name_key(path.stem) for path in photographs}
        for path in sorted(folder.iterdir()) if folder.is_dir() else []:
            remedy = None if path in read else _remedy(path, stems, photographs_only)
            if remedy is not None:
                found[remedy].append(path.suffix.lower() or "without an ending")
    return [
        f"{count_phrase(names, 'file was', 'files were')} not read: {', '.join(sorted(set(names)))} ({remedy})"
        for remedy, names in found.items()
    ]


def describe_inner(folder: Path) -> str | None:
    """A remedy that names the folders inside one, at any depth, that hold photographs or videos; None without any."""
    found: list[Path] = []
    waiting = deque([(folder, 0)])
    looked = 0
    while waiting and looked < SEARCH_MAX_FOLDERS:
        here, depth = waiting.popleft()
        looked += 1
        for path in sorted(here.iterdir()) if os.access(here, os.R_OK) else []:
            if not path.is_dir() or path.is_symlink() or path.name.startswith((".", "@", "__MACOSX")):
                continue
            if _holds_pictures(path):
                found.append(here if path.name == IMAGES_FOLDER and here != folder else path)
            elif depth + 1 < SEARCH_MAX_DEPTH:
                waiting.append((path, depth + 1))
    if not found:
        return None
    names = [shell_word(path) for path in sorted(set(found))]
    return f"name {list_names(names)}" + (": one, or several if they are one capture" if len(names) > 1 else "")


def _holds_pictures(folder: Path) -> bool:
    return bool(
        photographs_in(folder)
        or files_named(folder, VIDEO_EXTENSIONS)
        or describe_unread((folder,), photographs_only=True)
    )


def _remedy(path: Path, stems: set[str], photographs_only: bool) -> str | None:
    name, wanted = path.name.lower(), placeholder_of(path.name)
    if wanted is None and os.path.islink(path) and not path.exists():  # noqa: PTH114
        wanted = path.name
    if wanted is not None and wanted.lower().endswith(ALL_EXTENSIONS if photographs_only else NAMED_EXTENSIONS):
        return None if name_key(Path(wanted).stem) in stems else UNREAD_PLACEHOLDERS
    if name.startswith(".") or not path.is_file():
        return None
    kind, is_copy = unread_kind(name), name_key(path.stem) in stems
    if is_copy and name.endswith(NAMED_EXTENSIONS):
        return None if photographs_only else UNREAD_COPIES
    if kind is not None and kind.module is not None:
        return kind.remedy
    if kind is None or may_be_renamed(name):
        if is_copy or name.endswith(PASSED_OVER_EXTENSIONS):
            return None
        if (may_be_renamed(name) or not photographs_only) and content_format(path) is not None:
            return UNREAD_NAMES
    return None if kind is None or photographs_only else f"{kind.what}: {kind.remedy}"
