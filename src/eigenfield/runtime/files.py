"""Files that are whole or absent, and disk space that is allocated before it is used."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shutil
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from eigenfield.core.errors import OutputError
from eigenfield.runtime.objects import find_objects, refuse_objects
from eigenfield.runtime.signals import hold_signals
from eigenfield.runtime.temporary import temporary_file, temporary_folder

_NUMBER_PLACE = re.compile(r"%0?\d{0,2}d")
_DISK_FULL_ERRORS = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
_NOT_WRITABLE_ERRORS = PermissionError, NotADirectoryError, IsADirectoryError, FileNotFoundError
_SHARING_VIOLATION = 32  # of Windows: another program has the file open
_READING = threading.Lock()
_RENAME_WAITS_SECONDS = 0.05, 0.2, 0.75  # virus scanners and indexers of Windows open every new file for a moment


@contextlib.contextmanager
def output_errors(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turn errors of the operating system on writing `path` into an OutputError with a remedy."""
    try:
        yield
    except OSError as error:
        if error.errno in _DISK_FULL_ERRORS:
            message, remedy = "no room left on the disk", "free some or write elsewhere"
            raise OutputError("disk-full", message, path=path, remedy=remedy) from error
        if getattr(error, "winerror", None) == _SHARING_VIOLATION:
            message, remedy = "is open in another program", "close it there or name another file"
            raise OutputError("not-writable", message, path=path, remedy=remedy) from error
        if isinstance(error, _NOT_WRITABLE_ERRORS) or error.errno in (errno.EROFS, errno.ENAMETOOLONG):
            message, remedy = error.strerror or "cannot be written", "name a place that can be written"
            raise OutputError("not-writable", message, path=path, remedy=remedy) from error
        raise


def make_folder(path: Path) -> None:
    """A folder, and those above it, where they are not there yet.

    Raises:
        OutputError: `not-a-folder`, `disk-full` or `not-writable`.
    """
    if path.is_file():
        raise OutputError("not-a-folder", "is a file", path=path, remedy="name a folder")
    with output_errors(path):
        path.mkdir(parents=True, exist_ok=True)


def refuse_existing(path: Path, overwrite: bool) -> None:
    """Before any work: raise OutputError if `path` exists and may not be replaced, or its folder is missing."""
    with output_errors(path):  # of a name that is too long even this cannot be asked
        path.exists()
    objects = find_objects(path)
    if objects is not None:
        if objects.exists() and not overwrite:
            remedy = "use --overwrite or another name"
            raise OutputError("output-exists", "exists already", path=objects.address, remedy=remedy)
        return
    if path.is_dir():
        raise OutputError("output-is-folder", "is a folder", path=path, remedy="name a file")
    if path.exists() and not overwrite:
        raise OutputError("output-exists", "exists already", path=path, remedy="use --overwrite or another name")
    folder = path.absolute().parent
    if not folder.is_dir():
        raise OutputError("no-folder", "its folder does not exist", path=path, remedy=f"create {folder}")
    if not os.access(folder, os.W_OK):
        raise OutputError("not-writable", "its folder cannot be written to", path=path, remedy="name another place")


def is_numbered(path: Path) -> bool:
    """Whether a .png's name is a pattern with a place for a number, `%04d` or `%d`."""
    return path.suffix.lower() == ".png" and _NUMBER_PLACE.search(path.name) is not None


def numbered_files(path: Path, count: int) -> list[Path]:
    """The files 0 to `count` - 1 of a numbered name."""

    def numbered(index: int) -> str:
        return _NUMBER_PLACE.sub(lambda place: place[0] % index, path.name)

    return [path.with_name(numbered(index)) for index in range(count)]


