"""Where tasks run: in this process, in processes of this machine, or on a cluster. Everything else knows `submit`.

A task takes and returns paths and small numbers: results are files, which appear by rename. The bytes do not depend
on where it runs.
"""

from __future__ import annotations

import contextlib
import logging
import os
import queue
import secrets
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context, parent_process
from multiprocessing.connection import wait as wait_for_sentinel
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from eigenfield.core.errors import OptionError, OutputError, WorkerError
from eigenfield.runtime.children import kill_children
from eigenfield.runtime.files import output_errors
from eigenfield.runtime.objects import address_of, find_objects
from eigenfield.runtime.parallel import set_threads, threads
from eigenfield.runtime.tasks import Task, Workers, machine_memory, missing_extra, name_worker, too_big
from eigenfield.runtime.temporary import remove_temporaries, temporary_file

T = TypeVar("T")

ATTEMPTS = 3  # of a task whose worker is killed or has no memory left; the last one has all memory for itself
AHEAD = 4  # tasks in flight for each worker: the next ones wait where the workers are, the others are not yet made
SHARED_SECONDS = 3.0  # after which a new file is seen wherever a folder is shared

log = logging.getLogger("eigenfield.executor")


class ThisProcess(Workers):
    """Each task runs when it is submitted."""

    def submit(self, function: Callable[..., T], /, *args: Any, **named: Any) -> Future[T]:
        future: Future[T] = Future()
        try:
            future.set_result(function(*args, **named))
        except Exception as error:
            future.set_exception(error)
        return future


class LocalProcesses(Workers):
    """Processes of this machine, a pool for each: where one is killed, the others go on, and its task is run again."""

    def __init__(self, count: int, threads_each: int) -> None:
        self._count, self._threads = count, threads_each
        self._memory = _Budget(machine_memory())
        self._idle: queue.SimpleQueue[_Process] = queue.SimpleQueue()
        self._processes = [_Process(threads_each) for _ in range(count)]
        for process in self._processes:
            self._idle.put(process)
        self._hands = ThreadPoolExecutor(count, thread_name_prefix="eigenfield-worker")
        self._stopped = False

    @property
    def width(self) -> int:
        return self._count

    def submit(self, function: Callable[..., T], /, *args: Any, **named: Any) -> Future[T]:
        task = function if isinstance(function, Task) else Task(function)
        return self._hands.submit(self._run, task, args, named)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """As of every executor; with `wait` false, running tasks are killed."""
        self._stopped = not wait
        if self._stopped:
            self._memory.close()
        self._hands.shutdown(wait=False, cancel_futures=cancel_futures or self._stopped)
        for process in self._processes if self._stopped else ():
            process.kill()
        self._hands.shutdown()
        for process in self._processes:
            process.close()

    def _run(self, task: Task, args: tuple[Any, ...], named: dict[str, Any]) -> Any:
        if task.memory > self._memory.total:
            raise too_big(task.memory, self._memory.total)
        for attempt in range(1, ATTEMPTS + 1):
            with self._memory.taken(self._memory.total if attempt == ATTEMPTS else task.memory):
                process = self._idle.get()
                try:
                    return process.call(task, args, named)
                except (BrokenProcessPool, MemoryError) as error:
                    if self._stopped:
                        raise WorkerError("stopped", "was stopped") from None
                    words = "had no memory left" if isinstance(error, MemoryError) else "was killed"
                    log.info("a worker %s while it ran %s", words, task.__name__)
                finally:
                    self._idle.put(process)
        raise WorkerError(
            "worker-killed",
            f"its worker {words} {ATTEMPTS} times, the last time alone on this machine",
            remedy="use a machine with more memory, or fewer or smaller photographs",
        )


class _Process:
    """A pool of one process, which is made when it is needed, and anew after it was killed."""

    def __init__(self, threads_each: int) -> None:
        self._threads = threads_each
        self._pool: ProcessPoolExecutor | None = None
        self._pid: int | None = None
        self._killed = False

    def call(self, task: Task, args: tuple[Any, ...], named: dict[str, Any]) -> Any:
        if self._killed:
            raise BrokenProcessPool
        try:
            return self._started().submit(task, *args, **named).result()
        except BrokenProcessPool:
            self.close()
            raise

    def kill(self) -> None:
        """End it now, and for good."""
        self._killed = True
        if self._pid is not None:
            with contextlib.suppress(OSError):
                os.kill(self._pid, signal.SIGTERM)

    def close(self) -> None:
        pool, self._pool, self._pid = self._pool, None, None
        if pool is not None:
            pool.shutdown()

    def _started(self) -> ProcessPoolExecutor:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(1, get_context("spawn"), _begin_worker, (self._threads,))
            try:
                self._pid = self._pool.submit(os.getpid).result()
            except BrokenProcessPool:
                self.close()
                raise WorkerError(
                    "worker-start",
                    "a worker process ends as soon as it starts",
                    remedy='in a script of yours, call it below `if __name__ == "__main__":`',
                ) from None
            if self._killed:  # meanwhile
                self.kill()
        return self._pool


