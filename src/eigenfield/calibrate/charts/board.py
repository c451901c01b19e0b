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

Chart = Literal["checkerboard", "charuco"]
METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
UNIT_NAMES = {**{unit: unit for unit in METRES}, "inch": "in", "inches": "in", '"': "in", "meter": "m", "metre": "m"}
LARGEST = 100  # squares along a side
TOML_LIMIT = 64 * 1024  # bytes
DICTIONARY = "DICT_4X4_1000"


@dataclass(frozen=True)
class Board:
    """A flat board whose corners are known.

    kind: "checkerboard" or "charuco".
    columns, rows: inner corners of a checkerboard (what OpenCV counts), squares of a ChArUco board.
    square: side of a square, in `unit`. unit: "mm", "cm", "m", "in", or "" where nobody said.
    marker: side of a marker, in `unit`; dictionary: OpenCV's name of the markers' dictionary; ChArUco only.
    inverted: printed white on black; None: both are tried, camera by camera.
    legacy: ChArUco as OpenCV drew it before 4.6, a marker in the top left square of boards with an even number of rows;
        None: both are tried.
    """

    kind: Chart
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
        """Columns and rows of the corners that are looked for."""
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
        """Rotations of the board that no picture of it can tell apart, the identity first.

        Each is (n,) int64: the corner that takes the place of corner i. A ChArUco board and a checkerboard with one
        even and one odd side have only the identity: turned by 180 degrees, markers or colours tell.
        """
        return [turn for turn, swapped in self._turns() if not swapped]

    def recolouring(self) -> NDArray[np.int64] | None:
        """A rotation of a checkerboard that exchanges black and white, None where there is none."""
        return next((turn for turn, swapped in self._turns() if swapped), None)

    def _turns(self) -> list[tuple[NDArray[np.int64], bool]]:
        """Rotations of the grid of corners onto itself, and whether each exchanges the colours of the squares."""
        columns, rows = self.corners
        index = np.arange(columns * rows).reshape(rows, columns)
        if self.kind == "charuco":
            return [(index.ravel(), False)]
        quarter = (rows - 2) % 2 == 1  # where the first inner square goes under np.rot90, an odd number of squares away
        turns = [(index.ravel(), False), (index[::-1, ::-1].ravel(), (columns + rows) % 2 == 1)]
        if columns == rows:
            turns += [(np.rot90(index, k).ravel(), quarter) for k in (1, 3)]
        return turns

    def __str__(self) -> str:
        if self.kind == "checkerboard":
            return f"checkerboard of {self.columns}x{self.rows} inner corners"
        return f"ChArUco board of {self.columns}x{self.rows} squares ({self.dictionary})"


def checkerboard(columns: int, rows: int, square: float, unit: str = "", *, inverted: bool | None = None) -> Board:
    """A checkerboard of `columns` x `rows` inner corners; OptionError (`board-size`, `square`) if it cannot be."""
    _check(columns, rows, square, 3, "inner corners")
    return Board("checkerboard", columns, rows, square, unit, inverted=inverted)


def charuco(
    columns: int,
    rows: int,
    square: float,
    marker: float,
    dictionary: str = DICTIONARY,
    unit: str = "",
    *,
    inverted: bool | None = None,
    legacy: bool | None = None,
) -> Board:
    """A ChArUco board of `columns` x `rows` squares; OptionError (`board-size`, `square`, `marker`, `dictionary`)."""
    _check(columns, rows, square, 3, "squares")
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
    """OpenCV's names of its square dictionaries of markers."""
    names = [name for name in dir(cv2.aruco) if re.fullmatch(r"DICT_(\dX\d_\d+|ARUCO_ORIGINAL|APRILTAG_\w+)", name)]
    return list({name.casefold(): name for name in names}.values())  # AprilTags are there twice: 36h11 and 36H11


def _check(columns: int, rows: int, square: float, least: int, what: str) -> None:
    if not (least <= columns <= LARGEST and least <= rows <= LARGEST):
        raise OptionError(
            "board-size", f"a board of {columns}x{rows} {what} cannot be", remedy=f"{least} to {LARGEST} a side"
        )
    if not (np.isfinite(square) and square > 0):
        raise OptionError("square", f"a square of {square:g} cannot be", remedy="measure the side of a square")


