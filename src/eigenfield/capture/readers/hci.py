"""The HCI 4D Light Field Benchmark (https://lightfield-analysis.uni-konstanz.de): `input_CamNNN.png`, `parameters.cfg`.

NNN counts row by row from the top left: column + 1 is a step to the right, row + 1 a step *down* (Stanford's numbers
are row and column, and mostly run up). The scenes are rendered: the grid is exact, and the pictures share the plane in
focus. With the cfg the cameras are whole: f = focal length / sensor x the longer side, a step is the baseline b, and at
the focus distance F the shifted pinholes have no parallax, so that a step moves a point at depth Z by b f (1/Z - 1/F)
pixels to the left (HCI's disparity). World: metres, the middle of the grid at the origin, looking along +z; not
Blender's frame, which the cfg also states.
"""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from eigenfield.capture.arrangement import (
    Arrangement,
    describe_missing_nodes,
    find_by_names,
    make_grid_layout,
    match_names,
    require_photographs,
)
from eigenfield.capture.calibration import CALIBRATION_MAX_MAGNITUDE, Calibration, Entry, Intrinsics
from eigenfield.capture.layout import GridLayout
from eigenfield.capture.readers.text import CALIBRATION_MAX_SIDE_PIXELS, read_text
from eigenfield.core.errors import CaptureError
from eigenfield.core.open_options import OpenOptions

log = logging.getLogger(__name__)

HCI_NAMES = re.compile(r"input_cam_?(\d{1,5})", re.IGNORECASE)
HCI_PARAMETERS_FILE = "parameters.cfg"
HCI_MAX_PARAMETERS_BYTES = 2**20
HCI_MAX_SIDE_CAMERAS = 1000  # along a side of the grid of a cfg

find_hci = find_by_names(HCI_NAMES)


@dataclass(frozen=True)
class HciParameters:
    """The contents of a parameters.cfg.

    Attributes:
        width: Pixels.
        height: Pixels.
        focal: Pixels.
        columns: Cameras.
        rows: Cameras.
        baseline: Metres between neighbouring cameras.
        focus: Metres from the cameras to the plane without disparity.
        disparities: (lowest, highest) of the scene, pixels a step; None where the file does not state them.
    """

    width: int
    height: int
    focal: float
    columns: int
    rows: int
    baseline: float
    focus: float
    disparities: tuple[float, float] | None

    def depth(self, disparity: float) -> float:
        """1/Z = d / (b f) + 1/F; infinite beyond the horizon."""
        inverse = disparity / (self.baseline * self.focal) + 1 / self.focus
        return 1 / inverse if inverse > 0 else math.inf


