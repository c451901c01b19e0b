"""Options of the verbs that open a capture or make a surface, and these two steps."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.common import PATH, Decorator, note, note_all
from eigenfield.cli.field_options import field_options, from_fields
from eigenfield.core.errors import OptionError
from eigenfield.core.fields import options_of
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.progress import Progress
from eigenfield.reconstruction import SurfaceOptions

if TYPE_CHECKING:
    from eigenfield.capture import Capture
    from eigenfield.reconstruction.whole import Reconstruction
    from eigenfield.runtime.tasks import Workers

BY_HAND = ("refine", "background", "primitives", "fit_spheres")


def _pair(name: str, code: str, remedy: str) -> Callable[..., tuple[int, int] | None]:
    """A click callback: AxB, both at least 1. OptionError with the code where it is none."""

    def parse(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[int, int] | None:
        if value is None:
            return None
        match = re.fullmatch(r"([1-9][0-9]{0,5})[xX×]([1-9][0-9]{0,5})", value)
        if match is None:
            raise OptionError(code, f"--{name} {value} is no {name}", remedy=remedy)
        return int(match[1]), int(match[2])

    return parse


_parse_grid = _pair("grid", "grid-unknown", "say ROWSxCOLUMNS, as 17x17")
_parse_quilt = _pair("quilt", "quilt", "say COLUMNSxROWS, as 8x6")


def _parse_layers(context: click.Context, parameter: click.Parameter, value: str | None) -> int | None:
    if value in (None, "auto"):
        return None
    if not re.fullmatch(r"-?[0-9]{1,9}", value):
        raise click.BadParameter("a number, or auto")
    return int(value)


def place_options(*only: str) -> Decorator:
    """The options of `OpenOptions`, or some of them."""
    return field_options(OpenOptions, only=only or None, grid=_parse_grid, quilt=_parse_quilt)


def surface_options(*only: str) -> Decorator:
    """Some of the options of `SurfaceOptions`."""
    return field_options(SurfaceOptions, only=only, layers=_parse_layers)


def capture_argument(required: bool = True) -> Decorator:
    """CAPTURE, which may be several folders."""
    metavar = "CAPTURE..." if required else "[CAPTURE]..."
    return click.argument("capture", type=PATH, nargs=-1, required=required, metavar=metavar)


def capture_options(function: Callable[..., Any]) -> Any:
    """Add the options of `OpenOptions`; the verb gets them as `place`, with further folders of CAPTURE in `also`."""

    @functools.wraps(function)
    def collect(**given: Any) -> Any:
        capture, *also = given.pop("capture") or [None]
        values = {name: given.pop(name) for name, one in options_of(OpenOptions) if one.offered}
        place = from_fields(OpenOptions, {**values, "also": also or None})
        return function(capture=capture, place=place, **given)

    return place_options()(collect)


def open_for_work(capture: Path, place: OpenOptions, work: Path, quiet: bool) -> Capture:
    """Photographs with or without cameras, with notes on what was found."""
    from eigenfield.capture import open_any

    opened = open_any(capture, place, work=work / "frames")
    note_all(opened.problems, quiet)
    return opened


def reconstruct_capture(
    opened: Capture,
    surface: SurfaceOptions,
    work: Path,
    progress: Progress | None,
    quiet: bool,
    workers: Workers | None = None,
    *,
    atlas: bool = True,
) -> Reconstruction:
    """As `reconstruct`, with notes on what was found."""
    from eigenfield.encoding.cost import STEPS
    from eigenfield.reconstruction.whole import reconstruct

    made = reconstruct(opened, surface, atlas=atlas, work=work, workers=workers, progress=progress)
    note_all(made.light_field.problems[len(opened.problems) :], quiet)
    for stage, took in made.seconds.items():
        if not took:
            note(f"  {STEPS[stage].words}: taken up from an earlier run", quiet)
    return made
