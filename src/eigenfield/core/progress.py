"""Progress of long work: a callback, no more. Only `cli/` draws bars."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Protocol, TypeVar

T = TypeVar("T")


class Progress(Protocol):
    """Called as `progress(stage, done, total)`: `done` of `total` steps of `stage` are finished.

    The first call has done = 0 and the last done = total; calls come from one thread at a time. An exception that it
    raises ends the work.
    """

    def __call__(self, stage: str, done: int, total: int) -> None: ...


def begin_step(progress: Progress | None, step: str) -> None:
    """Say that a step of long work begins. It has stages of its own, or none.

    Args:
        progress: Told if it has a method `begin`, which a plain function has not.
    """
    begin = getattr(progress, "begin", None)
    if begin is not None:
        begin(step)


def tell_remaining(progress: Progress | None, seconds: float) -> None:
    """Say about how long the rest will take.

    Args:
        progress: Told if it has a method `remaining`, which a plain function has not.
        seconds: From now.
    """
    remaining = getattr(progress, "remaining", None)
    if remaining is not None:
        remaining(seconds)


def track(items: Iterable[T], stage: str, total: int, progress: Progress | None) -> Iterator[T]:
    """Yield `items`, and report each one once the consumer is done with it.

    Args:
        progress: Called before the first item and after each; None: not called.
    """
    if progress is not None:
        progress(stage, 0, total)
    for done, item in enumerate(items, 1):
        yield item
        if progress is not None:
            progress(stage, done, total)
