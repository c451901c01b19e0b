"""RealityCapture's CSV (RealityScan's too): Alignment > Export > Registration > Internal/External camera parameters.

A line `#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2`, then one camera a line. World: x east, y north, alt
up, in which meshes are exported. Degrees: a camera without any rotation looks down, its picture's top to the north;
camera-to-world = Rz(-heading) Rx(pitch) Ry(roll), with OpenGL camera axes. f is in millimetres of a sensor whose longer
side has 36; px and py are fractions of the longer side, from the middle. Distortion (Brown's) is of the normalised
coordinates: 1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8, with t1 and t2 as OpenCV's p1 and p2. The CSV does not say that a
project uses the division model instead.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, read_each
from eigenfield.capture.locate import PhotographFinder
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photographs.read import read_header
from eigenfield.capture.readers.lens_keys import refuse_lens_keys
from eigenfield.capture.readers.text import check_finite, check_lens, damaged_error, excerpt, read_head, read_text
from eigenfield.capture.readers.transforms import OPENGL_TO_OPENCV_AXES
from eigenfield.core.errors import CaptureError, one_line

REALITYCAPTURE_HEAD_BYTES = 4096
REALITYCAPTURE_SENSOR_MM = 36.0
REALITYCAPTURE_POSE = ("x", "y", "alt", "heading", "pitch", "roll")
REALITYCAPTURE_LENS = ("k1", "k2", "k3", "k4", "t1", "t2")


def find_realitycapture(folder: Path) -> Path | None:
    """The first CSV of a folder that has RealityCapture's columns."""
    for path in sorted(folder.glob("*.csv")):
        head = read_head(path, REALITYCAPTURE_HEAD_BYTES).lower()
        if path.is_file() and b"#name" in head and b"heading" in head and b"roll" in head:
            return path
    return None


def read_realitycapture(path: Path, photographs: Path | None = None) -> Calibration:
    """Every line as an entry; those that cannot be used become errors of their own.

    Args:
        photographs: Folder that holds the photographs, whose sizes the CSV does not say; by default the file's own.

    Raises:
        CaptureError: `calibration-missing`, `calibration-too-large`, `calibration-damaged`, `calibration-empty`.
    """
    lines = [line for line in read_text(path).split("\n") if line.strip()]
    first = next((i for i, line in enumerate(lines) if line.lstrip().lower().startswith("#name")), None)
    if first is None:
        raise damaged_error(path, "has no line of columns that begins with #name", "export it again")
    separator = ";" if lines[first].count(";") > lines[first].count(",") else ","
    try:
        rows = list(csv.reader(lines[first:], delimiter=separator, skipinitialspace=True))
    except csv.Error as error:
        raise damaged_error(path, f"is no CSV: {error}", "export it again") from None
    columns = [word.strip().lower().lstrip("#") for word in rows[0]]
    missing = [name for name in ("name", *REALITYCAPTURE_POSE, "f") if name not in columns]
    if missing:
        remedy = "export Internal/External camera parameters in a Cartesian coordinate system"
        raise damaged_error(path, f"has no column {', '.join(missing)}", remedy)
    cameras = [row for row in rows[1:] if row and not row[0].lstrip().startswith("#")]
    if not cameras:
        raise CaptureError("calibration-empty", "lists no camera", path=path, remedy="name another calibration")
    finder = PhotographFinder(path.parent if photographs is None else photographs, path.parent, False)
    entries, errors = read_each(lambda row: _make_entry(row, columns, finder, path), cameras)
    return Calibration(path, "realitycapture", entries, errors)


def _make_entry(row: list[str], columns: list[str], finder: PhotographFinder, path: Path) -> Entry:
    from scipy.spatial.transform import Rotation  # not where another format is read

    first = columns.index("name")
    name = row[first].strip().replace("\\", "/") if first < len(row) else ""
    label = f"camera {one_line(name)}"
    if not name or "\0" in name or len(row) < len(columns):
        raise damaged_error(path, f"{label} has {len(row)} values, not {len(columns)}", "export it again")

    def number(column: str) -> float:
        if column not in columns:
            return 0.0
        word = row[columns.index(column)].strip()
        try:
            return float(word.replace(",", "."))  # between semicolons a comma is a decimal one
        except ValueError:
            raise damaged_error(path, f"{column} of {label} is {excerpt(word)!r}, which is no number") from None

    x, y, alt, heading, pitch, roll = map(number, REALITYCAPTURE_POSE)
    check_finite([(x, y, alt, heading, pitch, roll, number("f"), number("px"), number("py"))], label, path)
    axes = Rotation.from_euler("ZXY", [-heading, pitch, roll], degrees=True).as_matrix()
    k1, k2, k3, k4, t1, t2 = map(number, REALITYCAPTURE_LENS)
    check_lens((k1, k2, k3, k4, t1, t2), label, path)
    refuse_lens_keys(dict(zip(columns, row, strict=False)), REALITYCAPTURE_LENS, label, path)
    lens = Lens("metashape", (k1, k2, k3, k4, t2, t1, 0.0, 0.0, 0.0)) if k4 else Lens("brown", (k1, k2, t1, t2, k3))
    width, height = _size_of(name, finder)
    side = max(width, height)
    focal = number("f") / REALITYCAPTURE_SENSOR_MM * side
    principal = width / 2 + number("px") * side, height / 2 + number("py") * side
    intrinsics = Intrinsics(width, height, (focal, focal), None, principal)
    R = OPENGL_TO_OPENCV_AXES @ axes.T
    return Entry(name, label, intrinsics, R, np.array([x, y, alt]), None if lens.is_identity else lens)


def _size_of(name: str, finder: PhotographFinder) -> tuple[int, int]:
    """The photograph's size; where it is missing or damaged, which pairing reports, any."""
    found = finder.find(name)
    try:
        return (1, 1) if found is None else read_header(found).upright_size
    except CaptureError:
        return 1, 1
