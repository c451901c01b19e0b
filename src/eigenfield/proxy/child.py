"""Child processes for libraries that take minutes, cannot be interrupted, or end their process."""

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
from eigenfield.runtime.children import child_process
from eigenfield.runtime.files import output_errors

CHILD_POLL_SECONDS = 0.2  # between two calls of `on_wait`


def run_child(
    script: Path,
    arrays: Sequence[NDArray[Any]],
    on_wait: Callable[[], None],
    code: str,
    name: str,
    remedy: str,
    words: Sequence[str] = (),
) -> bytes:
    """What a script writes to standard output when arrays come in (as `numpy.save` writes).

    Args:
        on_wait: Called while the child works. If it raises, or on Ctrl-C, the child is killed.
        words: Arguments of the script.

    Raises:
        ProxyError: `code`: the child failed.
        OutputError: There is no room for the arrays in the system's temporary folder.
    """
    command = [sys.executable, "-P", str(script), *words]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(entry for entry in sys.path if entry)}
    with tempfile.TemporaryFile() as message:  # `communicate` would leave a pipe half sent at its timeout
        with output_errors(tempfile.gettempdir()):
            for array in arrays:
                np.save(message, array, allow_pickle=False)
            message.seek(0)
        pipes: dict[str, Any] = {"stdin": message, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        with child_process(command, **pipes, env=environment) as process:
            while True:
                try:
                    answer, complaint = process.communicate(timeout=CHILD_POLL_SECONDS)
                    break
                except subprocess.TimeoutExpired:
                    on_wait()
    if process.returncode != 0:
        last = complaint.decode(errors="replace").strip().splitlines()[-1:]
        raise ProxyError(code, f"{name} ended with {process.returncode}{': ' + last[0] if last else ''}", remedy=remedy)
    return answer
