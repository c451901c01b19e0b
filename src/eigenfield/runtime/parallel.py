"""Threads: kernels release the GIL and work on fixed pieces, so the result never depends on the number of threads.

No OpenMP, no `prange`: numba's default threading layer ends the process when two Python threads enter it, and
`render` is to be callable from any thread.
"""

from __future__ import annotations

import contextlib
import os
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from itertools import pairwise
from pathlib import Path
from queue import SimpleQueue
from typing import Any, TypeVar

from eigenfield.core.arguments import checked
from eigenfield.core.errors import OptionError, WorkerError
from eigenfield.core.forks import renew_in_child
from eigenfield.core.progress import Progress, track

A = TypeVar("A")
B = TypeVar("B")
TASKS_FOLDER = Path("/proc/self/task")  # on Linux, this process's threads


class _Pool:
    """Daemon threads that take work from one queue.

    Not a ThreadPoolExecutor: when Ctrl-C meets it between starting a thread and registering it, the interpreter waits
    for that thread for ever at its end.
    """

    def __init__(self, count: int) -> None:
        self._work: SimpleQueue[tuple[Future[Any], Callable[[Any], Any], Any] | None] = SimpleQueue()
        self._count = 0
        self.is_forked = False  # its threads are those of the parent of this process
        self._open = True
        self._gate = threading.Lock()
        for number in range(count):
            try:
                threading.Thread(target=self._run, name=f"eigenfield-{number}", daemon=True).start()
            except RuntimeError:  # the system has no more of them: fewer do the work as well
                if self._count == 0:
                    raise
                break
            self._count += 1

    def _run(self) -> None:
        _thread_state.worker = True
        while (task := self._work.get()) is not None:
            future, function, item = task
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(function(item))
                except BaseException as error:
                    future.set_exception(error)
            del task, future, function, item  # what they hold must not live until the next task comes

    def submit(self, function: Callable[[A], B], item: A) -> Future[B]:
        future: Future[B] = Future()
        with self._gate:
            if self._open:
                self._work.put((future, function, item))
                return future
        future.set_result(function(item))  # another thread has closed it: no one is left to take the work
        return future

    def result(self, future: Future[B]) -> B:
        """What a task returns or raises.

        Raises:
            WorkerError: `forked`: this process was forked while its parent worked, and is to go on with that work.
        """
        if self.is_forked:
            message = "this process was forked in the middle of the work, whose threads stayed with its parent"
            raise WorkerError("forked", message, remedy='start processes by the method "spawn"')
        return future.result()

    def close(self) -> None:
        """Let the threads end once the queue is empty."""
        with self._gate:
            self._open = False
            for _ in range(self._count):
                self._work.put(None)


_lock = threading.Lock()
_thread_state = threading.local()
_threads: int | None = None
_pool: _Pool | None = None


@renew_in_child
def _forget_pool() -> None:
    global _lock, _thread_state, _pool
    if _pool is not None:
        _pool.is_forked = True
    _lock, _thread_state, _pool = threading.Lock(), threading.local(), None


def threads() -> int:
    """Number of threads in use: that of `set_threads`, else the processors this process may run on."""
    if _threads is not None:
        return _threads
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


@checked
def set_threads(count: int | None) -> None:
    """Use `count` threads from now on (None: as many as there are processors). Raises OptionError below 1."""
    global _threads, _pool
    if count is not None and count < 1:
        raise OptionError("threads", f"{count} threads were asked for", remedy="ask for 1 or more")
    with _lock:
        _threads = count
        if _pool is not None:
            _pool.close()
        _pool = None


def _current_pool() -> _Pool:
    global _pool
    with _lock:
        if _pool is None:
            _pool = _Pool(threads())
        return _pool


def parallel_map(function: Callable[[A], B], items: Iterable[A]) -> list[B]:
    """`[function(i) for i in items]`, the items shared among the threads, the results in order.

    Within a worker it runs serially, so that nested calls cannot wait for each other.
    """
    work = list(items)
    if threads() == 1 or len(work) < 2 or getattr(_thread_state, "worker", False):
        return [function(item) for item in work]
    return list(parallel_stream(function, work))


def parallel_stream(function: Callable[[A], B], items: Iterable[A]) -> Iterator[B]:
    """As `parallel_map`, but lazily: at most two items more than there are threads are ahead of the consumer."""
    if threads() == 1 or getattr(_thread_state, "worker", False):
        yield from map(function, items)
        return
    pool = _current_pool()
    pending: list[Future[B]] = []
    try:
        for item in items:
            pending.append(pool.submit(function, item))
            if len(pending) > threads() + 2:
                yield pool.result(pending.pop(0))
        while pending:
            yield pool.result(pending.pop(0))
    finally:
        if pool.is_forked:  # nobody works on them in this process
            pending.clear()
        for future in pending:
            future.cancel()
        for future in pending:  # whoever uses the same buffers next must not meet a straggler
            if not future.cancelled():
                future.exception()


def tracked_map(
    function: Callable[[A], B], items: Sequence[A], stage: str, progress: Progress | None = None
) -> list[B]:
    """As `parallel_map`, reporting each item as a step of a stage."""
    return list(track(parallel_stream(function, items), stage, len(items), progress))


@contextlib.contextmanager
def ordinary_scheduling() -> Iterator[None]:
    """Threads that become real-time within, the calling one or new ones, are made ordinary again at the end (Linux).

    For SVT-AV1: run by root, it gives its caller and its own threads the highest real-time priority. Everything else on
    the machine then waits for them, other threads of this process too. Where OpenBLAS spins until one of those threads
    is done, it waits for ever.
    """
    before = _real_time_threads()
    try:
        yield
    finally:
        if threading.get_native_id() not in before:  # else whoever started us wants it so
            for thread in _real_time_threads() - before:
                with contextlib.suppress(OSError):  # it has ended
                    os.sched_setscheduler(thread, os.SCHED_OTHER, os.sched_param(0))


def _real_time_threads() -> set[int]:
    found: set[int] = set()
    if TASKS_FOLDER.is_dir() and hasattr(os, "sched_getscheduler"):
        for thread in (int(task.name) for task in TASKS_FOLDER.iterdir()):
            with contextlib.suppress(OSError):
                if os.sched_getscheduler(thread) in (os.SCHED_FIFO, os.SCHED_RR):
                    found.add(thread)
    return found


def pieces(total: int, size: int) -> list[tuple[int, int]]:
    """[start, stop) ranges of `size` that cover `total`; the same at any number of threads."""
    return [(start, min(start + size, total)) for start in range(0, total, size)]


def even_pieces(total: int, count: int) -> list[tuple[int, int]]:
    """`count` [start, stop) ranges that cover `total`, none of them empty; their sizes differ by at most one."""
    cuts = [total * number // count for number in range(count + 1)]
    return [(start, stop) for start, stop in pairwise(cuts) if start < stop]
