"""Signals, and an end of the process, that wait until a step is done."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator
from typing import Any

from eigenfield.core.forks import renew_in_child

# those that ask a process to stop. Windows has no SIGHUP, but SIGBREAK, which comes when its console is closed
_STOP_NAMES = "SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK"
STOP_SIGNALS = tuple(getattr(signal, name) for name in _STOP_NAMES if hasattr(signal, name))

_held = threading.RLock()


@renew_in_child
def _renew_lock() -> None:
    global _held
    _held = threading.RLock()


def end_no_step() -> None:
    """Wait until no step runs that holds signals, and let none begin: for whoever is about to end the process."""
    _held.acquire()


@contextlib.contextmanager
def hold_signals() -> Iterator[None]:
    """Deliver the signals that ask to stop at the end of the block."""
    caught: list[int] = []
    handlers: dict[int, Any] = {}
    try:
        with contextlib.suppress(ValueError):  # not in the main thread, where none arrive
            for number in STOP_SIGNALS:
                if signal.getsignal(number) is not None:
                    handlers[number] = signal.signal(number, lambda number, _: caught.append(number))
        with _held:
            yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
    for number in caught:
        signal.raise_signal(number)
