"""The part of `eigenfield calibrate` that takes pictures of a chart."""

from __future__ import annotations

import functools
import json
import time
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.common import note_all, together
from eigenfield.cli.progress import progress_bars
from eigenfield.core.errors import OptionError

if TYPE_CHECKING:
    from eigenfield.calibration.charts.board import Board
    from eigenfield.calibration.charts.calibrate import CameraReport, ChartCalibration

BOARD_FILE = "charuco.toml"
REPORT_FILE = "report.json"


@dataclass(frozen=True)
class ChartOptions:
    """The chart as the command line describes it; None for what was not given.

    Attributes:
        chart: "checkerboard" or "charuco".
        board: Columns and rows, or a charuco.toml.
        square: Side of a square, with its unit.
        marker: Side of a marker, with its unit.
        dictionary: Of the markers.
        inverted: Whether it is printed white on black.
        legacy: Whether OpenCV drew it before 4.6.
    """

    chart: str
    board: str | None
    square: str | None
    marker: str | None
    dictionary: str | None
    inverted: bool | None
    legacy: bool | None


_options = together(
    click.option("--chart", type=click.Choice(["checkerboard", "charuco"]),
                 help="FOLDER holds pictures or videos of a board of this kind, by camera."),
    click.option("--board", metavar="CxR", help="Inner corners of a checkerboard (9x6), squares of a ChArUco board "
                 "(4x5), columns first; or a charuco.toml.  [default: the charuco.toml in FOLDER or above it]"),
    click.option("--square", metavar="LENGTH", help="Side of a square: 25mm, or a number in any unit."),
    click.option("--marker", metavar="LENGTH", help="Side of a ChArUco board's marker."),
    click.option("--dictionary", metavar="NAME", help="Of a ChArUco board's markers.  [default: DICT_4X4_1000]"),
    click.option("--inverted/--not-inverted", default=None,
                 help="The board is printed white on black.  [default: try both]"),
    click.option("--legacy/--not-legacy", default=None,
                 help="ChArUco as OpenCV drew it before 4.6.  [default: try both]"),
)  # fmt: skip


def chart_options(function: Callable[..., Any]) -> Any:
    """Add --chart and the options of the board; the verb gets them as one `chart: ChartOptions | None`."""

    @functools.wraps(function)
    def collect(**given: Any) -> Any:
        chart = ChartOptions(**{field.name: given.pop(field.name) for field in fields(ChartOptions)})
        first = next((name for name, value in vars(chart).items() if value is not None), None)
        if first not in (None, "chart"):
            raise OptionError(
                "chart", f"--{first} describes a chart", remedy="say --chart checkerboard or --chart charuco too"
            )
        return function(chart=None if first is None else chart, **given)

    return _options(collect)


def board_of(options: ChartOptions, folder: Path) -> Board:
    """The board that the options describe, or a charuco.toml in a folder or above it.

    Args:
        options: The chart.
        folder: With the pictures.

    Raises:
        OptionError: `chart`, and as `checkerboard`, `charuco`, `parse_size`, `parse_length` do.
        CaptureError: `board-file`.
    """
    from eigenfield.calibration.charts.board import (
        BOARD_DEFAULT_DICTIONARY,
        charuco,
        checkerboard,
        convert_length,
        parse_length,
        parse_size,
        read_board,
    )

    if options.chart == "checkerboard":
        _refuse_options(options, ("marker", "dictionary", "legacy"), "a checkerboard has none")
        columns, rows = parse_size(_required_option(options, "board", "inner corners, columns by rows: --board 9x6"))
        square, unit = parse_length(_required_option(options, "square", "the side of a square: --square 25mm"))
        return checkerboard(columns, rows, square, unit, inverted=options.inverted)
    file = _board_file(options, folder)
    if file is not None:
        _refuse_options(options, ("square", "marker", "dictionary"), f"{file} says it")
        board = read_board(file)
        inverted = board.inverted if options.inverted is None else options.inverted
        legacy = board.legacy if options.legacy is None or board.rows % 2 else options.legacy
        return replace(board, inverted=inverted, legacy=legacy)
    columns, rows = parse_size(_required_option(options, "board", "squares, columns by rows: --board 4x5"))
    square, unit = parse_length(_required_option(options, "square", "the side of a square: --square 54mm"))
    marker, other = parse_length(_required_option(options, "marker", "the side of a marker: --marker 40.5mm"))
    return charuco(
        columns, rows, square, convert_length(marker, other, unit), options.dictionary or BOARD_DEFAULT_DICTIONARY,
        unit, inverted=options.inverted, legacy=options.legacy,
    )  # fmt: skip


