"""Calibration boards: checkerboards and ChArUco boards, their corners in space, and how a person describes them."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import CaptureError, OptionError

BoardKind = Literal["checkerboard", "charuco"]
BOARD_UNIT_METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
BOARD_UNIT_NAMES = {
    **{unit: unit for unit in BOARD_UNIT_METRES},
    "inch": "in",
    "inches": "in",
    '"': "in",
    "meter": "m",
    "metre": "m",
}
BOARD_MAX_SIDE_SQUARES = 100
BOARD_MAX_TOML_BYTES = 64 * 1024
BOARD_DEFAULT_DICTIONARY = "DICT_4X4_1000"


@dataclass(frozen=True)
class Board:
    """A flat board with known corners.

    Attributes:
        kind: "checkerboard" or "charuco".
        columns: Inner corners a row of a checkerboard (as OpenCV counts), squares a row of a ChArUco board.
        rows: The same down a column.
        square: Side of a square, in `unit`.
        unit: "mm", "cm", "m", "in", or "" if unknown.
        marker: Side of a marker, in `unit`. ChArUco only.
        dictionary: OpenCV's name of the marker dictionary. ChArUco only.
        inverted: Printed white on black. None: both are tried for each camera.
        legacy: ChArUco pattern from before OpenCV 4.6, with a marker in the top left square if the number of rows is
            even. None: both are tried.
    """

    kind: BoardKind
    columns: int
    rows: int
    square: float
    unit: str = ""
    marker: float = 0.0
    dictionary: str = ""
    inverted: bool | None = None
    legacy: bool | None = None

    @property
    def corners(self) -> tuple[int, int]:
        """Columns and rows of the corners that are detected."""
        if self.kind == "checkerboard":
            return self.columns, self.rows
        return self.columns - 1, self.rows - 1

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 3) corners on the board, row by row: x along a row, y down the columns, z = 0 (into the board)."""
        columns, rows = self.corners
        y, x = np.divmod(np.arange(columns * rows), columns)
        return np.stack([x * self.square, y * self.square, np.zeros(len(x))], axis=1)

    def symmetries(self) -> list[NDArray[np.int64]]:
        """Rotations of the board that no picture can distinguish, the identity first.

        A ChArUco board and a checkerboard with one even and one odd side have only the identity: markers or colours
        show whether such a board is upside down.

        Returns:
            (n,) int64 arrays: the corner that takes the place of corner i.
        """
        return [rotation for rotation, swapped in self._rotations() if not swapped]

    def colour_swapping_rotation(self) -> NDArray[np.int64] | None:
        """A rotation of a checkerboard that swaps black and white; None if there is none."""
        return next((rotation for rotation, swapped in self._rotations() if swapped), None)

    def _rotations(self) -> list[tuple[NDArray[np.int64], bool]]:
        """Rotations of the corner grid onto itself, and whether each swaps the colours of the squares."""
        columns, rows = self.corners
        index = np.arange(columns * rows).reshape(rows, columns)
        if self.kind == "charuco":
            return [(index.ravel(), False)]
        quarter = (rows - 2) % 2 == 1  # np.rot90 moves the first inner square by an odd number of squares
        rotations = [(index.ravel(), False), (index[::-1, ::-1].ravel(), (columns + rows) % 2 == 1)]
        if columns == rows:
            rotations += [(np.rot90(index, k).ravel(), quarter) for k in (1, 3)]
        return rotations

    def __str__(self) -> str:
        if self.kind == "checkerboard":
            return f"checkerboard of {self.columns}x{self.rows} inner corners"
        return f"ChArUco board of {self.columns}x{self.rows} squares ({self.dictionary})"


