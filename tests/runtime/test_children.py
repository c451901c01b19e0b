"""Child processes end with the process that started them, however it ends."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import pytest

from eigenfield.runtime.children import child_process

PIPES = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
SLEEP = [sys.executable, "-c", "import os, time; print(os.getpid(), flush=True); time.sleep(120)"]
PARENT = f"""
import subprocess, sys, threading
import eigenfield.cli as cli
from eigenfield.runtime.children import child_process

def work(*words):
    def wait():
        with child_process({SLEEP!r}, stdout=subprocess.PIPE) as child:
            print(child.stdout.readline().decode(), end="", flush=True)
            child.communicate()
    thread = threading.Thread(target=wait, daemon=True)
    thread.start()
    wait()

sys.argv = ["eigenfield", "info", "x"]
cli.group.invoke = work
cli.main()
"""


def ends(number: int) -> bool:
    """Whether a process ends within some seconds."""
    for _ in range(200):
        try:
            os.kill(number, 0)
        except ProcessLookupError:
            return True
        with open(f"/proc/{number}/stat") as file:  # noqa: PTH123
            if file.read().rpartition(")")[2].split()[0] == "Z":
                return True
        time.sleep(0.05)
    return False


def test_words_and_answers_pass():
    with child_process([sys.executable, "-c", "import sys; print(sys.argv[1:])", "a b", "c"], **PIPES) as process:
        answer, _ = process.communicate()
    assert answer.decode().strip() == "['a b', 'c']" and process.returncode == 0


def test_a_block_that_raises_kills_it():
    with pytest.raises(ValueError), child_process(SLEEP, **PIPES) as process:
        raise ValueError
    assert process.returncode not in (None, 0)


@pytest.mark.skipif(sys.platform != "linux", reason="the kernel kills the children of a killed process on Linux")
@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGTERM, signal.SIGINT, signal.SIGKILL], ids=lambda n: n.name)
def test_a_stopped_process_takes_its_children_along(number):
    with subprocess.Popen([sys.executable, "-c", PARENT], **PIPES) as parent:
        assert parent.stdout is not None
        children = [int(parent.stdout.readline()) for _ in range(2)]
        parent.send_signal(number)
        start = time.monotonic()
        parent.wait(timeout=30)
        assert time.monotonic() - start < 10
    assert all(map(ends, children))
    assert parent.returncode == (-number if number == signal.SIGKILL else 130)
