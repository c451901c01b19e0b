"""`eigenfield calibrate`: cameras from photographs, by structure from motion or from pictures of a chart."""

from __future__ import annotations

import time
from dataclasses import fields
from pathlib import Path
from typing import Any

import click

from eigenfield.cli.calibrate_chart import chart_options, summary, table
from eigenfield.cli.capture_options import place_options
from eigenfield.cli.common import (
    PATH,
    common_options,
    echo_json,
    note,
    note_all,
)
from eigenfield.cli.progress import progress_bars
from eigenfield.core.errors import OptionError
from eigenfield.core.open_options import OpenOptions

CALIBRATION_SUFFIX = "-calibration"
MATCHING_WAYS = ("auto", "exhaustive", "similar", "grid", "positions")


def _one_folder(context: click.Context, parameter: click.Parameter, value: tuple[Path, ...]) -> Path:
    if len(value) > 1:
        from eigenfield.capture.readers.folder import refuse_photograph_files

        refuse_photograph_files(value)
        raise click.UsageError(f"Got unexpected extra argument ({value[1]})", context)
    return value[0]


@click.command(
    epilog="""\b
Examples:
  eigenfield calibrate photos/
  eigenfield calibrate videos/ --clip -o rig/
  eigenfield calibrate photos/ --intrinsics lens.yml -o cameras/
  eigenfield calibrate photos/ --masks masks/ --camera-per-photo --json
  eigenfield calibrate charts/ --chart checkerboard --board 9x6 --square 25mm
  eigenfield inspect photos/ --calibration photos-calibration/transforms.json"""
)
@click.argument("folder", type=PATH, nargs=-1, required=True, metavar="FOLDER", callback=_one_folder)
@click.option(
    "--output",
    "-o",
    type=PATH,
    metavar="DIR",
    help="Folder for transforms.json, sparse/0 and report.json.  [default: FOLDER-calibration]",
)
@click.option(
    "--intrinsics",
    type=PATH,
    metavar="PATH",
    help="Known lenses, which are kept as they are: any calibration, an OpenCV file, or K's nine numbers.",
)
@click.option(
    "--matching",
    type=click.Choice(MATCHING_WAYS),
    default="auto",
    show_default=True,
    help="Which photographs are compared: all, those that look alike, or neighbours by the names' grid or positions.",
)
@click.option(
    "--camera-per-photo",
    is_flag=True,
    help="Estimate each photograph's lens alone, where they were taken by several cameras or a zoom.",
)
@click.option("--seed", type=click.IntRange(0, 2**31 - 1), default=0, show_default=True, help="Of all random choices.")
@click.option(
    "--work", type=PATH, metavar="DIR", help="Keep features and matches here, so that the next run goes on from them."
)
@place_options("masks")
@click.option("--format", metavar="NAME", help="What the names of the photographs mean, as `encode` takes it.")
@place_options("grid", "pattern", "frame", "walk_frames", "clip", "offset", "rate")
@chart_options
@click.option("--overwrite", is_flag=True, help="Replace an earlier calibration in DIR; other files there stay.")
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@common_options
def command(
    folder: Path,
    output: Path | None,
    intrinsics: Path | None,
    matching: str,
    camera_per_photo: bool,
    seed: int,
    work: Path | None,
    chart: str | None,
    overwrite: bool,
    as_json: bool,
    quiet: bool,
    **names: Any,
) -> None:
    """Find the cameras of the photographs in FOLDER, and write them for eigenfield and other tools.

    Without --chart, from the scene itself (structure from motion): photographs that find no place are named with the
    reason. With --chart, FOLDER holds pictures or videos of a board, by camera.
    """
    from eigenfield.calibration.charts.description import ChartOptions
    from eigenfield.calibration.motion.report import describe_motion, report_lines
    from eigenfield.calibration.whole import calibrate, refuse_passing
    from eigenfield.capture import Footage, PhotoSet, open_footage, open_photographs
    from eigenfield.capture.writers.save import refuse_folder

    started = time.monotonic()
    place = _default_output(folder) if output is None else output
    refuse_folder(place, overwrite)
    board: dict[str, Any] = {field.name: names.pop(field.name) for field in fields(ChartOptions)[1:]}
    ChartOptions(chart, **board)  # is refused before photographs are read
    options: dict[str, Any] = {
        "intrinsics": intrinsics, "camera_per_photo": camera_per_photo, "matching": matching, "work": work,
        "seed": seed, "overwrite": overwrite,
    }  # fmt: skip
    if chart is not None:
        if as_json:
            raise OptionError("chart", "--json means nothing to charts", remedy="leave it out")
        with progress_bars(quiet) as progress:
            rig = calibrate(folder, place, chart=chart, progress=progress, **board, **options, **names)
        note_all(rig.problems, quiet)
        click.echo("\n".join([*table(rig), f"{place}: {summary(rig)}, {time.monotonic() - started:.0f} s"]))
        return

    photos: PhotoSet | Footage
    if names["clip"] is not None:
        photos = open_footage(folder, options=OpenOptions(work=work, **names))
    else:
        photos = open_photographs(folder, strict=False, work=work, **names)
        refuse_passing(photos, folder, work)
    note_all(photos.problems, quiet)
    with progress_bars(quiet) as progress:
        motion = calibrate(photos, place, progress=progress, **options)
    report = describe_motion(motion)
    if as_json:
        echo_json(report)
    else:
        click.echo("\n".join(report_lines(report)))
    note(f"{place} written, {time.monotonic() - started:.0f} s", quiet)


def _default_output(folder: Path) -> Path:
    """Beside the photographs, never among them."""
    whole = folder.absolute()
    return whole.with_name(whole.name + CALIBRATION_SUFFIX) if whole.name else whole / CALIBRATION_SUFFIX.lstrip("-")
