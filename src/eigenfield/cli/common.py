"""What the verbs share: bars on a terminal, JSON on standard output, and options that every verb has."""

from __future__ import annotations

import contextlib
import json
import logging
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import click

from eigenfield.progress import Progress

F = TypeVar("F", bound=Callable[..., Any])


def common_options(function: F) -> F:
    """Add --threads, --quiet, --verbose and --traceback; they take effect before the verb runs and are not passed on,
    except `quiet`, which the verb gives to `progress_bars`."""
    options = [
        click.option("--threads", type=int, metavar="N", expose_value=False, callback=_set_threads, is_eager=True,
                     help="Threads to use.  [default: all processors]"),
        click.option("--quiet", "-q", is_flag=True, help="No progress bars, no notes; errors only."),
        click.option("--verbose", "-v", is_flag=True, expose_value=False, callback=_set_verbose, is_eager=True,
                     help="Say more about what is done."),
        click.option("--traceback", is_flag=True, expose_value=False, callback=_set_traceback, is_eager=True,
                     help="Show where an error came from."),
    ]  # fmt: skip
    for option in reversed(options):
        function = option(function)
    return function


def capture_options(function: F) -> F:
    """Add --calibration and --masks, which `open_capture` takes."""
    options = [
        click.option("--calibration", type=click.Path(path_type=Path), metavar="PATH",
                     help="A transforms.json or COLMAP model that lies elsewhere than the photographs."),
        click.option("--masks", type=click.Path(path_type=Path), metavar="FOLDER",
                     help="Masks named as the photographs; white counts."),
    ]  # fmt: skip
    for option in reversed(options):
        function = option(function)
    return function


def _set_threads(context: click.Context, parameter: click.Parameter, value: int | None) -> None:
    if value is not None:
        from eigenfield.parallel import set_threads

        set_threads(value)


def _set_verbose(context: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        logging.getLogger("eigenfield").setLevel(logging.INFO)


def _set_traceback(context: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        context.meta["traceback"] = True
        context.find_root().meta["traceback"] = True


@contextlib.contextmanager
def progress_bars(quiet: bool) -> Iterator[Progress | None]:
    """A Progress that draws one bar a stage on standard error; None where it is no terminal, or `quiet`."""
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bars

    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn()
    )  # fmt: skip
    tasks: dict[str, Any] = {}
    with Bars(*columns, console=Console(stderr=True)) as bars:

        def report(stage: str, done: int, total: int) -> None:
            if done == 0 or stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=total)
            bars.update(tasks[stage], completed=done, total=total)

        yield report


def note(message: str, quiet: bool = False) -> None:
    """A line for a person, on standard error."""
    if not quiet:
        click.echo(message, err=True)


def echo_json(value: Any) -> None:
    """`value` as JSON on standard output; NaN and infinities are bugs."""
    click.echo(json.dumps(value, indent=2, allow_nan=False))
