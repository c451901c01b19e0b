"""Child processes that end with this one."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from typing import Any

from eigenfield.core.forks import renew_in_child
from eigenfield.runtime.signals import hold_signals

# On Linux the kernel kills the child when this process ends, however it ends. The request survives `exec`, and is made
# after `fork` by an interpreter of its own: Python code between the two is not safe beside threads.
_LAUNCHER = (
    "import ctypes, os, signal, sys;"
    "ctypes.CDLL(None).prctl(1, signal.SIGKILL);"
    "os.getppid() == int(sys.argv[1]) or os._exit(1);"
    "os.execv(sys.argv[2], sys.argv[2:])"
)

_running: set[subprocess.Popen[bytes]] = set()
_gate = threading.RLock()  # a signal handler may come while its own thread holds it
_stopped = False


@renew_in_child
def _leave_to_parent() -> None:
    global _gate
    _gate = threading.RLock()
    _running.clear()


@contextlib.contextmanager
def child_process(command: Sequence[str], **options: Any) -> Iterator[subprocess.Popen[bytes]]:
    """A child process: killed if the block raises, by `kill_children`, and on Linux when this process is killed.

    Raises:
        KeyboardInterrupt: `kill_children` has been called.
        OSError: The program cannot be started.
    """
    if sys.platform == "linux":
        command = [sys.executable, "-I", "-S", "-c", _LAUNCHER, str(os.getpid()), *command]
    with hold_signals(), _gate:
        _refuse_when_stopped()
        process = subprocess.Popen(command, **options)
        _running.add(process)
    try:
        yield process
    except BaseException:
        if process in _running:  # else it is of the parent of this process
            process.kill()
            process.communicate()
        raise
    finally:
        _running.discard(process)
    _refuse_when_stopped()


def kill_children() -> None:
    """Kill all that run, and start no more: this process is about to end."""
    global _stopped
    with _gate:
        _stopped = True
        for process in _running.copy():
            process.kill()


def _refuse_when_stopped() -> None:
    if _stopped:
        raise KeyboardInterrupt
