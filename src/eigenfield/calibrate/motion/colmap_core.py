"""pycolmap, quiet, and able to be interrupted.

COLMAP logs to standard error from C++; nothing of it concerns the person at the terminal. Signals reach only the main
thread of the interpreter, and only between its own instructions: long calls therefore run in another.
"""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

T = TypeVar("T")

FATAL = 3  # glog's severity
POLL = 0.1  # seconds


@contextlib.contextmanager
def _signals_held_back() -> Iterator[None]:
    """Ctrl-C and SIGTERM arrive at the end of the block: inside pycolmap's initialisation the first hangs, and glog
    takes the second for itself, to die by it without cleaning up."""
    caught: list[int] = []
    handlers: dict[int, Any] = {}
    with contextlib.suppress(ValueError):  # not in the main thread, where none arrive
        for number in (signal.SIGINT, signal.SIGTERM):
            if signal.getsignal(number) is not None:
                handlers[number] = signal.signal(number, lambda number, _: caught.append(number))
    try:
        yield
    finally:
        for taken, handler in handlers.items():
            signal.signal(taken, handler)
    for late in caught:
        signal.raise_signal(late)


with _signals_held_back():
    import pycolmap as pycolmap  # the other modules import it from here

pycolmap.logging.minloglevel = FATAL
pycolmap.logging.logtostderr = False
pycolmap.logging.stderrthreshold = FATAL


class StoppedError(Exception):
    """Raised within the work when the waiting thread has given up."""


def interruptible(work: Callable[[Callable[[], None]], T]) -> T:
    """`work(check)` in a thread of its own: what it returns or raises.

    `work` calls `check` now and then, which ends it (by an exception) once the waiting thread was interrupted; the
    interruption goes on when the work has ended.
    """
    stop = threading.Event()
    result: list[T] = []
    failure: list[BaseException] = []

    def check() -> None:
        if stop.is_set():
            raise StoppedError

    def run() -> None:
        try:
            result.append(work(check))
        except BaseException as error:
            failure.append(error)

    thread = threading.Thread(target=run, name="eigenfield-colmap", daemon=True)
    thread.start()
    try:
        while thread.is_alive():
            thread.join(POLL)
    except BaseException:
        stop.set()
        thread.join()
        raise
    if failure:
        raise failure[0]
    return result[0]
