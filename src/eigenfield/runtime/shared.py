"""Values that many tasks need: each is pickled once into a file, and read once by each worker."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Generic, TypeVar

from eigenfield.runtime.files import current_umask, output_errors
from eigenfield.runtime.temporary import temporary_folder

T = TypeVar("T")

KEPT_VALUES = 64  # of one folder, in a worker from task to task: photographs or their features of 1 to 2 MB


@dataclass(frozen=True)
class Shared(Generic[T]):
    """A value in a file that workers see.

    Attributes:
        file: In a folder of its own values alone, where workers may also write results.
    """

    file: Path

    def value(self) -> T:
        """The value: one object for as long as a worker needs it, so that what it caches lasts as long."""
        found: T = _reader(self.file.parent)(self.file)
        return found


@contextmanager
def share(values: Iterable[T], folder: Path) -> Iterator[list[Shared[T]]]:
    """Values that workers read until the end of the block, also workers of another user.

    Args:
        folder: That all workers see.

    Raises:
        OutputError: The folder cannot be written.
    """
    with temporary_folder("eigenfield-shared", folder) as place:
        handles = []
        with output_errors(folder):
            place.chmod(0o755 | 0o777 & ~current_umask())  # they also write results there, if the umask lets them
            for number, value in enumerate(values):
                handles.append(Shared[T](place / str(number)))
                handles[-1].file.write_bytes(pickle.dumps(value))
                handles[-1].file.chmod(0o644)
        try:
            yield handles
        finally:
            _reader.cache_clear()  # of this process, where that is the worker


@lru_cache(maxsize=1)
def _reader(folder: Path) -> Callable[[Path], Any]:
    """Reads values of a folder, and keeps some; those of another folder, which are not needed any more, go."""
    return lru_cache(maxsize=KEPT_VALUES)(lambda file: pickle.loads(file.read_bytes()))
