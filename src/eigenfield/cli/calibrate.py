"""`eigenfield calibrate`: cameras from photographs, by structure from motion or from pictures of a chart."""

from __future__ import annotations

import json
import time
from pathlib import Path

import click

from eigenfield.cli.calibrate_chart import ChartOptions, calibrate_from_charts, chart_options
from eigenfield.cli.common import common_options, echo_json, note, parse_grid, progress_bars
from eigenfield.core.errors import OptionError

REPORT_FILE = "report.json"
CALIBRATION_SUFFIX = "-calibration"
MATCHING_WAYS = ("auto", "exhaustive", "similar", "grid", "positions")


@click.command(
    epilog="""\b
Examples:
  eigenfield calibrate photos/
  eigenfield calibrate photos/ --intrinsics lens.yml -o cameras/
  eigenfield calibrate photos/ --masks masks/ --camera-per-photo --json
  eigenfield calibrate charts/ --chart checkerboard --board 9x6 --square 25mm
  eigenfield inspect photos/ --calibration photos-calibration/transforms.json"""
)
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--output",
    "-o",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Folder for transforms.json, sparse/0 and report.json.  [default: FOLDER-calibration]",
)
@click.option(
    "--intrinsics",
    type=click.Path(path_type=Path),
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
    "--work",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Keep features and matches here, so that the next run goes on from them.",
)
@click.option(
    "--masks", type=click.Path(path_type=Path), metavar="FOLDER", help="Masks named as the photographs; white counts."
)
@click.option("--format", metavar="NAME", help="What the names of the photographs mean, as `encode` takes it.")
@click.option(
    "--grid", metavar="RxC", callback=parse_grid, help="Numbered photographs are R rows of C columns, row by row."
)
@click.option("--frame", metavar="T", help="Frame of each video: an index from 0, or seconds (2.5s).")
@chart_options
@click.option("--overwrite", is_flag=True, help="Replace an earlier calibration in DIR; other files there stay.")
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
@common_options  # fmt: skip
def command(
    folder: Path,
    output: Path | None,
    intrinsics: Path | None,
    matching: str,
    camera_per_photo: bool,
    seed: int,
    work: Path | None,
    masks: Path | None,
    format: str | None,
    grid: tuple[int, int] | None,
    frame: str | None,
    chart: ChartOptions | None,
    overwrite: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Find the cameras of the photographs in FOLDER, and write them for eigenfield and other tools.

    Without --chart, from the scene itself (structure from motion): photographs that find no place are named with the
    reason. With --chart, FOLDER holds pictures or videos of a board, by camera.
    """
    from eigenfield.capture.writers.save import refuse_folder

    place = _default_output(folder) if output is None else output
    refuse_folder(place, overwrite)
    if chart is not None:
        given: dict[str, object] = {
            "intrinsics": intrinsics,
            "masks": masks,
            "work": work,
            "grid": grid,
            "frame": frame,
            "format": format,
        }
        given |= {"camera-per-photo": camera_per_photo or None, "json": as_json or None}
        for name, value in given.items():
            if value is not None:
                raise OptionError("chart", f"--{name} means nothing to charts", remedy="leave it out")
        calibrate_from_charts(folder, place, chart, overwrite=overwrite, quiet=quiet)
        return

    started = time.monotonic()
    from eigenfield.calibrate import read_known_lenses, structure_from_motion
    from eigenfield.calibrate.motion.report import describe_motion, report_lines
    from eigenfield.capture import open_photographs
    from eigenfield.capture.writers.save import save_calibration

    photos = open_photographs(
        folder, masks=masks, strict=False, format=format, grid=grid, frame=frame, work=work
    )  # fmt: skip
    if photos.format == "video" and work is None:
        raise OptionError(
            "video-work", "the frames of videos must stay for the calibration to name them", remedy="add --work DIR"
        )
    for problem in photos.problems:
        note(problem, quiet)
    known = None if intrinsics is None else read_known_lenses(intrinsics, photos)
    with progress_bars(quiet) as progress:
        motion = structure_from_motion(
            photos,
            intrinsics=known,
            camera_per_photo=camera_per_photo,
            matching=matching,  # type: ignore[arg-type]
            work=work,
            seed=seed,
            progress=progress,
        )
    report = describe_motion(motion)
    text = json.dumps(report, indent=1, allow_nan=False) + "\n"
    save_calibration(motion.light_field, place, motion.points, overwrite=overwrite, more={REPORT_FILE: text.encode()})
    if as_json:
        echo_json(report)
    else:
        click.echo("\n".join(report_lines(report)))
    note(f"{place} written, {time.monotonic() - started:.0f} s", quiet)


def _default_output(folder: Path) -> Path:
    """Beside the photographs, never among them."""
    whole = folder.absolute()
    return whole.with_name(whole.name + CALIBRATION_SUFFIX) if whole.name else whole / CALIBRATION_SUFFIX.lstrip("-")
