"""Where tasks run: the same calls in this process, in local processes and on a cluster; workers that die."""

from __future__ import annotations

import os
import subprocess
import sys
import time

import pytest

from eigenfield.core.errors import FormatError, OptionError, OutputError, WorkerError
from eigenfield.runtime import executor
from eigenfield.runtime.executor import Task, as_finished, open_executor, refuse_unshared, spread
from eigenfield.runtime.parallel import threads
from support import tasks


@pytest.fixture(scope="module")
def scheduler():
    """The address of a Dask scheduler with two workers."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as cluster:
        yield cluster.scheduler_address


@pytest.fixture(scope="module", params=["here", "processes", pytest.param("cluster", marks=pytest.mark.slow)])
def workers(request):
    """Each of the three ways."""
    given = {"here": (None, None), "processes": (2, None), "cluster": (2, "")}[request.param]
    cluster = request.getfixturevalue("scheduler") if request.param == "cluster" else None
    with open_executor(given[0], cluster) as opened:
        yield opened


def test_results_come_in_order(workers):
    assert list(spread(workers, ((tasks.squared, number) for number in range(20)))) == [n * n for n in range(20)]
    found = dict(as_finished(workers, [(tasks.squared, 3), (Task(tasks.squared, 1e6), 4)]))
    assert {number: future.result() for number, future in found.items()} == {0: 9, 1: 16}
    assert list(as_finished(workers, [])) == []


def test_an_error_is_the_same_wherever_it_is_raised(workers):
    error = workers.submit(tasks.damaged).exception()
    assert isinstance(error, FormatError) and str(error) == "a.glb: is damaged (at byte 3); fetch it again"
    assert (error.code, error.where) == ("damaged", "byte 3")
    notes = getattr(error, "__notes__", [])
    assert isinstance(workers, executor.ThisProcess) or ("opening a.glb" in notes and notes[0].startswith("on "))
    with pytest.raises(FormatError):
        list(spread(workers, [(tasks.squared, 2), (tasks.damaged,), (tasks.squared, 3)]))
    assert "OddError" in "".join(map(repr, [workers.submit(tasks.odd).exception()]))


def test_a_folder_that_all_see(workers, tmp_path):
    refuse_unshared(workers, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_calls_are_made_as_workers_become_free(workers):
    made = []

    def calls():
        for number in range(100):
            made.append(number)
            yield tasks.squared, number

    finished = as_finished(workers, calls())
    next(finished)
    assert len(made) <= executor.AHEAD * 2 + 1
    assert len(list(finished)) == 99


def test_local_processes_share_the_threads_and_a_killed_one_is_replaced(tmp_path):
    (tmp_path / "a").mkdir()
    with open_executor(2) as workers:
        first = dict(as_finished(workers, [(tasks.place,) for _ in range(8)]))
        found = {future.result() for future in first.values()}
        assert {count for _, count in found} == {max(1, threads() // 2)}
        calls = [(tasks.killed, tmp_path, 1), *((tasks.squared, number, 0.02) for number in range(10))]
        found = list(spread(workers, calls))
        assert found[1:] == [number * number for number in range(10)]
        assert found[0] != os.getpid() and (tmp_path / "killed-0").exists()
        assert workers.submit(tasks.without_memory, tmp_path).result() == "done"
        always = workers.submit(tasks.killed, tmp_path / "a", 9).exception()
        assert isinstance(always, WorkerError) and always.code == "worker-killed"
        assert workers.submit(tasks.squared, 5).result() == 25


def test_tasks_that_need_more_memory_than_there_is_wait_or_are_refused(monkeypatch):
    monkeypatch.setattr(executor, "machine_memory", lambda: 1e9)
    with open_executor(2) as workers:
        assert isinstance(workers.submit(Task(tasks.squared, 2e9), 3).exception(), WorkerError)
        list(spread(workers, [(tasks.place,)] * 4))  # the processes have started
        began = time.monotonic()
        list(spread(workers, [(Task(tasks.squared, 0.6e9), 3, 0.3)] * 2))
        assert time.monotonic() - began > 0.6  # one after the other


def test_what_runs_is_stopped_with_the_block():
    with pytest.raises(KeyError), open_executor(2) as workers:
        pid = workers.submit(tasks.place).result()[0]
        workers.submit(tasks.squared, 3, 60)
        workers.submit(tasks.squared, 3, 60)
        time.sleep(0.3)
        raise KeyError
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_workers_end_with_a_killed_parent(tmp_path):
    script = tmp_path / "parent.py"
    script.write_text(
        "import os, signal\n"
        "from eigenfield.runtime.executor import open_executor\n"
        "if __name__ == '__main__':\n"
        "    with open_executor(1) as workers:\n"
        "        print(workers.submit(os.getpid).result(), flush=True)\n"
        "        os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True)
    worker = int(done.stdout)
    until = time.monotonic() + 10
    while time.monotonic() < until:
        try:
            os.kill(worker, 0)
        except ProcessLookupError:
            return
        time.sleep(0.05)
    raise AssertionError("the worker lives on")


def test_a_script_without_a_guard_is_told_so(tmp_path):
    script = tmp_path / "unguarded.py"
    script.write_text(
        "from eigenfield.runtime.executor import open_executor\n"
        "with open_executor(1) as workers:\n"
        "    workers.submit(int).result()\n"
    )
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True)
    assert 'below `if __name__ == "__main__":`' in done.stderr


@pytest.mark.slow
def test_a_cluster_s_workers_are_told_apart_and_may_die(scheduler, tmp_path):
    (tmp_path / "a").mkdir()
    with open_executor(2, scheduler) as workers:
        assert workers.width == 2 and set(workers.everywhere(int)) == {"worker 0", "worker 1"}
        assert workers.dashboard.startswith("http://")
        assert workers.submit(tasks.killed, tmp_path, 1).result() != os.getpid()
        always = workers.submit(tasks.killed, tmp_path / "a", 9).exception()
        assert isinstance(always, WorkerError) and always.code == "worker-killed"
        assert workers.submit(tasks.squared, 5).result() == 25
        assert workers.submit(Task(tasks.squared, 1e15), 5).exception().code == "task-memory"


def test_a_cluster_of_another_version_or_another_folder_is_refused(scheduler, tmp_path, monkeypatch):
    from eigenfield.runtime import cluster

    with open_executor(None, scheduler) as workers:
        monkeypatch.setattr(type(workers), "everywhere", lambda self, function, *args: {"worker 1": None})
        with pytest.raises(OutputError, match="worker 1 does not see it; name a folder that all machines share"):
            refuse_unshared(workers, tmp_path)
        monkeypatch.undo()
    monkeypatch.setattr(cluster, "installed", lambda: {"eigenfield": f"{os.getpid()}.0"})
    with pytest.raises(WorkerError, match=r"worker . has eigenfield \d+\.0, and here it is \d+\.0; install"):
        open_executor(None, scheduler).__enter__()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ((0, None), "0 workers were asked for; ask for 1 or more"),
        ((None, "tcp://127.0.0.1:9"), "tcp://127.0.0.1:9 cannot be reached"),
        ((None, "nowhere"), "nowhere cannot be reached"),
        ((None, "slurm"), "nothing says the cores and the memory of a job"),
        ((None, "ssh:host.invalid"), "no workers by ssh on host.invalid"),
    ],
)
def test_what_is_no_cluster_is_one_line(given, words, monkeypatch):
    from eigenfield.runtime import cluster

    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 0.5)
    with pytest.raises((OptionError, WorkerError)) as caught, open_executor(*given):
        pass
    assert words in str(caught.value) and "\n" not in str(caught.value)


def test_a_scheduler_without_workers(monkeypatch):
    from distributed import LocalCluster

    from eigenfield.runtime import cluster

    monkeypatch.setattr(cluster, "FIRST_WORKER_SECONDS", 0.5)
    with (
        LocalCluster(n_workers=0, dashboard_address=":0", silence_logs=50) as empty,
        pytest.raises(WorkerError, match="the scheduler has no workers; start some"),
    ):
        open_executor(None, empty.scheduler_address).__enter__()


@pytest.mark.slow
def test_a_lost_scheduler_is_one_line():
    from distributed import LocalCluster

    with (
        LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as lost,
        open_executor(None, lost.scheduler_address) as workers,
    ):
        future = workers.submit(tasks.squared, 3, 60)
        time.sleep(0.5)
        lost.close()
        error = future.exception(timeout=60)
    assert isinstance(error, WorkerError) and error.code == "cluster-lost"


def test_without_the_extra_it_is_said_what_to_install():
    code = (
        "import sys; sys.modules['distributed'] = None\n"
        "import eigenfield; assert not {'dask', 'fsspec'} & set(sys.modules)\n"
        "from eigenfield.runtime.executor import open_executor\n"
        "try:\n    open_executor(None, 'tcp://a:1').__enter__()\nexcept eigenfield.OptionError as error:\n"
        "    assert str(error) == \"--cluster needs distributed; pip install 'eigenfield[cluster]'\", error\n"
        "else:\n    raise SystemExit(1)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.slow
def test_a_memory_limit_ends_a_worker_and_not_the_work(tmp_path):
    from distributed import LocalCluster

    with (
        LocalCluster(
            n_workers=2, threads_per_worker=1, memory_limit="600MB", dashboard_address=":0", silence_logs=50
        ) as small,
        open_executor(None, small.scheduler_address) as workers,
    ):
        calls = [(tasks.hungry, tmp_path), *((tasks.squared, number) for number in range(10))]
        assert list(spread(workers, calls)) == ["done", *(number * number for number in range(10))]


@pytest.mark.slow
@pytest.mark.parametrize("way", ["processes", "cluster"])
def test_thousands_of_short_tasks_leave_the_driver_small(request, way):
    import psutil

    cluster = request.getfixturevalue("scheduler") if way == "cluster" else None
    with open_executor(2, cluster) as workers:
        list(spread(workers, ((tasks.squared, 1) for _ in range(50))))
        process, began = psutil.Process(), time.monotonic()
        before = process.memory_info().rss
        ended = sorted(number for number, _ in as_finished(workers, ((tasks.squared, n, 0.01) for n in range(2000))))
        grown = process.memory_info().rss - before
        print(f"{way}: {time.monotonic() - began:.1f} s, {grown / 1e6:.1f} MB")
    assert ended == list(range(2000)) and grown < 100e6
