"""Progress of long work: a callback, no more. Only `cli/` draws bars."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Protocol, TypeVar

T = TypeVar("T")


class Progress(Protocol):
    """Called as `progress(stage, done, total)`: `done` of `total` steps of `stage` are finished.

    Comes first with done = 0 and last with done = total, from one thread at a time. An exception that it raises
    ends the work.
    """

    def __call__(self, stage: str, done: int, total: int) -> None: ...


def track(items: Iterable[T], stage: str, total: int, progress: Progress | None) -> Iterator[T]:
    """Hand on `items`, reporting each one once the consumer is done with it."""
    if progress is not None:
        progress(stage, 0, total)
    for done, item in enumerate(items, 1):
        yield item
        if progress is not None:
            progress(stage, done, total)