def _required_option(options: ChartOptions, name: str, what: str) -> str:
    value = getattr(options, name)
    if value is None:
        raise OptionError("chart", f"--chart {options.chart} needs --{name}", remedy=f"say {what}")
    return str(value)


def _refuse_options(options: ChartOptions, names: tuple[str, ...], why: str) -> None:
    for name in names:
        if getattr(options, name) is not None:
            raise OptionError("chart", f"--{name} does not go with it: {why}", remedy="leave it out")


def _board_file(options: ChartOptions, folder: Path) -> Path | None:
    if options.board is not None:
        return Path(options.board) if options.board.lower().endswith(".toml") else None
    return next((place / BOARD_FILE for place in (folder, folder.parent) if (place / BOARD_FILE).is_file()), None)


def calibrate_from_charts(folder: Path, output: Path, options: ChartOptions, *, overwrite: bool, quiet: bool) -> None:
    """Calibrate the rig whose charts are in `folder`; write transforms.json, sparse/0 and report.json to `output`;
    print the table of its cameras."""
    from eigenfield.calibration.charts.calibrate import calibrate_charts
    from eigenfield.capture.writers.save import save_calibration

    started = time.monotonic()
    board = board_of(options, folder)
    with progress_bars(quiet) as progress:
        result = calibrate_charts(folder, board, progress=progress)
    note_all(result.problems, quiet)
    report = json.dumps(result.describe(), indent=1, allow_nan=False) + "\n"
    save_calibration(result.light_field(output), output, overwrite=overwrite, more={REPORT_FILE: report.encode()})
    click.echo("\n".join([*table(result), f"{output}: {summary(result)}, {time.monotonic() - started:.0f} s"]))


def table(result: ChartCalibration) -> list[str]:
    """One line a camera, under a heading."""
    rows = [("camera", "boards", "corners", "rms", "median", "focal", "seen", "from first", "estimated")]
    first = next(report.camera for report in result.reports if report.camera is not None)
    for report in result.reports:
        figures = ("-", "-", "-", _pattern_text(report), "-", report.reason or "")
        if report.camera is not None:
            away = float(sum((report.camera.centre - first.centre) ** 2) ** 0.5)
            figures = (
                f"{report.rms:.2f} px", f"{report.median:.2f} px",
                f"{report.camera.K[0, 0]:.1f} ± {report.focal_deviation:.1f}", _pattern_text(report),
                f"{away:.4g} {result.unit}".rstrip(), report.model,
            )  # fmt: skip
        rows.append((report.name, f"{report.used}/{report.boards}/{report.pictures}", str(report.corners), *figures))
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def _pattern_text(report: CameraReport) -> str:
    if report.inverted is None:
        return "-"
    return ("inverted" if report.inverted else "as printed") + (", from behind" if report.mirrored else "")


def summary(result: ChartCalibration) -> str:
    """The rig in one line."""
    cameras = [report for report in result.reports if report.camera is not None]
    unit = f" in {result.unit}" if result.unit else ""
    views = sum(report.used for report in cameras)
    return (
        f"{len(cameras)} of {len(result.reports)} cameras{unit}, {views} views of the {result.board}, "
        f"reprojection {result.rms:.2f} px rms, {result.median:.2f} px median"
    )
