"""A batch from its captures to its table and its page."""

from __future__ import annotations

import logging
import os
import traceback
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eigenfield.batches.capture import LOGS_FOLDER, encode_capture, look_at
from eigenfield.batches.jobs import CaptureJob, read_jobs
from eigenfield.batches.sheet import sheet_html
from eigenfield.batches.table import TABLE_WRITERS
from eigenfield.core.arguments import checked
from eigenfield.core.errors import EigenfieldError, OptionError, OutputError, WorkerError
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress, tell_remaining
from eigenfield.runtime.executor import as_finished, open_executor, refuse_unseen, refuse_unshared
from eigenfield.runtime.files import output_errors, write_bytes
from eigenfield.runtime.objects import absolute_place, find_objects
from eigenfield.runtime.tasks import Task, Workers

PAGE_FILE = "index.html"
FATAL_CODES = {"cluster-lost", "worker-start", "stopped"}  # what would fail for every other capture too

log = logging.getLogger("eigenfield.batch")


@dataclass(frozen=True, eq=False)
class BatchResult:
    """What a batch has made.

    Attributes:
        folder: Of the batch.
        records: Of each capture in order: `name`, `bytes`, `psnr`, `held_out_psnr`, `between_psnr_luma` or
            `between_psnr`, `seconds`, ..., or `name`, `code` and `error`, its one line.
        taken_up: How many were finished before.
    """

    folder: Path
    records: tuple[dict[str, Any], ...]
    taken_up: int

    @property
    def page(self) -> Path:
        """The page with all scenes."""
        return self.folder / PAGE_FILE

    @property
    def failed(self) -> tuple[dict[str, Any], ...]:
        """The records of captures that failed."""
        return tuple(record for record in self.records if "error" in record)


@checked
def batch(
    source: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
    output: str | os.PathLike[str] | None = None,
    *,
    workers: int | None = None,
    cluster: str | None = None,
    progress: Progress | None = notebook_progress,
    **options: Any,
) -> BatchResult:
    """Encode and measure many captures, as `eigenfield batch` does. What is finished is taken up again.

    A capture that fails has its line in the table, and the others go on.

    Args:
        source: A TOML file with `[options]` and `[[capture]]` tables, a folder of captures, or their paths; each may be
            an address of an object store.
        output: Folder to write, or an address. Default: `source` with "-scenes", beside it.
        workers: Processes of this machine; with a cluster as of `open_executor`. None: this process.
        cluster: Address of a Dask scheduler, "slurm" or "ssh:HOST,HOST".
        progress: Reports each capture; by default a bar in a notebook.
        options: Of all captures, by the names that `encode` and `open_any` have.

    Raises:
        OptionError: The list of captures or an option cannot be.
        OutputError: The folder cannot be written, or a worker does not see it.
        WorkerError: There are no workers, or they are lost.
    """
    given = Path(source) if isinstance(source, str | os.PathLike) else [Path(one) for one in source]
    jobs = read_jobs(given, options, None if output is None else absolute_place(output))
    folder = _output(given, output)
    records: dict[int, dict[str, Any]] = {}
    taken_up = 0
    with open_executor(workers, cluster) as pool:
        if pool.dashboard:
            log.warning("dashboard: %s", pool.dashboard)
        refuse_unshared(pool, folder)
        for place in {_shared_place(job.path) for job in jobs}:
            if find_objects(place) or place.exists():  # else it has its line in the table
                refuse_unseen(pool, place)
        try:
            bar = _Bar(len(jobs), progress)
            looks = _looked(pool, jobs, folder, records, bar)
            taken_up = sum("error" not in record for record in records.values())
            _encoded(pool, jobs, folder, looks, records, bar)
        finally:
            ordered = tuple(records[number] for number in sorted(records))
            if ordered:
                _write(folder, ordered, len(jobs) - len(ordered))
    return BatchResult(folder, ordered, taken_up)


def _shared_place(path: str) -> Path:
    """What workers must see of a capture: the folder that it lies in, or its bucket."""
    objects = find_objects(path)
    return Path(path).parent if objects is None else Path(objects.bucket)


def _output(source: Path | Sequence[Path], output: str | os.PathLike[str] | None) -> Path:
    if output is not None:
        folder = absolute_place(output)
    elif isinstance(source, Path):
        whole = absolute_place(source)
        folder = whole.with_name(f"{whole.stem if whole.suffix == '.toml' else whole.name}-scenes")
    else:
        raise OptionError("output", "a list of captures names no folder for the scenes", remedy="say output")
    objects = find_objects(folder)
    if objects is not None:
        objects.check_bucket()
        return folder
    if folder.exists() and not folder.is_dir():
        raise OutputError("output-is-file", "is a file", path=folder, remedy="name a folder")
    with output_errors(folder):
        folder.mkdir(parents=True, exist_ok=True)
    return folder


