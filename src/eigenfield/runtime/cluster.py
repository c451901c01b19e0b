"""Workers of a Dask cluster, as an executor. It needs the extra `cluster`, and so does importing it."""

from __future__ import annotations

import functools
import logging
import platform
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager, suppress
from typing import Any, TypeVar

import dask
from distributed import Client, KilledWorker, Status, Worker
from distributed.diagnostics.plugin import WorkerPlugin

from eigenfield.core.errors import OptionError, WorkerError
from eigenfield.runtime.parallel import set_threads
from eigenfield.runtime.tasks import Task, Workers, installed, machine_memory, missing_extra, name_worker, too_big

T = TypeVar("T")

CONNECT_SECONDS = 10.0
FIRST_WORKER_SECONDS = 60.0  # at a scheduler that is running; a queue may take any time
ASK_SECONDS = 5.0  # between two questions for who is there
SLURM_WORKERS = 2
LOST_REMEDY = "start it again and repeat the command: it goes on from what is finished"

log = logging.getLogger("eigenfield.executor")


class _SetUp(WorkerPlugin):  # type: ignore[misc]
    """Prepares each worker, also those that come later: one task at a time, with the worker's threads and memory."""

    name = "eigenfield"

    async def setup(self, worker: Worker) -> None:
        name_worker(f"worker {worker.name} on {platform.node()}" if worker.name is not None else worker.address)
        set_threads(worker.state.nthreads)
        memory = worker.memory_manager.memory_limit or machine_memory()
        if "task" in worker.state.total_resources:  # an earlier run has prepared it
            return
        await worker.set_resources(**{"memory": memory, "task": 1, **worker.state.total_resources})
        # tasks for which no worker had the resources when they came are looked at again when a worker begins to run
        worker.status = Status.paused
        worker.status = Status.running


