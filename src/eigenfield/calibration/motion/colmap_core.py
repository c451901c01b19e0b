"""pycolmap, silenced and interruptible.

COLMAP logs to standard error from C++, which does not concern the person at the terminal. Python delivers signals only
to the main thread, between its own instructions. Long calls therefore run in another thread.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

from eigenfield.runtime.signals import hold_signals

T = TypeVar("T")

COLMAP_LOG_FATAL = 3  # severity of glog
COLMAP_POLL_SECONDS = 0.1


# Inside pycolmap's initialisation, Ctrl-C hangs, and glog takes SIGTERM for itself and dies without cleaning up.
with hold_signals():
    import pycolmap as pycolmap  # the other modules import it from here

pycolmap.logging.minloglevel = COLMAP_LOG_FATAL
pycolmap.logging.logtostderr = False
pycolmap.logging.stderrthreshold = COLMAP_LOG_FATAL


class StoppedError(Exception):
    """Raised within the work when the waiting thread has given up."""


def run_interruptibly(work: Callable[[Callable[[], None]], T]) -> T:
    """Run work in a thread of its own, and return or raise what it returns or raises.

    Args:
        work: Is called with a function `check`, which it must call now and then. `check` raises once the waiting thread
            was interrupted. The interruption continues when the work has ended.
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
            thread.join(COLMAP_POLL_SECONDS)
    except BaseException:
        stop.set()
        thread.join()
        raise
    if failure:
        raise failure[0]
    return result[0]
