"""A forked child works as its parent does, and leaves to it what is its parent's."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading

import pytest

from eigenfield.core import scene
from eigenfield.core.errors import WorkerError
from eigenfield.runtime import children, parallel, signals, temporary
from eigenfield.runtime.children import child_process
from eigenfield.runtime.parallel import parallel_map, parallel_stream, set_threads
from eigenfield.runtime.temporary import temporary_folder

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork"),
    pytest.mark.filterwarnings("ignore:This process:DeprecationWarning"),  # of Python 3.12: it has threads
]
HANGS_SECONDS = 20


def forked(work) -> int:
    """The exit code of a child that does `work`: 9 for an assertion that fails."""
    child = os.fork()
    if child == 0:
        code = 9
        signal.alarm(HANGS_SECONDS)
        try:
            work()
            code = 0
        finally:
            os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


@pytest.fixture
def two_threads():
    set_threads(2)
    yield
    set_threads(None)


def squares() -> None:
    assert parallel_map(lambda value: value * value, range(5)) == [0, 1, 4, 9, 16]


def test_a_child_and_its_child_have_threads_of_their_own(two_threads):
    squares()
    assert forked(squares) == 0
    assert forked(lambda: squares() or os._exit(forked(squares))) == 0
    squares()


def test_a_child_does_not_wait_for_what_another_thread_was_at(two_threads):
    """Each lock is held by another thread while the child begins."""
    locks = [parallel._lock, temporary._gate, children._gate, signals._held, scene._lock]
    taken, done = threading.Event(), threading.Event()

    def hold():
        for lock in locks:
            lock.acquire()
        taken.set()
        done.wait()
        for lock in locks:
            lock.release()

    thread = threading.Thread(target=hold)
    thread.start()
    taken.wait()

    def work():
        squares()
        with temporary_folder(), child_process([sys.executable, "-c", ""]) as process:
            process.wait()
        with scene._lock, signals.hold_signals():
            pass

    assert forked(work) == 0
    done.set()
    thread.join()


def test_a_child_cannot_go_on_with_its_parents_work(two_threads):
    stream = parallel_stream(lambda value: value, range(20))
    next(stream)

    def go_on():
        with pytest.raises(WorkerError, match="spawn") as caught:
            list(stream)
        assert caught.value.code == "forked"

    assert forked(go_on) == 0
    assert forked(stream.close) == 0  # as at its end
    assert list(stream) == list(range(1, 20))


def test_the_end_of_a_child_takes_nothing_from_its_parent(tmp_path):
    """An error that leaves the blocks of the parent, and a signal that ends the child."""
    sleeping = [sys.executable, "-c", "input()"]
    with contextlib.ExitStack() as blocks:
        folder = blocks.enter_context(temporary_folder(folder=tmp_path))
        process = blocks.enter_context(child_process(sleeping, stdin=subprocess.PIPE))

        def end_by_signal():
            children.kill_children()
            temporary.remove_temporaries()

        def end_by_error():
            with temporary_folder(folder=tmp_path) as own:
                pass
            assert not own.exists()
            blocks.__exit__(SystemExit, SystemExit(), None)

        assert forked(end_by_signal) == forked(end_by_error) == 0
        assert folder.is_dir() and process.poll() is None
        process.communicate(b"\n")
    assert list(tmp_path.iterdir()) == []
