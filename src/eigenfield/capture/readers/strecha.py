"""Strecha's dense multi-view sets: one `*.camera` file a photograph, named `0000.jpg.camera`.

Three rows of K; three zeros (distortion: the photographs are without); three rows of R; the camera's centre; width and
height that K is for. **R is camera-to-world**: its columns are the camera's axes, x right, y down, z forward, so
P = K [R^T | -R^T C]. C. Strecha et al., "On Benchmarking Camera Calibration and Multi-View Stereo for High
Resolution Imagery", CVPR 2008.
"""

from __future__ import annotations

import os
from pathlib import Path

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, read_each
from eigenfield.capture.readers.skew import remove_skew
from eigenfield.capture.readers.text import check_finite, check_size, damaged_error, files_in, parse_numbers, read_text
from eigenfield.core.errors import CaptureError, one_line

STRECHA_SUFFIX = ".camera"
STRECHA_FOLDERS = ("", "gt_dense_cameras", "cameras", "images")  # then any other, in name order
STRECHA_NUMBERS = 9 + 3 + 9 + 3 + 2  # in a file: K, distortion, R, centre, size
STRECHA_MAX_BYTES = 64 * 1024
STRECHA_MAX_FOLDERS = 1000  # beside the photographs that are searched


def find_strecha(folder: Path) -> Path | None:
    """The folder itself or one directly in it that holds `*.camera` files, usual names first."""
    for name in STRECHA_FOLDERS:
        if _camera_files(folder / name):
            return folder / name
    for inner in _inner_folders(folder):
        if _camera_files(inner):
            return inner
    return None


def _inner_folders(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    with os.scandir(folder) as entries:
        return sorted(Path(e.path) for e in entries if not e.name.startswith(".") and e.is_dir())[:STRECHA_MAX_FOLDERS]


def _camera_files(folder: Path) -> list[Path]:
    return [path for path in files_in(folder) if path.name.endswith(STRECHA_SUFFIX)]


def read_strecha(path: Path) -> Calibration:
    """Every `*.camera` file of a folder (or of the folder of the file that is named) as an entry.

    Files that cannot be used become errors of their own. Raises CaptureError `calibration-empty` where there is none.
    """
    folder = path.parent if path.is_file() else path
    files = _camera_files(folder)
    if not files:
        raise CaptureError(
            "calibration-empty", f"holds no *{STRECHA_SUFFIX}", path=folder, remedy="name another folder"
        )
    entries, errors = read_each(_read_entry, files)
    return Calibration(folder, "strecha", entries, errors)


def _read_entry(path: Path) -> Entry:
    name = path.name.removesuffix(STRECHA_SUFFIX)
    label = one_line(name)
    values = parse_numbers(read_text(path, STRECHA_MAX_BYTES).split(), STRECHA_NUMBERS, "it", path)
    check_finite([values], label, path)
    K, distortion, R, centre, size = values[:9], values[9:12], values[12:21], values[21:24], values[24:]
    if distortion.any():
        raise CaptureError(
            "camera-model",
            f"{label} has distortion coefficients, of which the format does not say what they mean",
            path=path,
            remedy="undistort the photographs and write zeros",
        )
    straight, lens = remove_skew(K.reshape(3, 3), label, path)
    width, height = check_size(size[0], size[1], label, path)
    if straight[0, 2] > 10 * width or straight[1, 2] > 10 * height:
        raise damaged_error(path, f"the principal point of {label} is far outside its {width}x{height} pixels")
    return Entry(name, label, Intrinsics.of_matrix(straight, width, height), R.reshape(3, 3).T, centre, lens)
