"""Names that hold a whole parallel array: `NAME_RR_CC_A_B_LENS_SENSOR.jpg` (Blender, light-field-renderer).

A is minus the height and B the position to the right, millimetres; LENS and SENSOR are the focal length and the side of
the sensor that the longer side of the picture fills, millimetres. The cameras are rendered: exact, parallel, without
shift, so that nothing is free of parallax. Row and column numbers need not start at 0 nor step by 1, and columns may
run to the left (B falls). World: metres, x right, y down, z forward; the origin is the names' own.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.arrangement import (
    Arrangement,
    find_by_names,
    make_grid_layout,
    match_names,
    require_photographs,
    with_measured_positions,
)
from eigenfield.capture.calibration import Calibration, Entry, Intrinsics
from eigenfield.capture.photographs.read import read_header
from eigenfield.core.errors import CaptureError
from eigenfield.core.open_options import OpenOptions

POSITIONS_NUMBER = r"[-+]?\d{1,9}(?:\.\d{1,12})?"
POSITIONS_NAMES = re.compile(
    rf"(?:.*_)?(\d{{1,4}})_(\d{{1,4}})_({POSITIONS_NUMBER})_({POSITIONS_NUMBER})_({POSITIONS_NUMBER})_({POSITIONS_NUMBER})"
)

find_positions = find_by_names(POSITIONS_NAMES)


def read_positions(folder: Path, options: OpenOptions) -> Arrangement:
    """The array and its cameras from names alone (and the pictures' sizes).

    Raises CaptureError: `names-unknown`, `node-twice`, `grid-size`, `names-lens` (a lens or sensor that cannot be).
    """
    fitting, others = match_names(folder, POSITIONS_NAMES)
    require_photographs(fitting, folder, "NAME_RR_CC_A_B_LENS_SENSOR")
    files = tuple(path for path, _ in fitting)
    values = np.array([[float(word) for word in match.groups()[2:]] for _, match in fitting])
    layout, problems = make_grid_layout(
        files, [int(m[1]) for _, m in fitting], [int(m[2]) for _, m in fitting], options, folder
    )  # fmt: skip
    down, right = values[:, 0] / 1000, values[:, 1] / 1000
    layout = with_measured_positions(layout, right, -down, signs=True, rectified=False, exact=True)
    for path, (lens, sensor) in zip(files, values[:, 2:], strict=True):
        if not (lens > 0 and sensor > 0):
            raise CaptureError(
                "names-lens",
                f"its name says a lens of {lens:g} mm on a sensor of {sensor:g} mm",
                path=path,
                remedy="rename it, or say --format folder",
            )
    entries = tuple(
        _make_entry(path, lens / sensor, np.array([x, y, 0.0]))
        for path, x, y, (lens, sensor) in zip(files, right, down, values[:, 2:], strict=True)
    )
    calibration = Calibration(files[0].parent, "positions", entries)
    return Arrangement("positions", files, layout, tuple(problems), tuple(others), calibration)


def _make_entry(path: Path, ratio: float, centre: NDArray[np.float64]) -> Entry:
    """The camera of a photograph; `ratio` is the focal length over the sensor's side."""
    try:
        width, height = read_header(path).upright_size
    except CaptureError:  # opening the capture reports it
        width = height = 1
    focal = ratio * max(width, height)
    return Entry(path.name, path.name, Intrinsics(width, height, (focal, focal), None, (None, None)), np.eye(3), centre)
