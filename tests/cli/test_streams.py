"""Standard streams that are closed or full, and what a machine lacks: one line, and no output is lost."""

from __future__ import annotations

import contextlib
import errno
import logging
import os
import sys
from pathlib import Path

import click
import numpy as np
import pytest

import eigenfield.cli as cli
from eigenfield.cli.limits import limit_of
from support.program import call

CLOSED, FULL = "closed", "/dev/full"
NAMES = "stdin", "stdout", "stderr"


def work(place: Path) -> None:
    """What verbs do: a note, a warning, a file, which must not get what a library prints, and a result."""
    click.echo("a note", err=True)
    logging.getLogger("eigenfield").warning("a warning")
    with (place / "output").open("wb") as file:
        with contextlib.suppress(OSError):
            os.write(2, b"of a library")
        file.write(b"output")
    click.echo("a result")


@pytest.mark.skipif(not Path(FULL).exists(), reason="this system has no /dev/full")
@pytest.mark.parametrize(
    ("streams", "code", "out"),
    [
        ({"stderr": CLOSED}, 0, "a result\n"),
        ({"stdin": CLOSED}, 0, "a result\n"),
        ({"stdout": CLOSED}, 0, ""),
        ({"stdin": CLOSED, "stdout": CLOSED, "stderr": CLOSED}, 0, ""),
        ({"stderr": FULL}, 0, "a result\n"),
        ({"stdout": FULL}, 2, ""),
        ({"stdout": FULL, "stderr": FULL}, 2, ""),
    ],
)
def test_no_output_is_lost_with_a_stream(tmp_path, monkeypatch, streams, code, out):
    places = {name: Path(streams.get(name, tmp_path / name)) for name in NAMES}
    monkeypatch.setattr(cli.group, "invoke", lambda *_: work(tmp_path))
    child = os.fork()
    if child == 0:
        status = 1
        try:
            for number, name in enumerate(NAMES):
                if streams.get(name) == CLOSED:
                    continue
                handle = os.open(places[name], os.O_RDWR | os.O_CREAT)
                os.dup2(handle, number)
                os.close(handle)
            for number, name in enumerate(NAMES):
                if streams.get(name) == CLOSED:
                    os.close(number)
            for number, name in enumerate(NAMES):  # as Python does at its start
                closed = streams.get(name) == CLOSED
                setattr(sys, name, None if closed else os.fdopen(number, "r" if number == 0 else "w", closefd=False))
            status = call("info", "x.glb")
            sys.stdout.flush()
        finally:
            os._exit(status)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == code
    assert (tmp_path / "output").read_bytes() == b"output"
    said = {name: place.read_text() if place.parent == tmp_path else "" for name, place in places.items()}
    assert said["stdout"] == out
    if "stderr" not in streams:
        assert "a note\n" in said["stderr"]
        assert ("eigenfield: standard output: no room left" in said["stderr"]) == (code == 2)


def raised(error: Exception, cause: Exception | None = None) -> Exception:
    error.__cause__ = cause
    return error


@pytest.mark.parametrize(
    ("error", "word"),
    [
        (MemoryError(), "memory"),
        (OSError(errno.ENOMEM, "Cannot allocate memory"), "memory"),
        (ImportError("libav.so: failed to map segment from shared object"), "memory"),
        (raised(ImportError("numpy could not be imported"), ImportError("x.so: cannot allocate memory")), "memory"),
        (raised(OSError("no libllvmlite.so"), OSError("x.so: failed to map segment")), "memory"),
        (OSError(errno.ELOOP, "Too many levels of symbolic links", "x.glb"), "x.glb"),
        (OSError(errno.EMFILE, "Too many open files"), "ulimit -n"),
        (RuntimeError("can't start new thread"), "thread"),
        (BlockingIOError(errno.EAGAIN, "Resource temporarily unavailable"), "thread"),
        (OSError(errno.ENOSPC, "No space left on device"), "disk"),
    ],
)
def test_what_a_machine_lacks_is_one_line(run, monkeypatch, error, word):
    def fails(*_: object) -> None:
        raise error

    monkeypatch.setattr(cli.group, "invoke", fails)
    code, out, err = run("info", "x.glb")
    assert (code, out) == (2, "") and err.count("\n") == 1 and word in err


def test_a_bug_is_none_of_it():
    with pytest.raises(ValueError) as caught:
        np.zeros(3).reshape(2)
    assert limit_of(caught.value) is limit_of(KeyError("x")) is limit_of(OSError(errno.EINVAL, "Invalid")) is None
