"""VisualSFM's NVM (http://ccwu.me/vsfm/doc.html#nvm): `NVM_V3`, then models of cameras and points, the largest first.

A camera is a line: name, focal length, the quaternion w x y z and the centre of world-to-camera with OpenCV axes, one
radial coefficient r, 0. The principal point is the middle. **r is of the measured point**: m (1 + r |m|^2), m in units
of the focal length, is where a pinhole would see it. Its inverse as a series is Metashape's polynomial (Lagrange):
k1 = -r, k2 = 3 r^2, k3 = -12 r^3, k4 = 55 r^4. The head may say `FixedK fx cx fy cy r` for all cameras. Blanks in names
are written as a quotation mark. Points are passed over.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, read_each
from eigenfield.capture.locate import PhotographFinder
from eigenfield.capture.photographs.lens import Lens, metashape_distortion
from eigenfield.capture.photographs.read import read_header
from eigenfield.capture.readers.text import (
    check_finite,
    check_lens,
    damaged_error,
    excerpt,
    parse_numbers,
    read_head,
    unreadable_error,
)
from eigenfield.core.errors import CaptureError, one_line

NVM_HEAD = "NVM_V3"
NVM_NUMBERS = 10  # of a camera: focal length, quaternion, centre, radial coefficient, 0
NVM_MAX_LINE_CHARACTERS = 4096  # the rest of a line, of a point's measurements, is not kept
NVM_MAX_LENS_PIXELS = 0.25  # by which the series may miss a photograph's corner


def find_nvm(folder: Path) -> Path | None:
    """The first `*.nvm` of a folder that begins as one."""
    paths = (path for path in sorted(folder.glob("*.nvm")) if path.is_file())
    return next((path for path in paths if read_head(path, 16).startswith(NVM_HEAD.encode())), None)


def read_nvm(path: Path, photographs: Path | None = None) -> Calibration:
    """Every camera of the first model as an entry; those that cannot be used become errors of their own.

    Args:
        photographs: Folder of the photographs, whose sizes bound the radial distortion; by default the file's own.

    Raises:
        CaptureError: `calibration-missing`, `calibration-damaged`, `calibration-empty`.
    """
    lines = _read_lines(path)
    _, head = next(lines, (1, ""))
    words = head.split()
    if words[:1] != [NVM_HEAD] or (len(words) > 1 and words[1] != "FixedK"):
        raise damaged_error(path, f"begins with {excerpt(head)!r} and not with {NVM_HEAD}", "save it as NVM_V3")
    fixed = parse_numbers(words[2:], 5, "FixedK", path) if len(words) > 1 else None
    count = _read_count(lines, path)
    if not count:
        raise CaptureError("calibration-empty", "lists no camera", path=path, remedy="name another calibration")
    cameras = list(islice(lines, count))
    if len(cameras) < count:
        raise damaged_error(path, f"ends after {len(cameras)} of {count} cameras")
    finder = PhotographFinder(path.parent if photographs is None else photographs, path.parent, False)
    entries, errors = read_each(lambda line: _make_entry(*line, fixed, finder, path), cameras)
    return Calibration(path, "nvm", entries, errors, tuple(_describe_others(lines, path)))


def _describe_others(lines: Iterator[tuple[int, str]], path: Path) -> list[str]:
    """A line about further models, behind the points of the first."""
    try:
        for _ in range(_read_count(lines, path)):
            next(lines)
        others = _read_count(lines, path)
    except (CaptureError, StopIteration):  # the file ends here, or names its PLY files
        return []
    return [f"{path.name} has another model, of {others} cameras, which is not read"] if others else []


def _read_lines(path: Path) -> Iterator[tuple[int, str]]:
    """Lines that are not empty, and their numbers, each up to a length."""
    try:
        with path.open(encoding="utf-8-sig", errors="surrogateescape") as file:
            number, begins = 1, True
            while piece := file.readline(NVM_MAX_LINE_CHARACTERS):
                if begins and piece.strip():
                    yield number, piece.strip()
                begins = piece.endswith("\n")
                number += begins
    except OSError as error:
        raise unreadable_error(path, error) from error


def _read_count(lines: Iterator[tuple[int, str]], path: Path) -> int:
    number, line = next(lines, (0, ""))
    if not (line.isascii() and line.isdigit() and len(line) < 10):
        raise damaged_error(path, f"line {number} is not a count ({excerpt(line)})")
    return int(line)


def _make_entry(
    number: int, line: str, fixed: NDArray[np.float64] | None, finder: PhotographFinder, path: Path
) -> Entry:
    from scipy.spatial.transform import Rotation  # not where another format is read

    words = line.rsplit(maxsplit=NVM_NUMBERS)  # names may hold blanks
    if len(words) != NVM_NUMBERS + 1:
        raise damaged_error(path, f"line {number} is not a name and {NVM_NUMBERS} numbers ({excerpt(line)})")
    name = words[0].replace('"', " ").strip().replace("\\", "/")
    label = f"line {number} ({one_line(name)})"
    values = parse_numbers(words[1:], NVM_NUMBERS, label, path)
    check_finite([values], label, path)
    focal, quaternion, centre, radial = float(values[0]), values[1:5], values[5:8], float(values[8])
    if not name or "\0" in name or not quaternion.any():
        raise damaged_error(path, f"{label} has no name, or a quaternion of zeros", "mend or remove it")
    fx, cx, fy, cy = (focal, None, focal, None) if fixed is None else map(float, fixed[:4])
    check_finite([v for v in (fx, cx, fy, cy) if v is not None], label, path)
    lens = _make_lens(radial or (0.0 if fixed is None else float(fixed[4])), fx, name, finder, label, path)
    R = Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()
    return Entry(name, label, Intrinsics(None, None, (fx, fy), None, (cx, cy)), R, centre, lens, stored=True)


def _make_lens(r: float, focal: float, name: str, finder: PhotographFinder, label: str, path: Path) -> Lens | None:
    """The lens of a radial coefficient; CaptureError `camera-model` where the series misses the photograph's corner."""
    if not r or not focal > 0:  # which the camera's check refuses
        return None
    lens = Lens("metashape", (-r, 3 * r**2, -12 * r**3, 55 * r**4, 0.0, 0.0, 0.0, 0.0, 0.0))
    check_lens(lens.coefficients, label, path)
    found = finder.find(name)
    try:
        corner = np.linalg.norm(read_header(found).stored_size) / 2 / focal if found is not None else 0.0
    except CaptureError:  # pairing reports it
        corner = 0.0
    back, _ = metashape_distortion(np.array(corner * (1 + r * corner**2)), np.zeros(()), lens)
    if not abs(back - corner) * focal <= NVM_MAX_LENS_PIXELS:
        raise CaptureError(
            "camera-model",
            f"{label} has a radial distortion of {r:.4g}, which is too strong to be read",
            path=path,
            remedy="undistort the photographs in VisualSFM, or leave the camera out",
        )
    return lens
