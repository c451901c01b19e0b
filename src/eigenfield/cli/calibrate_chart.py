"""The part of `eigenfield calibrate` that takes pictures of a chart: its options, and the table of the cameras."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from eigenfield.cli.common import together

if TYPE_CHECKING:
    from eigenfield.calibration.charts.calibrate import CameraReport, ChartCalibration


chart_options = together(
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
