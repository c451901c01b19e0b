"""Temporary files and folders, of which neither a stopped nor a killed process leaves any for good.

A name is noted before its file is made, so that `remove_temporaries` finds whatever any thread has made. A killed
process removes nothing. While a process lives, it holds a lock on each of its own. The next process that makes one of
the same prefix in the same folder removes those that nobody holds.
"""

from __future__ import annotations

import contextlib
import os
import re
import secrets
import shutil
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

from eigenfield.core.forks import renew_in_child

try:
    import fcntl
except ImportError:  # Windows, where what a killed process left stays
    fcntl = None  # type: ignore[assignment]

PREFIX = "eigenfield"
PREFIX_MAX_CHARACTERS = 40  # a name of 255 bytes must still have room for the rest
REMOVE_ATTEMPTS = 10  # a thread may be about to write into a folder that is being removed
PART_NAME = re.compile(r"\.(?P<prefix>.*)-[0-9a-f]{16}\.part", re.DOTALL)

_made: set[Path] = set()
_searched: set[tuple[Path, str]] = set()
_gate = threading.RLock()  # a signal handler may come while its own thread holds it
_stopped = False


@renew_in_child
def _leave_to_parent() -> None:
    global _gate
    _gate = threading.RLock()
    _made.clear()


@contextlib.contextmanager
def temporary_folder(prefix: str = PREFIX, folder: Path | None = None) -> Iterator[Path]:
    """A new folder, removed after the block where it still has its name.

    Args:
        prefix: Of its name: what a killed process left under the same prefix is removed.
        folder: Where it is made; None: the system's temporary folder.
    """
    # Python gives 0o700 on Windows an access list that files keep when they are moved out of the folder
    mode = 0o777 if sys.platform == "win32" and folder is not None else 0o700
    with _temporary(prefix, folder, lambda path: path.mkdir(mode)) as path:
        yield path


@contextlib.contextmanager
def temporary_file(prefix: str, folder: Path) -> Iterator[Path]:
    """As `temporary_folder`, a new empty file."""
    with _temporary(prefix, folder, lambda path: os.close(os.open(path, os.O_CREAT | os.O_EXCL, 0o600))) as path:
        yield path


def is_temporary(path: Path) -> bool:
    """Whether a file or folder has the name of a temporary one."""
    return PART_NAME.fullmatch(path.name) is not None


def remove_temporaries() -> None:
    """Remove all that this process has made, and let its threads make no more: it is about to end."""
    global _stopped
    with _gate:
        _stopped = True
        for _ in range(2):  # a thread may have renamed one meanwhile, see `_remove`
            for path in _made.copy():
                _remove(path)


@contextlib.contextmanager
def _temporary(prefix: str, folder: Path | None, make: Callable[[Path], None]) -> Iterator[Path]:
    place = Path(tempfile.gettempdir() if folder is None else folder).absolute()
    prefix = prefix[:PREFIX_MAX_CHARACTERS]
    _remove_left(place, prefix)
    while True:
        path = place / _new_name(prefix)
        try:
            with _gate:
                if _stopped:
                    raise KeyboardInterrupt
                _made.add(path)
                make(path)
            handle = _lock(path)
            if not path.exists():  # another process took it for one that was left
                continue
            try:
                yield path
            finally:
                if handle is not None:
                    os.close(handle)
        finally:
            if path in _made:  # else it is of the parent of this process
                _remove(path)
                _made.discard(path)
        return


def _remove(path: Path) -> None:
    if not path.is_dir():
        with contextlib.suppress(OSError):
            path.unlink()
        return
    # A thread that writes into the folder goes on forever: under another name it finds it no longer
    aside = path.with_name(_new_name(path.name[1 : -len("-0123456789abcdef.part")]))
    _made.add(aside)
    with contextlib.suppress(OSError):
        path = path.rename(aside)
    for _ in range(REMOVE_ATTEMPTS):
        if path.exists():
            shutil.rmtree(path, ignore_errors=True)
    _made.discard(aside)


def _new_name(prefix: str) -> str:
    return f".{prefix}-{secrets.token_hex(8)}.part"


def _lock(path: Path) -> int | None:
    """An open handle that holds the lock of a file or folder; None where another has it, or there are no locks."""
    if fcntl is None:
        return None
    handle = None
    try:
        handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        if handle is not None:
            os.close(handle)
        return None
    return handle


def _remove_left(folder: Path, prefix: str) -> None:
    """Remove what killed processes left, once a process: running ones hold theirs."""
    if (folder, prefix) in _searched:
        return
    _searched.add((folder, prefix))
    there: list[Path] = []
    with contextlib.suppress(OSError):
        there += folder.iterdir()
    for path in there:
        if (found := PART_NAME.fullmatch(path.name)) and found["prefix"] == prefix:
            handle = _lock(path)
            if handle is not None:
                _remove(path)
                os.close(handle)
