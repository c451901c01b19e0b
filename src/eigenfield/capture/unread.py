"""Lines about the files that lie among photographs and are not read, each with its remedy."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

from eigenfield.capture.locate import files_named, photographs_in
from eigenfield.capture.messages import count_phrase
from eigenfield.capture.photographs.kinds import OPTIONAL_KINDS, OTHER_KINDS, VIDEO_EXTENSIONS, unread_kind
from eigenfield.core.camera_names import name_key

UNREAD_COPIES = "they are of photographs that are read"  # a RAW beside its JPEG, the film of a live photograph


def describe_unread(folders: Iterable[Path], *, photographs_only: bool = False) -> list[str]:
    """A line for each remedy, such as "4 files were not read: .heic (pip install 'eigenfield[photos]')".

    Args:
        folders: Those that are looked into, not what is inside of folders in them.
        photographs_only: Name only photographs that another package would read.
    """
    kinds = OPTIONAL_KINDS if photographs_only else (*OPTIONAL_KINDS, *OTHER_KINDS)
    endings = tuple(ending for kind in kinds for ending in kind.endings)
    found: dict[str, list[str]] = defaultdict(list)
    for folder in sorted(set(folders)):
        photographs = photographs_in(folder)
        read, stems = set(photographs), {name_key(path.stem) for path in photographs}
        for path in files_named(folder, endings):
            remedy = _remedy(path, stems, photographs_only)
            if path not in read and remedy is not None:
                found[remedy].append(path.suffix.lower())
    return [
        f"{count_phrase(names, 'file was', 'files were')} not read: {', '.join(sorted(set(names)))} ({remedy})"
        for remedy, names in found.items()
    ]


def _remedy(path: Path, stems: set[str], photographs_only: bool) -> str | None:
    kind = unread_kind(path.name)
    may_be_copy = kind is None or kind.module is not None or path.name.lower().endswith(VIDEO_EXTENSIONS)
    if may_be_copy and name_key(path.stem) in stems:
        return None if photographs_only else UNREAD_COPIES
    if kind is None:
        return None
    return kind.remedy if kind.module is not None else f"{kind.what}: {kind.remedy}"