class _Budget:
    """Bytes of memory that tasks share."""

    def __init__(self, total: float) -> None:
        self.total = self._left = total
        self._open = True
        self._changed = threading.Condition()

    @contextlib.contextmanager
    def taken(self, size: float) -> Iterator[None]:
        """Wait until so much is free, and hold it."""
        with self._changed:
            self._changed.wait_for(lambda: self._left >= size or self._left == self.total or not self._open)
            self._left -= size
        try:
            yield
        finally:
            with self._changed:
                self._left += size
                self._changed.notify_all()

    def close(self) -> None:
        """Let nobody wait any longer."""
        with self._changed:
            self._open = False
            self._changed.notify_all()


@contextlib.contextmanager
def open_executor(workers: int | None = None, cluster: str | None = None) -> Iterator[Workers]:
    """Where tasks run, until the end of the block: tasks that run when it raises are stopped.

    Args:
        workers: Number of processes of this machine, which share its processors; with a cluster, of workers that are
            waited for, or asked of SLURM. None: this process; with a cluster whatever is there.
        cluster: Address of a Dask scheduler ("tcp://host:8786"), "slurm", or "ssh:HOST,HOST".

    Raises:
        OptionError: `workers`, `cluster-extra`.
        WorkerError: The scheduler cannot be reached, no worker comes, or one runs another version.
    """
    if workers is not None and workers < 1:
        raise OptionError("workers", f"{workers} workers were asked for", remedy="ask for 1 or more")
    if cluster is not None:
        try:
            from eigenfield.runtime.cluster import open_cluster
        except ModuleNotFoundError as error:
            if error.name is None or error.name.startswith("eigenfield"):
                raise
            raise missing_extra(error.name) from None
        with open_cluster(cluster, workers) as reached:
            yield reached
        return
    executor: Workers = ThisProcess() if workers is None else LocalProcesses(workers, max(1, threads() // workers))
    try:
        yield executor
    except BaseException:
        executor.shutdown(wait=False)
        raise
    executor.shutdown()


def as_finished(workers: Workers, calls: Iterable[tuple[Any, ...]]) -> Iterator[tuple[int, Future[Any]]]:
    """Run calls, and yield the number of each with its future when it has ended.

    `calls` is read as workers become free, so that of many calls only a few exist at a time.

    Args:
        calls: A function or a `Task`, and its arguments.
    """
    running: dict[Future[Any], int] = {}
    waiting = enumerate(calls)
    more = True
    try:
        while running or more:
            while more and len(running) < (1 if workers.width == 1 else AHEAD * workers.width):
                number, call = next(waiting, (-1, ()))
                if number < 0:
                    more = False
                else:
                    running[workers.submit(*call)] = number
            for future in wait(running, return_when=FIRST_COMPLETED).done if running else ():
                yield running.pop(future), future
    finally:
        for future in running:
            future.cancel()


def spread(workers: Workers, calls: Iterable[tuple[Any, ...]]) -> Iterator[Any]:
    """The results of calls in their order, which may have ended in another; the first error in this order is raised.

    Args:
        calls: A function or a `Task`, and its arguments.
    """
    early: dict[int, Future[Any]] = {}
    following = 0
    for number, future in as_finished(workers, calls):
        early[number] = future
        while following in early:
            yield early.pop(following).result()
            following += 1


def refuse_unshared(workers: Workers, folder: Path) -> None:
    """Raise OutputError `folder-not-shared`, with the worker's name, if a worker does not see a folder of this one.

    Of an address it is enough that workers reach its bucket.
    """
    if find_objects(folder):
        refuse_unseen(workers, folder)
        return
    token = secrets.token_hex(8)
    with output_errors(folder), temporary_file("eigenfield-shared", folder) as path:
        path.write_text(token, encoding="ascii")
        path.chmod(0o644)  # workers may run as another user
        for name, read in workers.everywhere(_read_token, path).items():
            if read != token:
                remedy = "name a folder that all machines share under the same path"
                raise OutputError("folder-not-shared", f"{name} does not see it", path=folder, remedy=remedy)


def refuse_unseen(workers: Workers, path: Path) -> None:
    """Raise OutputError `folder-not-shared`, with the worker's name, if a worker does not see what is read."""
    for name, fault in workers.everywhere(_fault_of, path).items():
        if fault is not None:
            remedy = "put it where all machines see it under the same path"
            raise OutputError("folder-not-shared", f"{name} {fault}", path=address_of(path), remedy=remedy)


def _fault_of(path: Path) -> str | None:
    """Why this process cannot read a path, or reach the bucket of an address."""
    try:
        objects = find_objects(path)
        if objects is None:
            return None if path.exists() else "does not see it"
        objects.check_bucket()
    except OptionError as error:
        return f"cannot read it: {error.message}"
    return None


def _read_token(path: Path) -> str | None:
    until = time.monotonic() + SHARED_SECONDS
    while True:
        with contextlib.suppress(OSError):
            return path.read_text(encoding="ascii")
        if time.monotonic() > until:
            return None
        time.sleep(0.2)


def _begin_worker(threads_each: int) -> None:
    """In a new process: it ends with its parent, which alone hears Ctrl-C."""
    set_threads(threads_each)
    name_worker(f"process {os.getpid()}")
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda *_: _end_worker())
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        wait_for_sentinel([parent.sentinel])
        _end_worker()


def _end_worker() -> NoReturn:
    kill_children()
    remove_temporaries()
    os._exit(143)
