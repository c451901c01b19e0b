"""Shared by the verbs: bars on a terminal, JSON on standard output, and options that every verb has."""

from __future__ import annotations

import contextlib
import json
import logging
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeVar

import click

from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress

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
    """Add --calibration, --masks, --format, --grid and --frame, which `open_capture` and `open_any` take."""
    options = [
        click.option("--calibration", type=click.Path(path_type=Path), metavar="PATH",
                     help="A calibration (transforms.json, COLMAP model, ...) apart from the photographs."),
        click.option("--masks", type=click.Path(path_type=Path), metavar="FOLDER",
                     help="Masks named as the photographs; white counts."),
        click.option("--format", metavar="NAME",
                     help="What the capture is, where it may be read in several ways: "
                          "transforms, colmap, llff, middlebury, strecha, bundler, metashape, opencv, projections, "
                          "positions, hci, stanford, grid, numbered, video or folder."),
        click.option("--grid", metavar="RxC", callback=parse_grid,
                     help="Numbered photographs are R rows of C columns, row by row."),
        click.option("--frame", metavar="T", help="Frame of each video: an index from 0, or seconds (2.5s)."),
    ]  # fmt: skip
    for option in reversed(options):
        function = option(function)
    return function


def reconstruction_options(function: F) -> F:
    """Add the options of `reconstruct`."""
    options = [
        click.option("--surface", type=click.Choice(["auto", "relief", "poisson"]), default="auto", show_default=True,
                     help="relief: two layers seen from the array's centre; poisson: a surface from all sides."),
        click.option("--refine/--no-refine", default=None,
                     help="Correct an array's cameras together with its depth.  "
                     "[default: where none are given, or 25 or more]"),
        click.option("--fill-background/--no-fill-background", "background", default=None,
                     help="Close the view behind what was reconstructed.  [default: unless there are masks]"),
        click.option("--primitive", "primitives", multiple=True, metavar="SHAPE",
                     help="Put a shape in by hand: sphere:CX,CY,CZ,R or plane:PX,PY,PZ,NX,NY,NZ,EXTENT."),
        click.option("--fit-sphere", "fit_spheres", multiple=True, metavar="VIEW:X,Y,W,H",
                     help="Fit a sphere to the outline in a region of a photograph, and put it in."),
    ]  # fmt: skip
    for option in reversed(options):
        function = option(function)
    return function


def parse_grid(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[int, int] | None:
    """A click callback: ROWSxCOLUMNS as a pair.

    Raises:
        OptionError: `grid-unknown`.
    """
    if value is None:
        return None
    match = re.fullmatch(r"([1-9][0-9]{0,5})[xX×]([1-9][0-9]{0,5})", value)
    if match is None:
        raise OptionError("grid-unknown", f"--grid {value} is no grid", remedy="say ROWSxCOLUMNS, as 17x17")
    return int(match[1]), int(match[2])


def _set_threads(context: click.Context, parameter: click.Parameter, value: int | None) -> None:
    if value is not None:
        from eigenfield.runtime.parallel import set_threads

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


def note_all(messages: Iterable[str], quiet: bool) -> None:
    """Notes, a line each."""
    for message in messages:
        note(message, quiet)


def timings(seconds: Mapping[str, float]) -> list[str]:
    """The seconds of each stage, as lines."""
    return [f"  {stage:8} {f'{took:6.1f} s' if took else 'taken up'}" for stage, took in seconds.items()]


def refuse_unused(settings: Mapping[str, Any], blind: bool) -> None:
    """Refuse options that only matter where the proxy is made.

    Args:
        settings: The options of `reconstruct`.
        blind: Whether --blind was given.

    Raises:
        OptionError: `proxy-given`.
    """
    asked = [name for name, value in settings.items() if value not in (None, "auto", ())] + ["blind"] * blind
    if asked:
        raise OptionError(
            "proxy-given",
            f"--{asked[0].replace('_', '-').removesuffix('s')} is for making a proxy, but --proxy gives one",
            remedy="leave out one of the two",
        )


def echo_json(value: Any) -> None:
    """`value` as JSON on standard output; NaN and infinities are bugs."""
    click.echo(json.dumps(value, indent=2, allow_nan=False))
