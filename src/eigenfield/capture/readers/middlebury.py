"""Middlebury multi-view sets: `*_par.txt` (https://vision.middlebury.edu/mview/data/).

The first line is the count; then one camera a line: file name, K (9 numbers, row-major), R (9), t (3), for
P = K [R | t]: world-to-camera, x right, y down, z forward. The file gives no size and no distortion. Nothing says
where a pixel's centre is; K is taken as it stands.
"""

from __future__ import annotations

from pathlib import Path

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, read_each
from eigenfield.capture.readers.skew import remove_skew
from eigenfield.capture.readers.text import (
    camera_centre,
    check_finite,
    damaged_error,
    excerpt,
    parse_numbers,
    read_head,
    read_text,
)
from eigenfield.core.errors import CaptureError, one_line

MIDDLEBURY_SUFFIX = "_par.txt"
MIDDLEBURY_NUMBERS = 9 + 9 + 3  # in a line: K, R, t
MIDDLEBURY_HEAD_BYTES = 32  # in which the count must stand


def find_middlebury(folder: Path) -> Path | None:
    """The first `*_par.txt` of a folder that begins with a count."""
    paths = (path for path in sorted(folder.glob(f"*{MIDDLEBURY_SUFFIX}")) if path.is_file())
    return next((p for p in paths if read_head(p, MIDDLEBURY_HEAD_BYTES).split(b"\n")[0].strip().isdigit()), None)


def read_middlebury(path: Path) -> Calibration:
    """Every line as an entry; lines that cannot be used become errors of their own.

    Raises CaptureError (`calibration-missing`, `calibration-too-large`, `calibration-damaged`, `calibration-count`,
    `calibration-empty`) where the file as a whole cannot be used.
    """
    lines = [(i, line.strip()) for i, line in enumerate(read_text(path).split("\n"), 1) if line.strip()]
    if not lines or not (lines[0][1].isascii() and lines[0][1].isdigit() and len(lines[0][1]) < 10):
        raise damaged_error(path, "does not begin with the number of cameras", "name a *_par.txt of a Middlebury set")
    count = int(lines[0][1])
    if count != len(lines) - 1:
        raise CaptureError(
            "calibration-count",
            f"says {count} cameras and lists {len(lines) - 1}",
            path=path,
            remedy="copy it again",
        )
    if not count:
        raise CaptureError("calibration-empty", "lists no camera", path=path, remedy="name another calibration")
    entries, errors = read_each(lambda item: _parse_entry(item[1], item[0], path), lines[1:])
    return Calibration(path, "middlebury", entries, errors)


def _parse_entry(line: str, number: int, path: Path) -> Entry:
    words = line.rsplit(maxsplit=MIDDLEBURY_NUMBERS)  # names may hold spaces
    if len(words) != MIDDLEBURY_NUMBERS + 1:
        raise damaged_error(path, f"line {number} is not a name and {MIDDLEBURY_NUMBERS} numbers ({excerpt(line)})")
    name = words[0]
    label = f"line {number} ({one_line(name)})"
    values = parse_numbers(words[1:], MIDDLEBURY_NUMBERS, label, path)
    check_finite([values], label, path)
    K, R, t = values[:9].reshape(3, 3), values[9:18].reshape(3, 3), values[18:]
    K, lens = remove_skew(K, label, path)
    centre = camera_centre(R, t, label, path)
    return Entry(name.replace("\\", "/"), label, Intrinsics.of_matrix(K), R, centre, lens)
