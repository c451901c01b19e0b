"""A folder that an export fills: whole or absent, and only ever replaced where all in it is an export's own."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from eigenfield.core.errors import OutputError
from eigenfield.core.rights import Rights
from eigenfield.core.version import __version__
from eigenfield.runtime.files import flush_folder, output_errors, rename
from eigenfield.runtime.objects import refuse_objects
from eigenfield.runtime.signals import hold_signals
from eigenfield.runtime.temporary import is_temporary, temporary_folder

LISTING_FILE = "eigenfield.json"
LISTING_MAX_BYTES = 16 * 2**20  # larger ones are not read back


def refuse_folder(folder: Path, overwrite: bool) -> None:
    """Before any work: check that an export may be written.

    Raises:
        OutputError: `output-is-file`, `no-folder`, `not-writable`, `output-exists`, `not-an-export`,
            `output-address`.
    """
    refuse_objects(folder)
    if folder.exists() and not folder.is_dir():
        raise OutputError("output-is-file", "is a file", path=folder, remedy="name a folder")
    parent = folder.absolute().parent
    if not parent.is_dir():
        raise OutputError("no-folder", "its folder does not exist", path=folder, remedy=f"create {parent}")
    if not os.access(folder if folder.is_dir() else parent, os.W_OK):
        raise OutputError("not-writable", "cannot be written to", path=folder, remedy="name another place")
    with output_errors(folder):
        if not folder.is_dir() or all(is_temporary(entry) for entry in folder.iterdir()):
            return
        if not overwrite:
            raise OutputError(
                "output-exists", "exists and is not empty", path=folder, remedy="use --overwrite or another name"
            )
        other = _not_ours(folder)
    if other is not None:
        raise OutputError(
            "not-an-export",
            f"holds {other}, which no export wrote, and is not replaced",
            path=folder,
            remedy="name another folder, or empty it yourself",
        )


@contextlib.contextmanager
def atomic_folder(folder: Path, overwrite: bool) -> Iterator[Path]:
    """Yields an empty folder that is renamed to `folder` when the block succeeds, and removed when it fails.

    Where `folder` exists, what it holds is replaced entry by entry, and restored if that fails.

    Raises:
        OutputError: As `refuse_folder`; the folder cannot be written.
    """
    refuse_folder(folder, overwrite)
    with output_errors(folder):
        there = folder.is_dir()
        beside = folder if there else folder.absolute().parent
        with temporary_folder(folder=beside) as part:
            new = part / "new"
            new.mkdir()
            yield new
            flush_folder(new)
            if there:
                with hold_signals():
                    _exchange(folder, part)
            else:
                rename(new, folder)


def write_file(path: Path, data: bytes) -> None:
    """Write a file, and create the folders that it lies in.

    Not for threads: one that is late would create a removed folder again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def write_listing(folder: Path, kind: str, more: Mapping[str, Any], rights: Rights | None = None) -> None:
    """Write `eigenfield.json`: the kind of export, whose it is, every file that it wrote, and further entries."""
    files = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    document: dict[str, Any] = {"kind": kind, "generator": f"eigenfield {__version__}"}
    document |= {"rights": rights.said} if rights is not None and rights.said else {}
    text = json.dumps(
        {**document, **more, "files": [*files, LISTING_FILE]}, indent=1, ensure_ascii=False, allow_nan=False
    )
    # names on disk may be no UTF-8
    (folder / LISTING_FILE).write_text(text + "\n", encoding="utf-8", errors="replace", newline="\n")


def _not_ours(folder: Path) -> str | None:
    """A file in `folder` that its listing does not name."""
    ours = _listed(folder)
    for path in sorted(folder.rglob("*")):
        place = path.relative_to(folder)
        if is_temporary(Path(place.parts[0])):  # of a killed run
            continue
        if place.as_posix() not in ours and (path.is_symlink() or not path.is_dir()):
            return place.as_posix()
    return None


def _listed(folder: Path) -> set[str]:
    """The files that the folder's listing names."""
    listing = folder / LISTING_FILE
    with contextlib.suppress(OSError, ValueError, AttributeError, TypeError, RecursionError):
        if listing.stat().st_size <= LISTING_MAX_BYTES:
            return set(json.loads(listing.read_text(encoding="utf-8")).get("files", []))
    return set()


def _exchange(folder: Path, part: Path) -> None:
    """Move what is in `folder` to part / "old", and what is in part / "new" to `folder`; undone if anything fails.

    Meanwhile the listing names the files of both: a process that is killed midway leaves what `_not_ours` accepts.
    """
    new, old, listing, both = part / "new", part / "old", folder / LISTING_FILE, part / LISTING_FILE
    old.mkdir()
    moved: list[tuple[Path, Path]] = []
    if listing.exists():
        shutil.copy2(listing, old)
    both.write_text(json.dumps({"files": sorted(_listed(folder) | _listed(new))}), encoding="utf-8")
    try:
        rename(both, listing)
        for source, target in ((folder, old), (new, folder)):
            for entry in sorted(source.iterdir()):
                if entry.name not in (part.name, LISTING_FILE):
                    moved.append((entry, target / entry.name))
                    rename(entry, target / entry.name)
        rename(new / LISTING_FILE, listing)
    except BaseException:
        for before, now in reversed(moved):
            with contextlib.suppress(OSError):
                now.replace(before)
        with contextlib.suppress(OSError):
            listing.unlink()
            (old / LISTING_FILE).replace(listing)
        raise
