"""Cameras of a folder of photographs or of pictures of a chart, written for eigenfield and other tools."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, overload

from eigenfield.calibration.charts.calibrate import ChartCalibration, calibrate_charts
from eigenfield.calibration.charts.description import ChartOptions, board_of
from eigenfield.calibration.known import read_known_lenses
from eigenfield.calibration.motion.report import describe_motion
from eigenfield.calibration.motion.result import SfmResult
from eigenfield.calibration.motion.sfm import structure_from_motion
from eigenfield.capture import Footage, PhotoSet, open_footage, open_photographs
from eigenfield.capture.archive import is_zip
from eigenfield.capture.writers.save import refuse_folder, save_calibration
from eigenfield.core.arguments import checked
from eigenfield.core.errors import OptionError
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.progress import Progress

CALIBRATION_REPORT_FILE = "report.json"


@overload
def calibrate(
    photographs: str | os.PathLike[str] | PhotoSet | Footage,
    output: str | os.PathLike[str] | None = None,
    *,
    chart: None = None,
    **options: Any,
) -> SfmResult: ...
@overload
def calibrate(
    photographs: str | os.PathLike[str],
    output: str | os.PathLike[str] | None = None,
    *,
    chart: str,
    **options: Any,
) -> ChartCalibration: ...
@checked
def calibrate(
    photographs: str | os.PathLike[str] | PhotoSet | Footage,
    output: str | os.PathLike[str] | None = None,
    *,
    intrinsics: str | os.PathLike[str] | None = None,
    camera_per_photo: bool = False,
    matching: str = "auto",
    chart: str | None = None,
    board: str | os.PathLike[str] | None = None,
    square: str | None = None,
    marker: str | None = None,
    dictionary: str | None = None,
    inverted: bool | None = None,
    legacy: bool | None = None,
    work: str | os.PathLike[str] | None = None,
    seed: int = 0,
    overwrite: bool = False,
    progress: Progress | None = notebook_progress,
    **names: Any,
) -> SfmResult | ChartCalibration:
    """Find cameras as `eigenfield calibrate` does: of photographs by structure from motion, of a rig by a chart.

        ef.calibrate("photos/", "cameras/")
        ef.calibrate("charts/", "rig/", chart="checkerboard", board="9x6", square="25mm")

    Args:
        photographs: Their folder, or what `open_photographs` returns; a calibration beside them is not read. Footage,
            or its folder with `clip`, of which up to three instants are looked at. With a chart the folder of its
            pictures or videos, by camera.
        output: Folder for transforms.json, a COLMAP model, points and report.json; None: nothing is written.
        intrinsics: A file of known lenses, which are kept as they are.
        camera_per_photo: Estimate each photograph's lens alone.
        matching: Which photographs are compared: "auto", "exhaustive", "similar", "grid" or "positions".
        chart: "checkerboard" or "charuco"; None: the cameras are found by the scene itself.
        board: Inner corners of a checkerboard ("9x6"), squares of a ChArUco board ("4x5"), columns first, or a
            charuco.toml; None: the charuco.toml in the folder or above it.
        square: Side of a square, with its unit: "25mm".
        marker: Side of a ChArUco board's marker, with its unit.
        dictionary: Of a ChArUco board's markers; None: DICT_4X4_1000.
        inverted: Whether the board is printed white on black; None: both are tried.
        legacy: Whether OpenCV drew it before 4.6; None: both are tried.
        work: Folder that keeps features and matches, so that the next run goes on from them.
        seed: Of all random choices.
        overwrite: Whether an earlier calibration in `output` is replaced.
        progress: Called in every stage; by default bars in a notebook.
        names: Arguments of `open_path` for a folder: masks, format, grid, pattern, frame, walk_frames, clip, offset,
            rate.

    Returns:
        Of photographs: cameras, points, and what became of each photograph. Of a chart: the rig, and how well each of
        its cameras is known.

    Raises:
        CaptureError: The pictures cannot be read, or no cameras explain them.
        OptionError: An option is impossible. `video-work`: a calibration would name files that do not stay. `chart`: a
            chart needs more words, or fewer.
        OutputError: The folder may not or cannot be written.
    """
    place, folder = (None if each is None else Path(each) for each in (output, work))
    described = ChartOptions(chart, board, square, marker, dictionary, inverted, legacy)
    given = {name: value for name, value in names.items() if value not in (None, ())}
    if place is not None:
        refuse_folder(place, overwrite)
    if described.chart is not None:
        if matching != "auto":
            given["matching"] = matching
        given |= {"intrinsics": intrinsics, "camera-per-photo": camera_per_photo or None, "work": work}
        return _by_chart(photographs, place, described, given, overwrite, progress)
    photos, *also = _instants(photographs, folder, place, given)
    motion = structure_from_motion(
        photos,
        intrinsics=None if intrinsics is None else read_known_lenses(Path(intrinsics), photos),
        camera_per_photo=camera_per_photo,
        matching=matching,  # type: ignore[arg-type]
        work=folder,
        seed=seed,
        progress=progress,
        also=also,
    )
    if place is not None:
        more = {CALIBRATION_REPORT_FILE: _report(describe_motion(motion))}
        save_calibration(motion.light_field, place, motion.points, overwrite=overwrite, more=more)
    return motion


def _instants(
    photographs: str | os.PathLike[str] | PhotoSet | Footage, work: Path | None, place: Path | None,
    given: Mapping[str, Any],
) -> list[PhotoSet]:  # fmt: skip
    """The photographs without cameras: one set, or of footage one for each instant that is looked at."""
    if isinstance(photographs, PhotoSet | Footage):
        _refuse(given, "photographs that are opened already")
        opened = photographs
    elif given.get("clip") is not None:
        opened = open_footage(photographs, options=OpenOptions(work=work, **given))
    else:
        opened = open_photographs(photographs, strict=False, work=work, **given)
        if place is not None:
            refuse_passing(opened, Path(photographs), work)
    if isinstance(opened, PhotoSet):
        return [opened]
    last = len(opened) - 1
    return [opened.photographs(number) for number in sorted({0, last // 2, last})]


def _by_chart(
    folder: str | os.PathLike[str] | PhotoSet | Footage, place: Path | None, described: ChartOptions,
    others: Mapping[str, Any], overwrite: bool, progress: Progress | None,
) -> ChartCalibration:  # fmt: skip
    """The rig whose chart is in a folder, written to `place`."""
    _refuse(others, "charts")
    if isinstance(folder, PhotoSet | Footage):
        raise OptionError("chart", "opened photographs are no pictures of a chart", remedy="name their folder")
    found = calibrate_charts(folder, board_of(described, Path(folder)), progress=progress)
    if place is not None:
        more = {CALIBRATION_REPORT_FILE: _report(found.describe())}
        save_calibration(found.light_field(place), place, overwrite=overwrite, more=more)
    return found


def _refuse(options: Mapping[str, Any], what: str) -> None:
    for name, value in options.items():
        if value is not None:
            raise OptionError("chart", f"--{name} means nothing to {what}", remedy="leave it out")


def _report(values: Mapping[str, Any]) -> bytes:
    return (json.dumps(values, indent=1, allow_nan=False) + "\n").encode()


def refuse_passing(photos: PhotoSet, source: Path, work: Path | None) -> None:
    """Refuse a calibration that would name files which last as long as the process.

    Args:
        source: The file or folder that they were opened from.

    Raises:
        OptionError: `video-work`.
    """
    if work is None and (photos.format in ("video", "walk") or is_zip(source)):
        message = "what is taken out of a video or a zip must stay for the calibration to name it"
        raise OptionError("video-work", message, remedy="add --work DIR")