def read_hci(folder: Path, options: OpenOptions) -> Arrangement:
    """The grid of a folder with HCI's names, and its cameras where parameters.cfg states them.

    A cfg that is absent, damaged or of another grid leaves the grid without cameras, and a line that says so. The grid
    is then `options.grid`, or a square if the numbers fill one.

    Raises:
        CaptureError: `names-unknown`, `node-twice`, `grid-size`.
    """
    fitting, others = match_names(folder, HCI_NAMES)
    require_photographs(fitting, folder, "input_CamNNN")
    files = tuple(path for path, _ in fitting)
    numbers = [int(match[1]) for _, match in fitting]
    parameters, problems = _find_parameters(files[0].parent, folder, max(numbers), options.grid)
    shape = options.grid if parameters is None else (parameters.rows, parameters.columns)
    if shape is None:
        shape = _square_grid(numbers, folder)
    if max(numbers) >= shape[0] * shape[1]:
        raise CaptureError(
            "grid-size",
            f"the last photograph has the number {max(numbers)}, but a grid of {shape[0]}x{shape[1]} ends at "
            f"{shape[0] * shape[1] - 1}",
            path=folder,
            remedy="say the right --grid ROWSxCOLUMNS",
        )
    rows, columns = [n // shape[1] for n in numbers], [n % shape[1] for n in numbers]
    layout, _ = make_grid_layout(files, rows, columns, OpenOptions(), folder)
    layout = replace(layout, signs=True, rectified=True, exact=True)
    problems = [*problems, *describe_missing_nodes(layout)]
    if parameters is None:
        return Arrangement("hci", files, layout, tuple(problems), tuple(others))
    layout = replace(layout, positions=layout.positions * parameters.baseline, measured=True)
    entries = tuple(_make_entry(path, layout, i, parameters) for i, path in enumerate(files))
    calibration = Calibration(files[0].parent / HCI_PARAMETERS_FILE, "hci", entries)
    return Arrangement("hci", files, layout, tuple(problems), tuple(others), calibration)


def _square_grid(numbers: list[int], folder: Path) -> tuple[int, int]:
    side = math.isqrt(max(numbers) + 1)
    if side * side != max(numbers) + 1:
        raise CaptureError(
            "grid-size",
            f"{HCI_PARAMETERS_FILE} says no grid, and numbers up to {max(numbers)} fill no square one",
            path=folder,
            remedy="say --grid ROWSxCOLUMNS",
        )
    return side, side


def _make_entry(path: Path, layout: GridLayout, index: int, parameters: HciParameters) -> Entry:
    x = (layout.columns[index] - (parameters.columns - 1) / 2) * parameters.baseline
    y = (layout.rows[index] - (parameters.rows - 1) / 2) * parameters.baseline
    f, width, height = parameters.focal, parameters.width, parameters.height
    principal = (width / 2 + f * x / parameters.focus, height / 2 + f * y / parameters.focus)
    bounds = None
    if parameters.disparities is not None:
        near, far = (parameters.depth(d) for d in reversed(parameters.disparities))
        bounds = (near, far) if near <= far < math.inf else None
    intrinsics = Intrinsics(width, height, (f, f), None, principal)
    return Entry(path.name, path.name, intrinsics, np.eye(3), np.array([x, y, 0.0]), bounds=bounds)


def _find_parameters(
    inner: Path, folder: Path, last: int, grid: tuple[int, int] | None
) -> tuple[HciParameters | None, list[str]]:
    """The cfg beside the photographs or in the folder above, if it can be used; else a line with the reason."""
    path = next((p for p in (inner / HCI_PARAMETERS_FILE, folder / HCI_PARAMETERS_FILE) if p.is_file()), None)
    if path is None:
        return None, [f"no {HCI_PARAMETERS_FILE}: the grid is known, but neither focal length nor distance"]
    try:
        found = read_parameters(path)
    except CaptureError as error:
        log.warning("%s", error)
        return None, [f"{HCI_PARAMETERS_FILE} cannot be used: {error.message}"]
    size = (found.rows, found.columns)
    if last >= size[0] * size[1] or (grid is not None and grid != size):
        reason = f"--grid says {grid[0]}x{grid[1]}" if grid else f"there is a photograph with the number {last}"
        return None, [f"{HCI_PARAMETERS_FILE} cannot be used: it is for {size[0]}x{size[1]} cameras, but {reason}"]
    return found, []


def read_parameters(path: Path) -> HciParameters:
    """A parameters.cfg; unknown keys are skipped. CaptureError `calibration-damaged` and as `read_text`."""
    values = _parse_values(read_text(path, HCI_MAX_PARAMETERS_BYTES))

    def number(section: str, key: str, fits: Callable[[float], bool] = lambda value: True) -> float:
        try:
            value = float(values[section, key])
        except (KeyError, ValueError):
            raise _damaged_error(path, f"{key} in [{section}] is no number or absent") from None
        if not (abs(value) <= CALIBRATION_MAX_MAGNITUDE and fits(value)):
            raise _damaged_error(path, f"{key} in [{section}] is {value:g}")
        return value

    def positive(section: str, key: str) -> float:
        return number(section, key, lambda value: value > 0)

    def whole(section: str, key: str, limit: int) -> int:
        return int(number(section, key, lambda value: 1 <= value <= limit and value == round(value)))

    width = whole("intrinsics", "image_resolution_x_px", CALIBRATION_MAX_SIDE_PIXELS)
    height = whole("intrinsics", "image_resolution_y_px", CALIBRATION_MAX_SIDE_PIXELS)
    focal = positive("intrinsics", "focal_length_mm") / positive("intrinsics", "sensor_size_mm") * max(width, height)
    columns, rows = (whole("extrinsics", f"num_cams_{axis}", HCI_MAX_SIDE_CAMERAS) for axis in "xy")
    baseline = positive("extrinsics", "baseline_mm") / 1000
    focus = positive("extrinsics", "focus_distance_m")
    try:
        disparities = (number("meta", "disp_min"), number("meta", "disp_max"))
    except CaptureError:  # a help, not needed
        disparities = None
    if disparities is not None and disparities[0] > disparities[1]:
        disparities = None
    if not (CALIBRATION_MAX_MAGNITUDE > focal * baseline > 1 / CALIBRATION_MAX_MAGNITUDE):
        raise _damaged_error(path, f"a focal length of {focal:g} pixels and a baseline of {baseline:g} m")
    return HciParameters(width, height, focal, columns, rows, baseline, focus, disparities)


def _parse_values(lines: str) -> dict[tuple[str, str], str]:
    """`key = value` lines by section and key; anything else is passed over."""
    values, section = {}, ""
    for line in lines.splitlines():
        head = re.fullmatch(r"\s*\[([^\]]*)\]\s*", line)
        if head:
            section = head[1]
        elif "=" in line:
            key, value = line.split("=", 1)
            values[section, key.strip().lower()] = value.strip()
    return values


def _damaged_error(path: Path, message: str) -> CaptureError:
    return CaptureError("calibration-damaged", message, path=path, remedy="copy it again")
