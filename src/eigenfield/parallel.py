"""Threads: kernels release the GIL and work on fixed pieces, so the result never depends on the number of threads.

No OpenMP, no `prange`: numba's default threading layer ends the process when two Python threads enter it, and
`render` is to be callable from any thread.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

from eigenfield.errors import OptionError

A = TypeVar("A")
B = TypeVar("B")

_lock = threading.Lock()
_inside = threading.local()
_threads: int | None = None
_pool: ThreadPoolExecutor | None = None


def threads() -> int:
    """Number of threads in use: what `set_threads` said, else the processors this process may run on."""
    if _threads is not None:
        return _threads
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def set_threads(count: int | None) -> None:
    """Use `count` threads from now on (None: as many as there are processors). Raises OptionError below 1."""
    global _threads, _pool
    if count is not None and count < 1:
        raise OptionError("threads", f"{count} threads were asked for", remedy="ask for 1 or more")
    with _lock:
        _threads = count
        if _pool is not None:
            _pool.shutdown(wait=False)
        _pool = None


def _executor() -> ThreadPoolExecutor:
    global _pool
    with _lock:
        if _pool is None:
            _pool = ThreadPoolExecutor(threads(), thread_name_prefix="eigenfield")
        return _pool


def _call(function: Callable[[A], B], item: A) -> B:
    _inside.worker = True
    return function(item)


def parallel_map(function: Callable[[A], B], items: Iterable[A]) -> list[B]:
    """`[function(i) for i in items]`, the items shared among the threads, the results in order.

    Within a worker it runs serially, so that nested calls cannot wait for each other.
    """
    work = list(items)
    if threads() == 1 or len(work) < 2 or getattr(_inside, "worker", False):
        return [function(item) for item in work]
    return list(parallel_stream(function, work))


def parallel_stream(function: Callable[[A], B], items: Iterable[A]) -> Iterator[B]:
    """As `parallel_map`, but lazily: at most two items more than there are threads are ahead of the consumer."""
    if threads() == 1 or getattr(_inside, "worker", False):
        yield from map(function, items)
        return
    pool = _executor()
    pending: list[Future[B]] = []
    try:
        for item in items:
            pending.append(pool.submit(_call, function, item))
            if len(pending) > threads() + 2:
                yield pending.pop(0).result()
        while pending:
            yield pending.pop(0).result()
    finally:
        for future in pending:
            future.cancel()
        for future in pending:  # whoever uses the same buffers next must not meet a straggler
            if not future.cancelled():
                future.exception()


def pieces(total: int, size: int) -> list[tuple[int, int]]:
    """[start, stop) ranges of `size` that cover `total`; the same at any number of threads."""
    return [(start, min(start + size, total)) for start in range(0, total, size)]