class ClusterWorkers(Workers):
    """The workers of a Dask scheduler."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self.dashboard = client.dashboard_link
        self._asked, self._found = 0.0, dict[str, Any]()

    @property
    def width(self) -> int:
        return max(1, len(self._workers()))

    def submit(self, function: Callable[..., T], /, *args: Any, **named: Any) -> Future[T]:
        task = function if isinstance(function, Task) else Task(function)
        outer: Future[T] = Future()
        most = max((worker["resources"].get("memory", 0.0) for worker in self._workers().values()), default=0.0)
        if 0 < most < task.memory:
            outer.set_exception(too_big(task.memory, most))
            return outer
        needs = {"task": 1.0, "memory": task.memory} if task.memory else {"task": 1.0}
        call = functools.partial(task, *args, **named)  # whose arguments Dask neither looks into nor takes for its own
        try:
            inner = self._client.get_executor(pure=False, resources=needs).submit(call)
        except (OSError, RuntimeError) as error:
            outer.set_exception(_lost(error))
            return outer
        outer.add_done_callback(lambda outer: inner.cancel() if outer.cancelled() else None)
        inner.add_done_callback(functools.partial(_pass_on, outer))
        return outer

    def everywhere(self, function: Callable[..., T], *args: Any) -> dict[str, T]:
        names = {address: f"worker {worker['name']}" for address, worker in self._workers(now=True).items()}
        found: dict[str, T] = self._client.run(function, *args)
        return {names.get(address, address): value for address, value in found.items()}

    def _workers(self, now: bool = False) -> dict[str, Any]:
        if now or time.monotonic() - self._asked > ASK_SECONDS:
            with suppress(OSError, RuntimeError):  # the scheduler is gone, which the tasks will tell
                self._found = self._client.scheduler_info(n_workers=-1)["workers"]
            self._asked = time.monotonic()
        return self._found


@contextmanager
def open_cluster(cluster: str, workers: int | None) -> Iterator[ClusterWorkers]:
    """Workers of a Dask cluster; arguments and errors as of `open_executor`."""
    for name in ("distributed", "distributed.client", "distributed.worker", "tornado.application"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what goes wrong is an error of ours
    with ExitStack() as stack:
        address = cluster
        if cluster == "slurm":
            address = stack.enter_context(_slurm(workers or SLURM_WORKERS))
        elif cluster.startswith("ssh:"):
            address = stack.enter_context(_ssh(cluster.removeprefix("ssh:").split(",")))
        try:
            client = stack.enter_context(Client(address, timeout=CONNECT_SECONDS, set_as_default=False))
        except (OSError, ValueError) as error:
            message = f"the scheduler {cluster} cannot be reached"
            raise WorkerError(
                "cluster-unreachable", message, remedy="look whether it runs and is open to here"
            ) from error
        reached = ClusterWorkers(client)
        if reached.dashboard:
            log.info("dashboard: %s", reached.dashboard)
        _wait_for_workers(client, workers or 1, None if cluster == "slurm" else FIRST_WORKER_SECONDS)
        _refuse_other_versions(reached)
        client.register_plugin(_SetUp())
        reached.everywhere(int)  # they are prepared now
        yield reached


def _wait_for_workers(client: Client, count: int, seconds: float | None) -> None:
    try:
        client.wait_for_workers(count, timeout=seconds)
    except TimeoutError:
        there = len(client.nthreads())
        words = f"{there} of {count} workers are there" if there else "the scheduler has no workers"
        raise WorkerError("cluster-empty", words, remedy="start some with `dask worker ADDRESS`") from None


def _refuse_other_versions(reached: ClusterWorkers) -> None:
    here = installed()
    try:
        found = reached.everywhere(installed)
    except Exception as error:  # Dask sends what cannot be imported there as a plain Exception
        remedy = f"install eigenfield {here['eigenfield']} on all machines"
        raise WorkerError(
            "cluster-version", f"a worker has no eigenfield, or another one: {error}".split("\n")[0], remedy=remedy
        ) from None
    for worker, its in found.items():
        for package, version in here.items():
            if its.get(package) != version:
                message = f"{worker} has {package} {its.get(package, 'not at all')}, and here it is {version}"
                raise WorkerError("cluster-version", message, remedy="install the same versions on all machines")


@contextmanager
def _slurm(workers: int) -> Iterator[Any]:
    try:
        from dask_jobqueue import SLURMCluster
    except ModuleNotFoundError:
        raise missing_extra("dask-jobqueue") from None
    if missing := [name for name in ("cores", "memory") if not dask.config.get(f"jobqueue.slurm.{name}")]:
        remedy = "say them in ~/.config/dask/jobqueue.yaml (`eigenfield help cluster`)"
        raise OptionError("slurm", f"nothing says the {' and the '.join(missing)} of a job of SLURM", remedy=remedy)
    with SLURMCluster() as cluster:
        cluster.scale(n=workers)
        yield cluster


@contextmanager
def _ssh(hosts: list[str]) -> Iterator[Any]:
    """The scheduler runs on the first host, and a worker on each."""
    try:
        import asyncssh  # noqa: F401
    except ModuleNotFoundError:
        raise missing_extra("asyncssh") from None
    from distributed import SSHCluster

    try:
        cluster = SSHCluster([hosts[0], *hosts])
    except Exception as error:  # of asyncssh, and of what it starts there
        message = f"no workers by ssh on {', '.join(hosts)}: {error}".split("\n")[0]
        remedy = "try `ssh HOST` by hand: it must ask for nothing"
        raise WorkerError("cluster-unreachable", message, remedy=remedy) from error
    with cluster:
        yield cluster


def _pass_on(outer: Future[Any], inner: Future[Any]) -> None:
    """Give a task's outcome to the future that the user has."""
    if not outer.set_running_or_notify_cancel():
        return
    if inner.cancelled():
        outer.set_exception(_lost(None))
        return
    error = inner.exception()
    if isinstance(error, KilledWorker):
        killed = dask.config.get("distributed.scheduler.allowed-failures") + 1
        message = f"{killed} workers were killed while they ran it"
        remedy = "give them more memory, or look into their logs"
        outer.set_exception(WorkerError("worker-killed", message, remedy=remedy))
    elif isinstance(error, MemoryError):
        outer.set_exception(WorkerError("worker-memory", "its worker had no memory left", remedy="use larger workers"))
    elif error is not None:
        outer.set_exception(error)
    else:
        outer.set_result(inner.result())


def _lost(error: Exception | None) -> WorkerError:
    made = WorkerError("cluster-lost", "the connection to the scheduler is lost", remedy=LOST_REMEDY)
    made.__cause__ = error
    return made