def checkerboard(columns: int, rows: int, square: float, unit: str = "", *, inverted: bool | None = None) -> Board:
    """A checkerboard.

    Args:
        columns: Inner corners a row.
        rows: Inner corners a column.
        square: Side of a square, in `unit`.
        unit: "mm", "cm", "m", "in", or "" if unknown.

    Raises:
        OptionError: `board-size` or `square`: such a board cannot exist.
    """
    _check_size(columns, rows, square, 3, "inner corners")
    return Board("checkerboard", columns, rows, square, unit, inverted=inverted)


def charuco(
    columns: int,
    rows: int,
    square: float,
    marker: float,
    dictionary: str = BOARD_DEFAULT_DICTIONARY,
    unit: str = "",
    *,
    inverted: bool | None = None,
    legacy: bool | None = None,
) -> Board:
    """A ChArUco board.

    Args:
        columns: Squares a row.
        rows: Squares a column.
        square: Side of a square, in `unit`.
        marker: Side of a marker, in `unit`.
        dictionary: OpenCV's name of the marker dictionary; case and "DICT_" may be left out.
        unit: "mm", "cm", "m", "in", or "" if unknown.

    Raises:
        OptionError: `board-size`, `square`, `marker` or `dictionary`: such a board cannot exist.
    """
    _check_size(columns, rows, square, 3, "squares")
    if not 0 < marker < square:
        raise OptionError(
            "marker",
            f"a marker of {marker:g} does not fit into a square of {square:g}",
            remedy="measure both: the marker is the black square with the code in it, without its margin",
        )
    by_name = {name.casefold(): name for name in dictionaries()}
    folded = dictionary.casefold()
    name = by_name.get(folded, by_name.get(f"dict_{folded}", ""))
    if not name:
        raise OptionError(
            "dictionary",
            f"there is no dictionary of markers {dictionary}",
            remedy=f"name one of {', '.join(dictionaries())}",
        )
    capacity = len(cv2.aruco.getPredefinedDictionary(getattr(cv2.aruco, name)).bytesList)
    if columns * rows // 2 > capacity:
        raise OptionError(
            "dictionary",
            f"{name} has {capacity} markers, a board of {columns}x{rows} squares needs {columns * rows // 2}",
            remedy="name the dictionary that the board was made with",
        )
    if rows % 2:
        legacy = False  # no difference
    return Board("charuco", columns, rows, square, unit, marker, name, inverted, legacy)


def dictionaries() -> list[str]:
    """OpenCV's names of its marker dictionaries."""
    names = [name for name in dir(cv2.aruco) if re.fullmatch(r"DICT_(\dX\d_\d+|ARUCO_ORIGINAL|APRILTAG_\w+)", name)]
    return list({name.casefold(): name for name in names}.values())  # OpenCV lists AprilTags twice: 36h11 and 36H11


def _check_size(columns: int, rows: int, square: float, least: int, what: str) -> None:
    if not (least <= columns <= BOARD_MAX_SIDE_SQUARES and least <= rows <= BOARD_MAX_SIDE_SQUARES):
        raise OptionError(
            "board-size",
            f"a board of {columns}x{rows} {what} cannot be",
            remedy=f"{least} to {BOARD_MAX_SIDE_SQUARES} a side",
        )
    if not (np.isfinite(square) and square > 0):
        raise OptionError("square", f"a square of {square:g} cannot be", remedy="measure the side of a square")


def parse_board_size(text: str) -> tuple[int, int]:
    """The two numbers of a board's size.

    Args:
        text: Such as "9x6".

    Raises:
        OptionError: `board-size`: the text is no size.
    """
    match = re.fullmatch(r"\s*(\d{1,6})\s*[xX×*,]\s*(\d{1,6})\s*", text)
    if match is None:
        raise OptionError("board-size", f"{text!r} is no size of a board", remedy="write COLUMNSxROWS, such as 9x6")
    return int(match[1]), int(match[2])