class _Bar:
    """One bar for all captures. The estimate counts what is left, by what finished ones took."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self._total, self._progress, self._done = total, progress, 0
        self._left: dict[int, float] = {}  # expected seconds
        self._took = self._expected = 0.0

    def looked(self, done: int) -> None:
        """So many captures have been opened."""
        if self._progress is not None:
            self._progress("captures looked at", done, self._total)

    def begin(self, left: Mapping[int, float], width: int) -> None:
        """All but these captures are finished, or have failed."""
        self._left, self._done = dict(left), self._total - len(left)
        self._show(width)

    def finished(self, number: int, seconds: float | None, width: int) -> None:
        """A capture has ended; None: it has failed, which tells nothing about the others."""
        self._done += 1
        expected = self._left.pop(number)
        if seconds is not None:
            self._took, self._expected = self._took + seconds, self._expected + expected
        self._show(width)

    def _show(self, width: int) -> None:
        left = sum(self._left.values())
        pace = self._took / self._expected if self._expected else 1.0
        tell_remaining(self._progress, pace * left / max(1, min(width, len(self._left))))
        if self._progress is not None:
            self._progress("captures", self._done, self._total)


def _looked(
    pool: Workers, jobs: Sequence[CaptureJob], folder: Path, records: dict[int, dict[str, Any]], bar: _Bar
) -> dict[int, dict[str, Any]]:
    """What the captures that are not finished are expected to take; records of the others."""
    looks: dict[int, dict[str, Any]] = {}
    calls = ((look_at, job, folder) for job in jobs)
    bar.looked(0)
    for done, (number, future) in enumerate(as_finished(pool, calls), 1):
        error = future.exception()
        if error is not None:
            records[number] = _failure(jobs[number], error, folder)
        elif (look := future.result())["record"] is not None:
            records[number] = look["record"]
        else:
            looks[number] = look
        bar.looked(done)
    return looks


def _encoded(
    pool: Workers, jobs: Sequence[CaptureJob], folder: Path, looks: Mapping[int, dict[str, Any]],
    records: dict[int, dict[str, Any]], bar: _Bar,
) -> None:  # fmt: skip
    order = list(looks)
    bar.begin({number: look["seconds"] for number, look in looks.items()}, pool.width)

    def calls() -> Iterator[tuple[Any, ...]]:
        for number in order:
            yield Task(encode_capture, looks[number]["memory"]), jobs[number], folder, looks[number]["key"]

    for place, future in as_finished(pool, calls()):
        number, error = order[place], future.exception()
        records[number] = future.result() if error is None else _failure(jobs[number], error, folder)
        bar.finished(number, None if error is not None else records[number]["seconds"], pool.width)


def _failure(job: CaptureJob, error: BaseException, folder: Path) -> dict[str, Any]:
    """The record of a capture that failed, and its log. Raises what would fail for all."""
    notes: list[str] = getattr(error, "__notes__", [])
    if isinstance(error, WorkerError) and error.code in FATAL_CODES:
        raise error
    if isinstance(error, EigenfieldError):
        code, line, text = error.code, str(error), str(error)
    else:
        code, line = "bug", f"a bug of eigenfield: {type(error).__name__}: {error}".split("\n")[0]
        text = "".join(traceback.format_exception(error))
    log_file = folder / LOGS_FOLDER / f"{job.name}.log"
    with output_errors(folder):
        if not find_objects(folder):
            log_file.parent.mkdir(exist_ok=True)
        write_bytes(log_file, "\n".join([text, *notes, ""]).encode("utf-8", "replace"), overwrite=True)
    worker = notes[0].removeprefix("on ") if notes else None
    return {
        "name": job.name, "capture": job.path, "code": code, "error": line, "worker": worker,
        "log": f"{LOGS_FOLDER}/{job.name}.log",
    }  # fmt: skip


def _write(folder: Path, records: Sequence[dict[str, Any]], missing: int) -> None:
    for name, text in TABLE_WRITERS.items():
        write_bytes(folder / name, text(records).encode("utf-8"), overwrite=True)
    page = sheet_html(folder.name, records, missing)
    write_bytes(folder / PAGE_FILE, page.encode("utf-8"), overwrite=True)
