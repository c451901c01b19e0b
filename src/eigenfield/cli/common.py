"""Shared by the verbs: bars on a terminal, JSON on standard output, and options that every verb has."""

from __future__ import annotations

import contextlib
import json
import logging
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from eigenfield.runtime.tasks import Workers

F = TypeVar("F", bound=Callable[..., Any])
Decorator = Callable[[Any], Any]
PATH = click.Path(path_type=Path)


def together(*options: Decorator) -> Decorator:
    """One decorator that adds several options, in this order."""

    def add(function: F) -> F:
        for option in reversed(options):
            function = option(function)
        return function

    return add


def pair_of_numbers(words: str) -> Callable[..., tuple[int, int] | None]:
    """A click callback: AxB as a pair; BadParameter says `words` where it is none."""

    def parse(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[int, int] | None:
        if value is None:
            return None
        match = re.fullmatch(r"(\d{1,6})[xX×](\d{1,6})", value)
        if match is None:
            raise click.BadParameter(words)
        return int(match[1]), int(match[2])

    return parse


def _set_threads(context: click.Context, parameter: click.Parameter, value: int | None) -> None:
    if value is not None:
        from eigenfield.runtime.parallel import set_threads

        set_threads(value)


def _set_verbose(context: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        logging.getLogger("eigenfield").setLevel(logging.INFO)


def _set_traceback(context: click.Context, parameter: click.Parameter, value: bool) -> None:
    context.meta["traceback"] = value  # of all contexts of this run


def _set_progress(context: click.Context, parameter: click.Parameter, value: str) -> None:
    context.meta["progress"] = value  # for `progress_bars`


# They take effect before the verb runs and are not passed on, except `quiet`, which the verb gives to `progress_bars`.
common_options = together(
    click.option("--threads", type=int, metavar="N", expose_value=False, callback=_set_threads, is_eager=True,
                 help="Threads to use.  [default: all processors]"),
    click.option("--quiet", "-q", is_flag=True, help="Show errors only: no progress bars, no notes."),
    click.option("--progress", type=click.Choice(["bars", "json"]), default="bars", expose_value=False,
                 callback=_set_progress, help="json: lines on standard error for another program to read."),
    click.option("--verbose", "-v", is_flag=True, expose_value=False, callback=_set_verbose, is_eager=True,
                 help="Say more about what is done."),
    click.option("--traceback", is_flag=True, expose_value=False, callback=_set_traceback, is_eager=True,
                 help="Show where an error came from."),
)  # fmt: skip
worker_options = together(
    click.option("--workers", type=int, metavar="N",
                 help="Share the work among N processes of this machine; with --cluster, wait for N workers."),
    click.option("--cluster", metavar="ADDRESS",
                 help="Share the work on a cluster: tcp://HOST:8786 (a Dask scheduler), slurm, or ssh:HOST,HOST."),
)  # fmt: skip


@contextlib.contextmanager
def chosen_workers(workers: int | None, cluster: str | None) -> Iterator[Workers | None]:
    """The workers that `worker_options` name; None: work stays in this process."""
    if workers is None and cluster is None:
        yield None
        return
    from eigenfield.runtime.executor import open_executor

    with open_executor(workers, cluster) as opened:
        yield opened


def note(message: str, quiet: bool = False) -> None:
    """A line for a person, on standard error."""
    if not quiet:
        click.echo(message, err=True)


def note_all(messages: Iterable[str], quiet: bool) -> None:
    """Notes, a line each."""
    for message in messages:
        note(message, quiet)


def first_names(names: list[str], most: int) -> str:
    """The first few of many names, with commas between, and how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more


def echo_json(value: Any) -> None:
    """`value` as JSON on standard output; NaN and infinities are bugs."""
    click.echo(json.dumps(value, indent=2, allow_nan=False))