def parse_length(text: str) -> tuple[float, str]:
    """A length and its unit.

    Args:
        text: Such as "25mm" or "25".

    Returns:
        The number, and "mm", "cm", "m", "in", or "" if the text has no unit.

    Raises:
        OptionError: `length`: the text is no length.
    """
    match = re.fullmatch(r"\s*(\d{1,9}\.?\d*|\.\d+)\s*([a-z\"]*)\s*", text.lower())
    if match is None or (match[2] and match[2] not in BOARD_UNIT_NAMES):
        raise OptionError(
            "length", f"{text!r} is no length", remedy=f"write a number, or one with {', '.join(BOARD_UNIT_METRES)}"
        )
    return float(match[1]), BOARD_UNIT_NAMES[match[2]] if match[2] else ""


def convert_length(length: float, unit: str, to: str) -> float:
    """A length in another unit; unchanged if either unit is unknown.

    Args:
        length: In `unit`.
        unit: "mm", "cm", "m", "in", or "".
        to: The unit of the result.
    """
    return length * BOARD_UNIT_METRES[unit] / BOARD_UNIT_METRES[to] if unit and to and unit != to else length


def read_board(path: Path) -> Board:
    """A ChArUco board from a `charuco.toml`, as caliscope writes it.

    The side of a square comes from `square_size_override_cm` (or `square_size_cm`), else from `board_width` and
    `board_height` in `units`. The side of a marker is `aruco_scale` times that.

    Raises:
        CaptureError: `board-file`: the file is missing or malformed.
        OptionError: As `charuco`.
    """
    try:
        with path.open("rb") as file:
            data = file.read(BOARD_MAX_TOML_BYTES)
        top = tomllib.loads(data.decode("utf-8-sig"))
    except OSError as error:
        raise _invalid_file(path, error.strerror or "cannot be read") from error
    except ValueError as error:
        raise _invalid_file(path, f"is no valid TOML ({str(error).splitlines()[0][:100]})") from error
    except RecursionError as error:
        raise _invalid_file(path, "is nested too deep") from error
    columns, rows = (_read_integer(top, key, path) for key in ("columns", "rows"))
    square, unit = _read_square(top, columns, rows, path)
    dictionary = top.get("dictionary", BOARD_DEFAULT_DICTIONARY)
    if not isinstance(dictionary, str):
        raise _invalid_file(path, "its dictionary is no text")
    return charuco(
        columns, rows, square, square * _read_positive(top, "aruco_scale", path, 0.75), dictionary, unit,
        inverted=_read_flag(top, "inverted", path), legacy=_read_flag(top, "legacy_pattern", path),
    )  # fmt: skip


def _invalid_file(path: Path, why: str) -> CaptureError:
    return CaptureError("board-file", why, path=path, remedy="mend it, or describe the board with --board and --square")


def _read_square(top: Mapping[str, Any], columns: int, rows: int, path: Path) -> tuple[float, str]:
    for key in ("square_size_override_cm", "square_size_overide_cm", "square_size_cm"):
        if top.get(key) is not None:
            return _read_positive(top, key, path), "cm"
    unit = BOARD_UNIT_NAMES.get(str(top.get("units", "")).lower(), "")
    width, height = (_read_positive(top, key, path) for key in ("board_width", "board_height"))
    return min(width / max(columns, 1), height / max(rows, 1)), unit


def _read_integer(top: Mapping[str, Any], key: str, path: Path) -> int:
    value = top.get(key)
    if not isinstance(value, int) or isinstance(value, bool) or abs(value) > 1e9:
        raise _invalid_file(path, f"its {key} is no whole number of squares" if key in top else f"does not say {key}")
    return value


def _read_positive(top: Mapping[str, Any], key: str, path: Path, default: float | None = None) -> float:
    value = top.get(key, default)
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not 0 < value < 1e9:
        raise _invalid_file(path, f"its {key} is no positive number" if key in top else f"does not say {key}")
    return float(value)


def _read_flag(top: Mapping[str, Any], key: str, path: Path) -> bool | None:
    value = top.get(key)
    if value is not None and not isinstance(value, bool):
        raise _invalid_file(path, f"its {key} is neither true nor false")
    return value