@contextlib.contextmanager
def atomic_writer(path: Path, *, overwrite: bool = False) -> Iterator[IO[bytes]]:
    """A binary file that appears as `path` by rename, after fsync, when the block succeeds; else nothing is left.

    At an address of an object store it appears as an object.
    """
    refuse_existing(path, overwrite)
    objects = find_objects(path)
    if objects is not None:
        with output_errors(objects.address), objects.local_file() as place, place.open("wb") as file:
            yield file
        return
    with output_errors(path), temporary_file(path.name, path.absolute().parent) as part:
        with part.open("wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        part.chmod(0o666 & ~current_umask())  # it was its maker's alone
        rename(part, path)


def write_bytes(path: Path, data: bytes, *, overwrite: bool = False) -> None:
    """`data` as the file `path`, atomically."""
    with atomic_writer(path, overwrite=overwrite) as file:
        file.write(data)


@contextlib.contextmanager
def atomic_files(targets: Sequence[Path], *, overwrite: bool = False) -> Iterator[list[Path]]:
    """Files of one folder that appear together by rename, in order, when the block succeeds; else nothing is left.

    Yields the paths at which the block must write them.
    """
    for target in targets:
        refuse_objects(target)
        refuse_existing(target, overwrite)
    with output_errors(targets[0]), temporary_folder(folder=targets[0].absolute().parent) as part:
        (part / "new").mkdir()
        (part / "old").mkdir()
        places = [part / "new" / target.name for target in targets]
        yield places
        flush_folder(part)
        with hold_signals():
            _replace_all(places, targets, part / "old")


def _replace_all(places: Sequence[Path], targets: Sequence[Path], old: Path) -> None:
    """Rename each place to its target; undone if any fails. `old` keeps what was there until then."""
    done: list[Path] = []
    try:
        for place, target in zip(places, targets, strict=True):
            if target.exists():
                _link_or_copy(target, old / target.name)
            done.append(target)
            rename(place, target)
    except BaseException:
        for target in done:
            before = old / target.name
            with contextlib.suppress(OSError):
                if before.exists():
                    before.replace(target)
                else:
                    target.unlink()
        raise


def rename(source: Path, target: Path) -> None:
    """Rename a file or folder, replacing a file; on Windows again a little later where another program has it open."""
    for seconds in _RENAME_WAITS_SECONDS if sys.platform == "win32" else ():
        try:
            source.replace(target)
            return
        except PermissionError:
            if target.is_dir():  # which Windows never replaces
                raise
            time.sleep(seconds)
    source.replace(target)


def _link_or_copy(path: Path, copy: Path) -> None:
    """A second name for a file; a copy where the file system has no links."""
    try:
        os.link(path, copy)
    except OSError:
        shutil.copy2(path, copy)


def flush_folder(folder: Path) -> None:
    """Flush every file below `folder` to the disk."""
    mode = os.O_RDWR if sys.platform == "win32" else os.O_RDONLY  # Windows flushes only what may be written
    for inside, _, files in os.walk(folder):
        for name in files:
            handle = os.open(Path(inside) / name, mode)
            try:
                os.fsync(handle)
            finally:
                os.close(handle)


def current_umask() -> int:
    """The permissions that new files do not get."""
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


class ScratchRows:
    """Rows of an array, appended to a temporary file."""

    def __init__(self, file: IO[bytes], place: Path, tail: tuple[int, ...], dtype: DTypeLike) -> None:
        self._file, self._place, self._tail, self._dtype, self._count = file, place, tail, np.dtype(dtype), 0

    def append(self, rows: NDArray[Any]) -> None:
        """Add rows at the end.

        Raises:
            OutputError: `disk-full`, or the file cannot be written.
        """
        with output_errors(self._place):
            self._file.write(np.ascontiguousarray(rows, self._dtype).data)
        self._count += len(rows)

    def mapped(self) -> NDArray[Any]:
        """All rows, memory-mapped."""
        shape = (self._count, *self._tail)
        if not self._count:
            return np.zeros(shape, self._dtype)
        with output_errors(self._place):
            self._file.flush()
            return np.memmap(self._file, dtype=self._dtype, mode="r+", shape=shape)


@contextlib.contextmanager
def scratch_rows(tail: tuple[int, ...], dtype: DTypeLike, folder: Path | None = None) -> Iterator[ScratchRows]:
    """Rows of an array whose number is not known before, in a temporary file that is deleted after the block.

    Args:
        tail: Shape of a row.
        folder: Where the file is made; None: the system's temporary folder.
    """
    place = Path(folder) if folder is not None else Path(tempfile.gettempdir())
    with contextlib.ExitStack() as opened:
        with output_errors(place):
            file = opened.enter_context(tempfile.TemporaryFile(prefix=".eigenfield-", dir=place))
        yield ScratchRows(file, place, tail, dtype)


@contextlib.contextmanager
def scratch_array(shape: tuple[int, ...], dtype: DTypeLike, folder: Path | None = None) -> Iterator[NDArray[Any]]:
    """A zeroed array in a memory-mapped temporary file, deleted after the block (or when the process ends).

    Space is allocated at once where the system can, else free space is checked: a sparse file on a disk that fills up
    later would end the process by SIGBUS instead of by an OutputError.

    Args:
        folder: Where the file is made; None: the system's temporary folder.
    """
    with scratch_arrays(1, shape, dtype, folder) as array:
        yield array(0)


@contextlib.contextmanager
def scratch_arrays(
    count: int, shape: tuple[int, ...], dtype: DTypeLike, folder: Path | None = None
) -> Iterator[Callable[[int], NDArray[Any]]]:
    """As `scratch_array`, arrays of one shape in one file: from a number below `count` to one of them.

    Each call maps an array anew, so that memory has only those that are held.
    """
    place = Path(folder) if folder is not None else Path(tempfile.gettempdir())
    size = int(np.prod(shape, dtype=np.int64)) * np.dtype(dtype).itemsize
    if size == 0:
        yield lambda _: np.zeros(shape, dtype)
        return
    with contextlib.ExitStack() as opened:
        with output_errors(place):  # what goes wrong in the caller's block is not about this folder
            file = opened.enter_context(tempfile.TemporaryFile(prefix=".eigenfield-", dir=place))
            if hasattr(os, "posix_fallocate"):
                os.posix_fallocate(file.fileno(), 0, count * size)
            else:
                if shutil.disk_usage(place).free < count * size:
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
                file.truncate(count * size)

        def mapped(number: int) -> NDArray[Any]:
            with output_errors(place):
                return np.memmap(file, dtype=dtype, mode="r+", offset=number * size, shape=shape)

        yield mapped


def read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    """The arrays of an .npz file, by name.

    Threads take turns: NumPy reads headers with `ast`, and two threads in it at once fail now and then in Python 3.11
    ("AST constructor recursion depth mismatch", cpython issue 106905).
    """
    with _READING, np.load(path) as found:
        return dict(found)
