"""Where the bytes of a file are read from: a file, of which only what is asked for is read, or bytes in memory."""

from __future__ import annotations

import contextlib
import os
import stat
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import BinaryIO, Protocol

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.core.recognise import refuse_address
from eigenfield.runtime.objects import find_objects

PIECE_BYTES = 2**20  # that are copied at a time
SCENE_FILE = "scene.glb"  # of a clip whose groups are files beside it
AGAIN = "copy or download the whole folder again"


class ByteSource(Protocol):
    """Bytes that are read by range, from any thread."""

    @property
    def size(self) -> int:
        """How many there are."""

    def read(self, first: int, last: int) -> memoryview:
        """The bytes [first, last), as far as there are any."""


@dataclass(frozen=True, eq=False)
class HeldBytes:
    """Bytes in memory, of which parts are taken without a copy."""

    data: bytes

    @property
    def size(self) -> int:
        return len(self.data)

    def read(self, first: int, last: int) -> memoryview:
        return memoryview(self.data)[first:last]


class OpenFile:
    """A file on disk, which stays open as long as it is read."""

    def __init__(self, file: BinaryIO, size: int) -> None:
        self.size = size
        self._file = file
        self._lock = threading.Lock()

    def read(self, first: int, last: int) -> memoryview:
        """As of `ByteSource`. FormatError `truncated`: it has become shorter. `file-unreadable`."""
        last = min(last, self.size)
        try:
            with self._lock:
                self._file.seek(first)
                data = self._file.read(max(0, last - first))
        except OSError as error:
            raise unreadable_error(error) from error
        if first + len(data) < last:
            raise truncation_error(first + len(data), self.size)
        return memoryview(data)


@dataclass(frozen=True, eq=False)
class ByteRange:
    """The bytes [first, last) of a source, which are a source themselves."""

    source: ByteSource
    first: int
    last: int

    @property
    def size(self) -> int:
        return self.last - self.first

    def read(self, first: int, last: int) -> memoryview:
        return self.source.read(self.first + first, min(self.first + last, self.last))

    @cached_property
    def data(self) -> memoryview:
        """All of them, read once."""
        return self.read(0, self.size)

    def pieces(self) -> Iterator[memoryview]:
        """All of them, a piece after the other."""
        for first in range(0, self.size, PIECE_BYTES):
            yield self.read(first, first + PIECE_BYTES)


@contextlib.contextmanager
def open_source(path: Path) -> Iterator[ByteSource]:
    """A file, to be read while the context lasts. What an object store has is copied into memory.

    Args:
        path: Of the file, or of a folder with `SCENE_FILE`.

    Raises:
        FormatError: `file-missing`, `file-unreadable`, `not-a-file`, `file-size`.
        OptionError: `web-address`; `object-missing`, `store`: an object store has no such file.
    """
    objects = find_objects(path)
    if objects is not None:
        yield HeldBytes(objects.read())
        return
    path = scene_file(path)
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):  # a pipe would wait, a device may never end
            raise FormatError("not-a-file", "is no regular file", remedy="name a .glb")
        if status.st_size > limits.MAX_FILE:
            raise FormatError("file-size", f"{status.st_size} bytes, {limits.MAX_FILE} are allowed")
        file = path.open("rb")
        size = os.fstat(file.fileno()).st_size  # another file may have taken its place
    except FileNotFoundError as error:
        refuse_address(path)
        raise FormatError("file-missing", "does not exist", remedy="check the name") from error
    except (OSError, ValueError) as error:  # ValueError: a name with a null byte
        raise unreadable_error(error) from error
    with file:
        yield OpenFile(file, size)


def scene_file(path: str | os.PathLike[str]) -> Path:
    """`SCENE_FILE` in a folder that has one; any other path as it is."""
    with contextlib.suppress(OSError, ValueError):  # a name that no file can have
        if (inside := Path(path) / SCENE_FILE).is_file():
            return inside
    return Path(path)


@contextlib.contextmanager
def name_file_in_errors(path: str | os.PathLike[str]) -> Iterator[None]:
    """Put the file's name into every FormatError, and turn a lack of memory into one."""
    try:
        yield
    except FormatError as error:
        error.path = os.fspath(path)
        raise
    except MemoryError as error:
        message, remedy = "does not fit into memory", "open it on a larger machine"
        raise FormatError("memory", message, path=path, remedy=remedy) from error


@dataclass(frozen=True, eq=False)
class StoredBytes:
    """The bytes [first, last) of a file on disk, which is open only while they are read.

    Reading raises FormatError as `open_source` does.
    """

    path: Path
    first: int
    last: int

    @property
    def size(self) -> int:
        return self.last - self.first

    def read(self, first: int, last: int) -> memoryview:
        """As of `ByteSource`."""
        with name_file_in_errors(self.path), open_source(self.path) as source:
            return ByteRange(source, self.first, self.last).read(first, last)


@dataclass(frozen=True, eq=False)
class FileBeside:
    """The bytes of a file that belongs to another one, and is open only while they are read.

    Reading raises FormatError `group-missing`: it is not there, or cannot be read; `group-damaged`: it has another
    length.

    Attributes:
        path: Of the file that it belongs to.
        name: Of the file, from the folder of that one.
        size: The bytes that it must have.
        where: The place in the JSON that says so, for errors.
    """

    path: Path
    name: str
    size: int
    where: str

    def read(self, first: int, last: int) -> memoryview:
        """As of `ByteSource`."""
        try:
            with open_source(self.path.parent / self.name) as source:
                size, data = source.size, source.read(first, last)
        except (FormatError, OptionError) as error:
            message = f"its file {self.name} {error.message}"
            raise FormatError("group-missing", message, path=self.path, where=self.where, remedy=AGAIN) from error
        if size != self.size:
            message = f"its file {self.name} has {size} bytes, and {self.size} are announced"
            raise FormatError("group-damaged", message, path=self.path, where=self.where, remedy=AGAIN)
        return data


def read_file(path: Path) -> bytes:
    """The whole file, with the errors of `open_source`."""
    with open_source(path) as source:
        data = source.read(0, source.size).obj  # what the view is of, without a copy
    assert isinstance(data, bytes)
    return data


def unreadable_error(error: OSError | ValueError) -> FormatError:
    """The error `file-unreadable`, with the system's reason."""
    reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return FormatError("file-unreadable", f"cannot be read: {reason}")


def truncation_error(size: int, length: int) -> FormatError:
    """The error `truncated`, of `size` bytes in place of `length`."""
    message, remedy = f"ends after {size} of {length} bytes", "copy or download it again"
    return FormatError("truncated", message, where=f"byte {size}", remedy=remedy)
