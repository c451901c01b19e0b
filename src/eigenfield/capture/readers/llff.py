"""LLFF's `poses_bounds.npy` (https://github.com/Fyusion/LLFF): (n, 17) float64, one camera a row, no names.

A row is a 3 x 5 matrix, row-major, then the nearest and farthest depth of the scene. Columns 0-2 of the matrix are the
camera's axes in the world, in the order **down, right, backwards**; column 3 is its centre; column 4 is height, width
and focal length *of the full-size photographs*, whatever reduction lies in `images`. No distortion. The array is
parsed here: nothing is unpickled, and nothing allocated that the file does not hold.
"""

from __future__ import annotations

import re
import struct
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, read_each
from eigenfield.capture.readers.by_order import photographs_in_order
from eigenfield.capture.readers.text import check_finite, check_size, damaged_error, read_contents
from eigenfield.core.errors import CaptureError

LLFF_FILE = "poses_bounds.npy"
LLFF_COLUMNS = 17
LLFF_NPY_HEADER = re.compile(
    r"\{\s*'descr':\s*'([<>|=]?)([a-zA-Z]\d*)',\s*'fortran_order':\s*(True|False),"
    r"\s*'shape':\s*\(\s*(\d{1,12})\s*,\s*(\d{1,12})\s*,?\s*\),?\s*\}\s*"
)


def find_llff(folder: Path) -> Path | None:
    """The poses_bounds.npy of a folder, if it has one."""
    path = folder / LLFF_FILE
    return path if path.is_file() else None


def read_llff(path: Path, photographs: Path | None = None) -> Calibration:
    """Every row as an entry, with the photographs of `images/` (or `images_N/`, or the folder itself) in name order.

    `Entry.bounds` keeps the near and far depth. A row with NaN or an impossible size becomes an error of its own.

    Args:
        photographs: Folder that holds the photographs; by default the file's own.

    Raises:
        CaptureError: `calibration-missing`, `calibration-too-large`, `calibration-damaged`, `calibration-empty`,
            `calibration-count`.
    """
    rows = _parse_npy(read_contents(path), path)
    if not len(rows):
        raise CaptureError("calibration-empty", "lists no camera", path=path, remedy="name another calibration")
    names = photographs_in_order(path.parent if photographs is None else photographs, len(rows), path)
    entries, errors = read_each(lambda number: _make_entry(rows[number], names[number], number, path), range(len(rows)))
    return Calibration(path, "llff", entries, errors)


def _make_entry(row: NDArray[np.float64], name: str, number: int, path: Path) -> Entry:
    label = f"row {number} ({name})"
    matrix, (near, far) = row[:15].reshape(3, 5), row[15:]
    check_finite([matrix], label, path)
    down, right, back, centre, (height, width, focal) = matrix.T
    size = check_size(width, height, label, path)
    intrinsics = Intrinsics(*size, (float(focal), float(focal)), None, (None, None))
    # bounds are a hint: those that cannot be are left out, and the pose stays
    bounds = (float(near), float(far)) if 0 < near <= far < np.inf else None
    return Entry(name, label, intrinsics, np.stack([right, down, -back]), centre, bounds=bounds, stored=True)


def _parse_npy(data: bytes, path: Path) -> NDArray[np.float64]:
    """(n, 17) float64 from the bytes of a .npy file (https://numpy.org/neps/nep-0001-npy-format.html)."""
    if data[:6] != b"\x93NUMPY" or len(data) < 12:
        raise damaged_error(path, "is no .npy file")
    wide = data[6] >= 2  # versions 2 and 3 have four bytes for the header's length, version 1 has two
    start = 12 if wide else 10
    (length,) = struct.unpack("<I" if wide else "<H", data[8:start])
    match = LLFF_NPY_HEADER.fullmatch(data[start : start + length].decode("latin-1")) if length <= len(data) else None
    if match is None or match[2] not in ("f4", "f8") or match[1] == "|" or int(match[5]) != LLFF_COLUMNS:
        raise damaged_error(
            path,
            f"is no array of n x {LLFF_COLUMNS} floating-point numbers",
            "name a poses_bounds.npy as LLFF's imgs2poses.py writes it",
        )
    dtype = np.dtype(match[1] + match[2])
    count = int(match[4])
    body = data[start + length :]
    if len(body) != count * LLFF_COLUMNS * dtype.itemsize:
        raise damaged_error(
            path, f"has {len(body)} bytes of numbers, its header says {count * LLFF_COLUMNS * dtype.itemsize}"
        )
    values = np.frombuffer(body, dtype).astype(np.float64)
    return values.reshape(LLFF_COLUMNS, count).T if match[3] == "True" else values.reshape(count, LLFF_COLUMNS)
