"""Libraries that take minutes, cannot be interrupted or end their process, in a process of their own."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import ProxyError

TICK = 0.2  # seconds between two calls of `waiting`


def run_child(
    script: Path, arrays: Sequence[NDArray[Any]], waiting: Callable[[], None], code: str, name: str, remedy: str
) -> bytes:
    """What `script` writes to standard output when `arrays` come in (as `numpy.save` writes).

    waiting: called while the child works; the child is ended when the waiting is (Ctrl-C, or an exception from
    `waiting`). Raises ProxyError `code`, saying how `name` ended, with the remedy.
    """
    command = [sys.executable, "-P", str(script)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(entry for entry in sys.path if entry)}
    with tempfile.TemporaryFile() as message:  # a pipe would stay half sent when `communicate` runs into its timeout
        for array in arrays:
            np.save(message, array, allow_pickle=False)
        message.seek(0)
        process = subprocess.Popen(
            command, stdin=message, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment
        )
    try:
        while True:
            try:
                answer, complaint = process.communicate(timeout=TICK)
                break
            except subprocess.TimeoutExpired:
                waiting()
    except BaseException:
        process.kill()
        process.communicate()
        raise
    if process.returncode != 0:
        last = complaint.decode(errors="replace").strip().splitlines()[-1:]
        raise ProxyError(code, f"{name} ended with {process.returncode}{': ' + last[0] if last else ''}", remedy=remedy)
    return answer