def parse_size(text: str) -> tuple[int, int]:
    """ "9x6" as (9, 6); OptionError `board-size`."""
    match = re.fullmatch(r"\s*(\d{1,6})\s*[xX×*,]\s*(\d{1,6})\s*", text)
    if match is None:
        raise OptionError("board-size", f"{text!r} is no size of a board", remedy="write COLUMNSxROWS, such as 9x6")
    return int(match[1]), int(match[2])


def parse_length(text: str) -> tuple[float, str]:
    """ "25mm" as (25.0, "mm"), "25" as (25.0, ""); OptionError `length`."""
    match = re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*([a-z\"]*)\s*", text.lower())
    if match is None or (match[2] and match[2] not in UNIT_NAMES):
        raise OptionError("length", f"{text!r} is no length", remedy=f"write a number, or one with {', '.join(METRES)}")
    return float(match[1]), UNIT_NAMES[match[2]] if match[2] else ""


def converted(length: float, unit: str, to: str) -> float:
    """A length in another unit; as it is where either unit is unknown."""
    return length * METRES[unit] / METRES[to] if unit and to and unit != to else length


def read_board(path: Path) -> Board:
    """A ChArUco board from a `charuco.toml`, as caliscope writes it.

    columns, rows; the square's side from `square_size_override_cm` (or `square_size_cm`), else from the sheet's
    `board_width` and `board_height` in `units`; the marker as `aruco_scale` of it; `dictionary`, `inverted`,
    `legacy_pattern`. Raises CaptureError `board-file`, or OptionError as `charuco` does.
    """
    try:
        with path.open("rb") as file:
            data = file.read(TOML_LIMIT)
        top = tomllib.loads(data.decode("utf-8-sig"))
    except OSError as error:
        raise _broken(path, error.strerror or "cannot be read") from error
    except ValueError as error:
        raise _broken(path, f"is no valid TOML ({str(error).splitlines()[0][:100]})") from error
    columns, rows = (_whole(top, key, path) for key in ("columns", "rows"))
    square, unit = _square(top, columns, rows, path)
    dictionary = top.get("dictionary", DICTIONARY)
    if not isinstance(dictionary, str):
        raise _broken(path, "its dictionary is no text")
    return charuco(
        columns, rows, square, square * _positive(top, "aruco_scale", path, 0.75), dictionary, unit,
        inverted=_flag(top, "inverted", path), legacy=_flag(top, "legacy_pattern", path),
    )  # fmt: skip


def _broken(path: Path, why: str) -> CaptureError:
    return CaptureError("board-file", why, path=path, remedy="mend it, or describe the board with --board and --square")


def _square(top: Mapping[str, Any], columns: int, rows: int, path: Path) -> tuple[float, str]:
    for key in ("square_size_override_cm", "square_size_overide_cm", "square_size_cm"):
        if top.get(key) is not None:
            return _positive(top, key, path), "cm"
    unit = UNIT_NAMES.get(str(top.get("units", "")).lower(), "")
    width, height = (_positive(top, key, path) for key in ("board_width", "board_height"))
    return min(width / max(columns, 1), height / max(rows, 1)), unit


def _whole(top: Mapping[str, Any], key: str, path: Path) -> int:
    value = top.get(key)
    if not isinstance(value, int) or isinstance(value, bool):
        raise _broken(path, f"its {key} is no whole number" if key in top else f"does not say {key}")
    return value


def _positive(top: Mapping[str, Any], key: str, path: Path, default: float | None = None) -> float:
    value = top.get(key, default)
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not 0 < value < 1e9:
        raise _broken(path, f"its {key} is no positive number" if key in top else f"does not say {key}")
    return float(value)


def _flag(top: Mapping[str, Any], key: str, path: Path) -> bool | None:
    value = top.get(key)
    if value is not None and not isinstance(value, bool):
        raise _broken(path, f"its {key} is neither true nor false")
    return value
