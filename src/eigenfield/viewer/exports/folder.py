"""A folder that an export fills: whole or absent, and only ever replaced where all in it is an export's own."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from eigenfield.core.errors import OutputError
from eigenfield.core.version import __version__
from eigenfield.runtime.files import flush_folder, output_errors

LISTING_FILE = "eigenfield.json"
LISTING_MAX_BYTES = 16 * 2**20  # larger ones are not read back


def refuse_folder(folder: Path, overwrite: bool) -> None:
    """Before any work: check that an export may be written.

    Args:
        folder: To write.
        overwrite: Whether an existing export may be replaced.

    Raises:
        OutputError: `output-is-file`, `no-folder`, `not-writable`, `output-exists`, `not-an-export`.
    """
    if folder.exists() and not folder.is_dir():
        raise OutputError("output-is-file", "is a file", path=folder, remedy="name a folder")
    parent = folder.absolute().parent
    if not parent.is_dir():
        raise OutputError("no-folder", "its folder does not exist", path=folder, remedy=f"create {parent}")
    if not os.access(folder if folder.is_dir() else parent, os.W_OK):
        raise OutputError("not-writable", "cannot be written to", path=folder, remedy="name another place")
    with output_errors(folder):
        if not folder.is_dir() or not any(folder.iterdir()):
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

    Args:
        folder: To write.
        overwrite: Whether an existing export is replaced.

    Raises:
        OutputError: As `refuse_folder`; the folder cannot be written.
    """
    refuse_folder(folder, overwrite)
    with output_errors(folder):
        there = folder.is_dir()
        beside = folder if there else folder.absolute().parent
        part = Path(tempfile.mkdtemp(prefix=".eigenfield-", suffix=".part", dir=beside))
        try:
            new = part / "new"
            new.mkdir()
            yield new
            flush_folder(new)
            if there:
                _exchange(folder, part)
            else:
                new.replace(folder)
        finally:
            shutil.rmtree(part, ignore_errors=True)


def write_file(path: Path, data: bytes) -> None:
    """Write a file, and create the folders that it lies in.

    Not for threads: one that is late would create a removed folder again.

    Args:
        path: Of the file.
        data: Its bytes.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)


def write_listing(folder: Path, kind: str, more: Mapping[str, Any]) -> None:
    """Write `eigenfield.json`: the kind of export, and every file that it wrote.

    Args:
        folder: Of the export.
        kind: Of the export.
        more: Further entries.
    """
    files = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    document = {"kind": kind, "generator": f"eigenfield {__version__}", **more, "files": [*files, LISTING_FILE]}
    text = json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)
    (folder / LISTING_FILE).write_text(text + "\n", encoding="utf-8")


def _not_ours(folder: Path) -> str | None:
    """A file in `folder` that its listing does not name."""
    listing, ours = folder / LISTING_FILE, set[str]()
    with contextlib.suppress(OSError, ValueError, AttributeError, TypeError, RecursionError):
        if listing.stat().st_size <= LISTING_MAX_BYTES:
            ours = set(json.loads(listing.read_text(encoding="utf-8")).get("files", []))
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if name not in ours and (path.is_symlink() or not path.is_dir()):
            return name
    return None


def _exchange(folder: Path, part: Path) -> None:
    """Move what is in `folder` to part / "old", and what is in part / "new" to `folder`; undone if anything fails."""
    (part / "old").mkdir()
    moved: list[tuple[Path, Path]] = []
    try:
        for source, target in ((folder, part / "old"), (part / "new", folder)):
            for entry in sorted(source.iterdir()):
                if entry.name != part.name:
                    moved.append((entry, target / entry.name))
                    entry.replace(target / entry.name)
    except BaseException:
        for before, now in reversed(moved):
            with contextlib.suppress(OSError):
                now.replace(before)
        raise
