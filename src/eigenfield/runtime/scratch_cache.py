"""What lies in scratch files and is needed again: it stays open as long as there is room on the disk."""

from __future__ import annotations

import contextlib
import shutil
import tempfile
from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol, TypeVar

from eigenfield.runtime.files import output_errors

FREE_SHARE = 0.25  # of the disk's free space that a cache takes at most


class Sized(Protocol):
    """What lies in scratch files, of so many bytes."""

    @property
    def nbytes(self) -> int: ...


T = TypeVar("T", bound=Sequence[Sized])


@dataclass(eq=False)
class ScratchCache:
    """Values in scratch files, by key.

    Attributes:
        left: Bytes that it has room for; 0: it keeps nothing.
    """

    left: int
    _values: dict[Hashable, Any] = field(default_factory=dict)
    _opened: contextlib.ExitStack = field(default_factory=contextlib.ExitStack)

    @contextlib.contextmanager
    def open(self, key: Hashable, make: Callable[[], contextlib.AbstractContextManager[T]]) -> Iterator[T]:
        """The value of a key, which is opened by `make` where it is not there, and stays where there is room for it."""
        if key in self._values:
            yield self._values[key]
            return
        with contextlib.ExitStack() as own:
            value = own.enter_context(make())
            size = sum(one.nbytes for one in value)
            if size < self.left:
                self.left -= size
                self._values[key] = value
                self._opened.push(own.pop_all())
            yield value


@contextlib.contextmanager
def open_scratch_cache(most: int, folder: Path | None = None) -> Iterator[ScratchCache]:
    """An empty cache, whose files go at the end.

    Args:
        most: Bytes that it may take; where the disk has little room, it is FREE_SHARE of that.
        folder: Of its files; None: the system's temporary folder.
    """
    place = Path(tempfile.gettempdir()) if folder is None else folder
    with output_errors(place):
        room = min(most, int(FREE_SHARE * shutil.disk_usage(place).free))
    cache = ScratchCache(room)
    with cache._opened:
        yield cache
