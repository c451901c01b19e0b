"""What a task is, for whoever runs it: the function and its memory, its worker's name, and its errors, which travel."""

from __future__ import annotations

import contextlib
import hashlib
import logging
import os
import pickle
import platform
import traceback
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TypeVar

from eigenfield.core.errors import OptionError, WorkerError
from eigenfield.core.version import __version__
from eigenfield.runtime.stages import PACKAGE_FOLDER

T = TypeVar("T")

LOG_LINES = 20  # of a failed task, the last ones
CGROUP_LIMIT = Path("/sys/fs/cgroup/memory.max")
COUNTED_PACKAGES = "numpy", "scipy", "numba", "opencv-python-headless", "pycolmap", "av", "pillow", "xatlas"

_worker: str | None = None  # the name of this process, where it is a worker


@dataclass(frozen=True)
class Task:
    """A function for `submit` that says what it needs. Of a plain function nothing is known.

    Attributes:
        function: Importable by name.
        memory: Bytes that it takes at most: it meets no worker that has less.
    """

    function: Callable[..., Any]
    memory: float = 0.0

    @property
    def __name__(self) -> str:
        return self.function.__name__

    def __call__(self, *args: Any, **named: Any) -> Any:
        if _worker is None:
            return self.function(*args, **named)
        lines: list[str] = []
        with log_into(lines):
            try:
                return self.function(*args, **named)
            except Exception as error:
                sent = _that_travels(error)
                for line in (f"on {_worker}", *lines[-LOG_LINES:]):
                    sent.add_note(line)
                raise sent from None


class Workers(Executor):
    """An executor that also says how many tasks run at a time, and reaches each worker."""

    dashboard: str | None = None  # the address of a page that shows what the workers do

    @property
    def width(self) -> int:
        """How many tasks run at a time."""
        return 1

    def everywhere(self, function: Callable[..., T], *args: Any) -> dict[str, T]:
        """What a function returns on each worker, by the worker's name."""
        return {"this process": function(*args)}


def missing_extra(package: str) -> OptionError:
    """The error where a package of the extra `cluster` is not installed."""
    return OptionError("cluster-extra", f"--cluster needs {package}", remedy="pip install 'eigenfield[cluster]'")


def too_big(memory: float, most: float) -> WorkerError:
    """The error of a task for which no worker has the memory; both in bytes."""
    message = f"needs about {memory / 1e9:.1f} GB of memory, and no worker has more than {most / 1e9:.1f} GB"
    return WorkerError("task-memory", message, remedy="use larger workers, or fewer or smaller photographs")


@cache
def installed() -> dict[str, str]:
    """What bytes of results depend on: versions of the program, of Python and of packages, and a digest of sources."""
    digest = hashlib.sha256()
    for source in sorted(PACKAGE_FOLDER.rglob("*.py")):
        digest.update(f"{source.relative_to(PACKAGE_FOLDER).as_posix()}\n".encode() + source.read_bytes())
    found = {"eigenfield": f"{__version__} ({digest.hexdigest()[:12]})", "Python": platform.python_version()}
    for package in COUNTED_PACKAGES:
        with contextlib.suppress(PackageNotFoundError):
            found[package] = version(package)
    return found


def machine_memory() -> float:
    """Bytes of memory that this machine, or the container around this process, has; infinite where nobody says."""
    found = float("inf")
    if hasattr(os, "sysconf") and "SC_PHYS_PAGES" in os.sysconf_names:
        found = float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    with contextlib.suppress(OSError, ValueError):  # it may say "max"
        found = min(found, float(int(CGROUP_LIMIT.read_text(encoding="ascii"))))
    return found


def worker_name() -> str | None:
    """What this process is called; None where it is no worker."""
    return _worker


def name_worker(name: str) -> None:
    """Say what this process is called, in messages about what fails on it."""
    global _worker
    _worker = name


@contextlib.contextmanager
def log_into(lines: list[str]) -> Iterator[None]:
    """Also keep what eigenfield logs."""

    class Keep(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            lines.append(record.getMessage())

    logger, handler = logging.getLogger("eigenfield"), Keep()
    logger.addHandler(handler)
    try:
        yield
    finally:
        logger.removeHandler(handler)


def _that_travels(error: Exception) -> Exception:
    """The error, or its traceback as text where it cannot be sent to another process."""
    try:
        pickle.loads(pickle.dumps(error))
        return error
    except Exception:
        return RuntimeError("".join(traceback.format_exception(error)))
