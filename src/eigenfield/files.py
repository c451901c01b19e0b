"""Files that are whole or absent, and room on disk that is there before it is used."""

from __future__ import annotations

import contextlib
import errno
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from eigenfield.errors import OutputError

_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


@contextlib.contextmanager
def mended(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turn what the operating system says of writing `path` into an OutputError with a remedy."""
    try:
        yield
    except OSError as error:
        if error.errno in _FULL:
            raise OutputError(
                "disk-full", "no room left on the disk", path=path, remedy="free some or write elsewhere"
            ) from error
        if (
            isinstance(error, (PermissionError, NotADirectoryError, IsADirectoryError, FileNotFoundError))
            or error.errno == errno.EROFS
        ):
            raise OutputError(
                "not-writable",
                error.strerror or "cannot be written",
                path=path,
                remedy="name a place that can be written",
            ) from error
        raise


def refuse_existing(path: Path, overwrite: bool) -> None:
    """Before any work: raise OutputError if `path` exists and may not be replaced, or its folder is missing."""
    if path.is_dir():
        raise OutputError("output-is-folder", "is a folder", path=path, remedy="name a file")
    if path.exists() and not overwrite:
        raise OutputError("output-exists", "exists already", path=path, remedy="use --overwrite or another name")
    folder = path.absolute().parent
    if not folder.is_dir():
        raise OutputError("no-folder", "its folder does not exist", path=path, remedy=f"create {folder}")
    if not os.access(folder, os.W_OK):
        raise OutputError("not-writable", "its folder cannot be written to", path=path, remedy="name another place")


@contextlib.contextmanager
def atomic_writer(path: Path, *, overwrite: bool = False) -> Iterator[IO[bytes]]:
    """A binary file that appears as `path` by rename, after fsync, when the block ends well; else nothing stays."""
    refuse_existing(path, overwrite)
    with mended(path):
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.absolute().parent)
        try:
            with os.fdopen(handle, "wb") as file:
                yield file
                file.flush()
                os.fsync(file.fileno())
            Path(name).chmod(0o666 & ~_umask())  # mkstemp's 0600 would hide the result from other users
            Path(name).replace(path)
        except BaseException:
            with contextlib.suppress(OSError):
                Path(name).unlink()
            raise


def write_bytes(path: Path, data: bytes, *, overwrite: bool = False) -> None:
    """`data` as the file `path`, atomically."""
    with atomic_writer(path, overwrite=overwrite) as file:
        file.write(data)


def _umask() -> int:
    mask = os.umask(0o022)
    os.umask(mask)
    return mask


@contextlib.contextmanager
def scratch_array(shape: tuple[int, ...], dtype: DTypeLike, folder: Path | None = None) -> Iterator[NDArray[Any]]:
    """A zeroed array in a memory-mapped temporary file, gone with the block (or with the process, however it ends).

    folder: where the room is taken, the system's temporary folder if None. Room is claimed at once where the system
    can: a sparse file on a disk that fills up later would end the process by SIGBUS instead of by an OutputError.
    """
    place = Path(folder) if folder is not None else Path(tempfile.gettempdir())
    size = int(np.prod(shape, dtype=np.int64)) * np.dtype(dtype).itemsize
    if size == 0:
        yield np.zeros(shape, dtype)
        return
    with mended(place), tempfile.TemporaryFile(prefix=".eigenfield-", dir=place) as file:
        if hasattr(os, "posix_fallocate"):
            os.posix_fallocate(file.fileno(), 0, size)
        else:
            file.truncate(size)
        yield np.memmap(file, dtype=dtype, mode="r+", shape=shape)
