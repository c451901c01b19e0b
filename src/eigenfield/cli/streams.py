"""Standard streams that are closed, full or gone, for all that writes to them: `click.echo`, rich and `logging`."""

from __future__ import annotations

import io
import os
import sys
from typing import Any

from eigenfield.core.errors import OutputError


def prepare_streams() -> None:
    """Let closed streams lead nowhere, and the others bear what happens to them.

    A file that is opened while a stream is closed would get its number, and then also what a library prints. Names that
    a stream's encoding does not have are written as escapes.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        stream = getattr(sys, name)
        if stream is None:
            nothing = os.open(os.devnull, os.O_RDWR)  # the lowest number that is free
            os.set_inheritable(nothing, True)
            setattr(sys, name, os.fdopen(nothing, "r" if name == "stdin" else "w", encoding="utf-8"))
        elif name != "stdin" and isinstance(stream, io.TextIOWrapper):
            raw = getattr(stream.buffer, "raw", stream.buffer)
            if type(raw) is io.FileIO and raw.fileno() == number:  # not a console of Windows
                lines, through = stream.line_buffering, stream.write_through
                buffer = io.BufferedWriter(_Stream(number))
                stream = io.TextIOWrapper(buffer, stream.encoding, line_buffering=lines, write_through=through)
                setattr(sys, name, stream)
            stream.reconfigure(errors="backslashreplace")


class _Stream(io.FileIO):
    """Standard output, whose failure is an OutputError, or standard error, for which no work is given up."""

    def __init__(self, number: int) -> None:
        super().__init__(number, "w", closefd=False)
        self._failed = False

    def write(self, data: Any, /) -> int:
        """As of FileIO. Once it has failed it writes nothing, so that the end of the process complains of nothing."""
        if self._failed:
            return memoryview(data).nbytes
        try:
            return super().write(data)
        except BrokenPipeError:
            raise
        except OSError as error:
            self._failed = True
            if self.fileno() == 1:
                raise _output_error(error) from error
            return memoryview(data).nbytes


def _output_error(error: OSError) -> OutputError:
    from eigenfield.runtime.files import output_errors  # brings NumPy, which takes long to load

    place = "standard output"
    try:
        with output_errors(place):
            raise error
    except OutputError as known:
        return known
    except OSError:
        return OutputError("not-writable", error.strerror or "cannot be written", path=place, remedy="write to a file")
