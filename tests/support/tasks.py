"""Tasks for executors, which other processes import."""

from __future__ import annotations

import logging
import os
import signal
import time
from pathlib import Path

from eigenfield.core.errors import FormatError
from eigenfield.runtime.parallel import threads


def squared(number: int, seconds: float = 0.0) -> int:
    time.sleep(seconds)
    return number * number


def place() -> tuple[int, int]:
    """The process, and its number of threads."""
    return os.getpid(), threads()


def damaged() -> None:
    logging.getLogger("eigenfield.test").warning("opening %s", "a.glb")
    raise FormatError("damaged", "is damaged", where="byte 3", path="a.glb", remedy="fetch it again")


class OddError(Exception):
    """An error that cannot be unpickled."""

    def __init__(self, *, why: str) -> None:
        super().__init__(why)


def odd() -> None:
    raise OddError(why="so")


def killed(folder: Path, times: int) -> int:
    """Kill this process, the first few times that it is called with a folder."""
    for number in range(times):
        if not (folder / f"killed-{number}").exists():
            (folder / f"killed-{number}").touch()
            os.kill(os.getpid(), signal.SIGKILL)
    return os.getpid()


def without_memory(folder: Path) -> str:
    """Have no memory left, the first time that it is called with a folder."""
    if not (folder / "full").exists():
        (folder / "full").touch()
        raise MemoryError
    return "done"


def hungry(folder: Path, size: int = 800_000_000) -> str:
    """Take more memory than a worker may have, the first time that it is called with a folder; "done" the next time."""
    if not (folder / "full").exists():
        (folder / "full").touch()
        held = bytearray(size)
        held[::4096] = b"x" * len(held[::4096])
        time.sleep(20)  # the nanny looks now and then
        return "there was enough"
    return "done"
