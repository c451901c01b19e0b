"""Shared by the verbs: bars on a terminal, JSON on standard output, and options that every verb has."""

from __future__ import annotations

import contextlib
import functools
import json
import logging
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress

if TYPE_CHECKING:
    from eigenfield.capture import Capture
    from eigenfield.reconstruction import Reconstruction
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


def _parse_grid(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[int, int] | None:
    if value is None:
        return None
    match = re.fullmatch(r"([1-9][0-9]{0,5})[xX×]([1-9][0-9]{0,5})", value)
    if match is None:
        raise OptionError("grid-unknown", f"--grid {value} is no grid", remedy="say ROWSxCOLUMNS, as 17x17")
    return int(match[1]), int(match[2])


def _parse_layers(context: click.Context, parameter: click.Parameter, value: str) -> int | None:
    if value == "auto":
        return None
    if not re.fullmatch(r"-?[0-9]{1,9}", value):
        raise click.BadParameter("a number, or auto")
    return int(value)


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
masks_option = click.option("--masks", type=PATH, metavar="FOLDER",
                            help="Masks with the photographs' names: white is used, black is not.")  # fmt: skip
grid_options = together(
    click.option("--grid", metavar="RxC", callback=_parse_grid,
                 help="Numbered photographs: R rows of C columns."),
    click.option("--pattern", metavar="NAME",
                 help="Where names have row and column: view_{row}_{col}.png; * is any text."),
    click.option("--frame", metavar="T", help="Frame to take of each video: a number from 0, or seconds (2.5s)."),
    click.option("--frames", type=int, metavar="N", help="Frames to take of the video of a walk.  "
                 "[default: by how far the camera goes]"),
)  # fmt: skip
_place_options = together(
    click.option("--calibration", type=PATH, metavar="PATH",
                 help="Cameras that lie elsewhere: transforms.json, a COLMAP model, Metashape's .xml ..."),
    masks_option,
    click.option("--format", metavar="NAME",
                 help="Read the capture as this format, where several fit: "
                      "transforms, colmap, llff, middlebury, strecha, bundler, nvm, metashape, opencv, "
                      "realitycapture, deepview, projections, positions, hci, stanford, grid, numbered, video, "
                      "walk or folder."),
    grid_options,
)  # fmt: skip


def _surface_option(kinds: str, words: str) -> Decorator:
    return click.option("--surface", type=click.Choice(kinds.split()), default="auto", show_default=True, help=words)


MESH_KINDS = "relief: two layers seen from the array's centre; poisson: a surface from all sides"
_mesh_options = together(  # the arguments of `reconstruct` about a mesh
    click.option("--refine/--no-refine", default=None,
                 help="Correct an array's cameras together with its depth.  "
                 "[default: where none are given, or 25 or more]"),
    click.option("--fill-background/--no-fill-background", "background", default=None,
                 help="Close the view behind the scene.  [default: unless there are masks]"),
    click.option("--primitive", "primitives", multiple=True, metavar="SHAPE",
                 help="Add a shape to the mesh: sphere:CX,CY,CZ,R or plane:PX,PY,PZ,NX,NY,NZ,EXTENT."),
    click.option("--fit-sphere", "fit_spheres", multiple=True, metavar="VIEW:X,Y,W,H",
                 help="Add a sphere, fitted to the outline in this region of a photograph."),
)  # fmt: skip
mesh_options = together(_surface_option("auto relief poisson", f"{MESH_KINDS}."), _mesh_options)
reconstruction_options = together(  # the arguments of `reconstruct`
    _surface_option("auto relief layers poisson", f"{MESH_KINDS}; layers: soft sheets with an opacity."),
    click.option("--layers", metavar="N", default="auto", show_default=True, callback=_parse_layers,
                 help="Soft sheets: 2 to 32, or 1 for none; auto tries 4 and 8 on views left out."),
    _mesh_options,
)  # fmt: skip


def capture_argument(required: bool = True) -> Decorator:
    """CAPTURE, which may be several folders."""
    metavar = "CAPTURE..." if required else "[CAPTURE]..."
    return click.argument("capture", type=PATH, nargs=-1, required=required, metavar=metavar)


def capture_options(function: Callable[..., Any]) -> Any:
    """Add --calibration, --masks, --format, --grid, --pattern, --frame and --frames; the verb gets them as one `place`,
    the keyword arguments of `open_capture` and `open_any`, with further folders of the argument CAPTURE (`also`)."""

    @functools.wraps(function)
    def collect(**given: Any) -> Any:
        names = ("calibration", "masks", "format", "grid", "pattern", "frame", "frames")
        place = {name: given.pop(name) for name in names}
        capture, *also = given.pop("capture") or [None]
        return function(capture=capture, place={**place, "also": also or None}, **given)

    return _place_options(collect)


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


def open_for_work(capture: Path, place: dict[str, Any], work: Path, quiet: bool) -> Capture:
    """Photographs with or without cameras, with notes on what was found.

    Args:
        capture: The folder.
        place: Of `capture_options`.
        work: Folder that keeps finished stages.
        quiet: Whether nothing is noted.
    """
    from eigenfield.capture import open_any

    opened = open_any(capture, work=work / "frames", **place)
    note_all(opened.problems, quiet)
    return opened


def reconstruct_capture(
    opened: Capture, work: Path, progress: Progress | None, quiet: bool, **settings: Any
) -> Reconstruction:
    """Cameras and proxy of a capture, estimated where they are not given, with notes on what was found.

    Args:
        opened: The photographs that take part.
        work: Folder that keeps finished stages.
        progress: Reports each stage.
        quiet: Whether nothing is noted.
        settings: Of `reconstruct`.
    """
    from eigenfield.encoding.cost import STEPS
    from eigenfield.reconstruction import reconstruct

    made = reconstruct(opened, work=work, progress=progress, **settings)
    note_all(made.light_field.problems[len(opened.problems) :], quiet)
    for stage, took in made.seconds.items():
        if not took:
            note(f"  {STEPS[stage].words}: taken up from an earlier run", quiet)
    return made


def echo_json(value: Any) -> None:
    """`value` as JSON on standard output; NaN and infinities are bugs."""
    click.echo(json.dumps(value, indent=2, allow_nan=False))
