"""Temporary files: gone after the block, after a stop at any moment, and after the next run where one was killed."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from eigenfield.runtime.temporary import is_temporary, temporary_file, temporary_folder

posix = pytest.mark.skipif(os.name != "posix", reason="signals and locks")


def python(code: str, *words: object) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", code, *map(str, words)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


HOLD = """
import sys, time
from pathlib import Path
from eigenfield.runtime.temporary import temporary_file, temporary_folder
place = Path(sys.argv[1])
with temporary_folder("depth", place) as folder, temporary_file("scene.glb", place):
    (folder / "inner").mkdir()
    (folder / "inner" / "half").write_text("x")
    print("ready", flush=True)
    time.sleep(60)
"""


def test_they_are_there_in_the_block_and_gone_after_it(tmp_path):
    with temporary_folder("a", tmp_path) as folder, temporary_file("b", tmp_path) as file:
        assert folder.is_dir() and file.read_bytes() == b""
        assert is_temporary(folder) and is_temporary(file)
        (folder / "x").write_text("x")
    with pytest.raises(ValueError), temporary_folder("a", tmp_path):
        raise ValueError
    assert not list(tmp_path.iterdir())


def test_one_that_was_renamed_stays(tmp_path):
    with temporary_folder("a", tmp_path) as folder:
        folder.replace(tmp_path / "result")
    assert [path.name for path in tmp_path.iterdir()] == ["result"]


@pytest.mark.parametrize("prefix", ["ä" * 300, "ab" * 200, ".", "two words"])
def test_long_and_odd_prefixes(tmp_path, prefix):
    with temporary_file(prefix, tmp_path) as file:
        assert file.exists()


@posix
def test_what_a_killed_process_left_is_removed_by_the_next_and_nothing_else_is(tmp_path):
    (tmp_path / ".depth-notes.part").write_text("a file of the user's")
    (tmp_path / "depth-0123456789abcdef.part").write_text("another")
    (tmp_path / ".other-0123456789abcdef.part").write_text("of another prefix")
    (tmp_path / ".depth-more-0123456789abcdef.part").write_text("of a longer prefix")
    (tmp_path / ".depth-00000000000000ff.part").symlink_to(tmp_path / ".depth-notes.part")
    kept = {path.name for path in tmp_path.iterdir()}
    with python(HOLD, tmp_path) as killed, python(HOLD, tmp_path) as alive:
        assert killed.stdout and alive.stdout
        assert killed.stdout.readline() == alive.stdout.readline() == "ready\n"
        killed.send_signal(signal.SIGKILL)
        killed.wait()
        assert len({path.name for path in tmp_path.iterdir()} - kept) == 4
        with temporary_folder("depth", tmp_path), temporary_file("scene.glb", tmp_path):
            assert len({path.name for path in tmp_path.iterdir()} - kept) == 4  # of the living one, and of this
        assert len({path.name for path in tmp_path.iterdir()} - kept) == 2
        alive.kill()
    assert kept <= {path.name for path in tmp_path.iterdir()}


@posix
@pytest.mark.parametrize("moment", ["made", "locked", "before removal"])
def test_a_stop_at_any_moment_leaves_nothing(tmp_path, moment):
    """A signal between two instructions, which no `try` can rule out, while other threads write."""
    code = """
import contextlib, os, shutil, signal, sys, threading, time
from pathlib import Path
import eigenfield.cli as cli
from eigenfield.runtime import temporary

moment, place = sys.argv[1], Path(sys.argv[2])
sys.argv = ["eigenfield", "info", "x"]

def stopped(function):
    def then(*words, **options):
        mine = threading.current_thread() is threading.main_thread()
        if moment == "before removal" and mine:
            os.kill(os.getpid(), signal.SIGTERM)
        answer = function(*words, **options)
        if mine:
            os.kill(os.getpid(), signal.SIGTERM)
        return answer
    return then

def write():
    with contextlib.suppress(OSError):  # its folder goes while it writes
        write_on()

def write_on():
    with temporary.temporary_folder("thread", place) as folder:
        while True:
            (folder / str(time.monotonic_ns())).write_text("x")

def work(*words):
    threading.Thread(target=write, daemon=True).start()
    while not list(place.glob(".thread-*/*")):
        time.sleep(0.01)
    if moment == "made":
        Path.mkdir = stopped(Path.mkdir)
    elif moment == "locked":
        temporary._lock = stopped(temporary._lock)
    else:
        shutil.rmtree = stopped(shutil.rmtree)
    with temporary.temporary_folder("main", place):
        pass

cli.group.invoke = work
cli.main()
"""
    with python(code, moment, tmp_path) as process:
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130 and said == "eigenfield: interrupted\n"
    assert not list(tmp_path.iterdir())


def test_names_have_no_words_of_other_patterns(tmp_path):
    with temporary_file("scene.glb", tmp_path) as file:
        assert re.fullmatch(r"\.scene\.glb-[0-9a-f]{16}\.part", file.name)
        assert isinstance(file, Path)
