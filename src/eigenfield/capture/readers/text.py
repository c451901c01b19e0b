"""Small calibration files from others: read whole, up to a limit; numbers from words; errors that name the file."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.capture.calibration import CALIBRATION_MAX_MAGNITUDE, split_scale
from eigenfield.core.errors import CaptureError, one_line

CALIBRATION_MAX_BYTES = 64 * 2**20  # of one file that is read whole
CALIBRATION_MAX_SIDE_PIXELS = 1_000_000  # of a photograph in a calibration
CALIBRATION_MAX_LENS_COEFFICIENT = 1e6  # for normalised coordinates, which are around 1
ROTATION_VECTOR_MAX_LENGTH = 2 * math.pi * 1.001  # radians: pi is enough, but optimisers go on beyond
EXCERPT_MAX_CHARACTERS = 40  # of a bad word that a message repeats


def read_contents(path: Path, limit: int = CALIBRATION_MAX_BYTES) -> bytes:
    """The bytes of a file. CaptureError: `calibration-missing`, `calibration-too-large`."""
    try:
        size = path.stat().st_size
        if size > limit:
            raise CaptureError(
                "calibration-too-large",
                f"has {size} bytes, more than the {limit} that such a calibration may have",
                path=path,
                remedy="name the calibration file",
            )
        with path.open("rb") as file:
            return file.read(limit)
    except OSError as error:
        raise unreadable_error(path, error) from error


def read_text(path: Path, limit: int = CALIBRATION_MAX_BYTES) -> str:
    """The file as text with \\n line ends: UTF-8, or UTF-16 where a byte order mark says so; odd bytes stay."""
    data = read_contents(path, limit)
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        decoded = data.decode("utf-16", "replace")
    else:
        decoded = data.decode("utf-8-sig", "surrogateescape")
    return decoded.replace("\r\n", "\n").replace("\r", "\n")


def read_head(path: Path, size: int) -> bytes:
    """The first bytes of a file, without a byte order mark; none where it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(size).removeprefix(b"\xef\xbb\xbf")
    except OSError:
        return b""


def files_in(folder: Path) -> list[Path]:
    """The files of one folder in name order, hidden ones left out; none where it is no folder or cannot be read."""
    try:
        with os.scandir(folder) as entries:
            return sorted(Path(e.path) for e in entries if not e.name.startswith(".") and e.is_file())
    except OSError:
        return []


def unreadable_error(path: Path, error: OSError) -> CaptureError:
    """The error for a calibration that the operating system does not read."""
    return CaptureError("calibration-missing", error.strerror or "cannot be read", path=path, remedy="check the path")


def damaged_error(path: Path, message: str, remedy: str = "copy or export it again") -> CaptureError:
    """Something in a calibration that is not as its format has it."""
    return CaptureError("calibration-damaged", message, path=path, remedy=remedy)


def excerpt(word: object) -> str:
    """A word from a file as a message repeats it: one short line."""
    line = one_line(str(word)[: EXCERPT_MAX_CHARACTERS + 1])
    return line if len(line) <= EXCERPT_MAX_CHARACTERS else f"{line[:EXCERPT_MAX_CHARACTERS]}..."


def parse_numbers(words: Sequence[str], count: int, what: str, path: Path) -> NDArray[np.float64]:
    """Numbers from words.

    Args:
        words: As a file has them; NaN and infinities are allowed.

    Returns:
        (count,) float64.

    Raises:
        CaptureError: `calibration-damaged`.
    """
    if len(words) != count:
        raise damaged_error(path, f"{what} has {len(words)} numbers, not {count}")
    values = np.empty(count)
    for i, word in enumerate(words):
        try:
            values[i] = float(word)
        except ValueError:
            raise damaged_error(path, f"{what} holds {excerpt(word)!r}, which is no number") from None
    return values


def check_finite(values: Iterable[ArrayLike], label: str, path: Path) -> None:
    """CaptureError `camera-not-finite` where a camera holds NaN, infinities, or numbers beyond LARGEST."""
    if not all((np.abs(np.asarray(v)) <= CALIBRATION_MAX_MAGNITUDE).all() for v in values):  # False for NaN
        raise CaptureError(
            "camera-not-finite",
            f"{label} has NaN, infinite or huge entries",
            path=path,
            remedy="mend or remove its entry",
        )


def camera_centre(R: NDArray[np.float64], t: NDArray[np.float64], label: str, path: Path) -> NDArray[np.float64]:
    """(3,) the centre -R^T t of a world-to-camera pose, x_camera = R x + t, whose R may have a scale (`split_scale`);
    CaptureError as `check_finite`."""
    rotation, scale = split_scale(R)
    with np.errstate(over="ignore", invalid="ignore"):
        centre: NDArray[np.float64] = -rotation.T @ t / scale
    check_finite([centre], label, path)
    return centre


def longest_vector(vectors: Iterable[ArrayLike]) -> float:
    """The greatest length of rotation vectors; 0 for none."""
    return max((float(np.linalg.norm(np.asarray(vector, np.float64))) for vector in vectors), default=0.0)


def check_rotation_vector(longest: float, label: str, path: Path) -> None:
    """CaptureError `camera-rotation-vector` where rotations of three numbers are no vectors in radians.

    Args:
        longest: Of all vectors of the file: small angles in degrees are told by others beside them.
    """
    if longest > ROTATION_VECTOR_MAX_LENGTH:
        raise CaptureError(
            "camera-rotation-vector",
            f"{label} has a rotation of three numbers, and those of this file are up to {longest:.4g} long, more than "
            "2 pi: degrees and Euler angles are not read",
            path=path,
            remedy="give rotation vectors in radians, as cv2.Rodrigues makes them, or 3x3 matrices",
        )


def check_lens(coefficients: Iterable[float], label: str, path: Path) -> None:
    """CaptureError `lens` where coefficients are no distortion that a lens could have."""
    if not all(abs(c) <= CALIBRATION_MAX_LENS_COEFFICIENT for c in coefficients):  # False for NaN
        raise CaptureError(
            "lens", f"{label} has lens coefficients that are huge or not finite", path=path, remedy="mend them"
        )


def check_size(width: float, height: float, label: str, path: Path) -> tuple[int, int]:
    """Whole pixels from numbers; CaptureError `camera-size`."""
    if not all(1 <= side <= CALIBRATION_MAX_SIDE_PIXELS and side == round(side) for side in (width, height)):
        raise CaptureError(
            "camera-size",
            f"{label} has a size of {width:g}x{height:g}",
            path=path,
            remedy="a size is a whole number of pixels: mend it",
        )
    return int(width), int(height)
