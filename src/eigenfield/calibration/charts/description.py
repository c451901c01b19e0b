"""A board as the options of `calibrate` describe it."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path

from eigenfield.calibration.charts.board import (
    BOARD_DEFAULT_DICTIONARY,
    Board,
    charuco,
    checkerboard,
    convert_length,
    parse_board_size,
    parse_length,
    read_board,
)
from eigenfield.core.errors import OptionError

BOARD_FILE = "charuco.toml"
CHART_KINDS = ("checkerboard", "charuco")


@dataclass(frozen=True)
class ChartOptions:
    """A chart as a person describes it; None for what was not given.

    Attributes:
        chart: "checkerboard" or "charuco"; None: there is none.
        board: Columns and rows, or a charuco.toml.
        square: Side of a square, with its unit.
        marker: Side of a marker, with its unit.
    """

    chart: str | None = None
    board: str | os.PathLike[str] | None = None
    square: str | None = None
    marker: str | None = None
    dictionary: str | None = None
    inverted: bool | None = None
    legacy: bool | None = None

    def __post_init__(self) -> None:
        """Raise OptionError `chart` for a board without its kind, and for a kind that is none."""
        first = next((name for name, value in vars(self).items() if value is not None), "chart")
        if first != "chart":
            remedy = "say --chart checkerboard or --chart charuco too"
            raise OptionError("chart", f"--{first} describes a chart", remedy=remedy)
        if self.chart not in (None, *CHART_KINDS):
            raise OptionError("chart", f"no chart is called {self.chart}", remedy=f"use {' or '.join(CHART_KINDS)}")


def board_of(options: ChartOptions, folder: Path) -> Board:
    """The board that the options describe, or a charuco.toml in a folder or above it.

    Raises:
        OptionError: `chart`, and as `checkerboard`, `charuco`, `parse_board_size`, `parse_length` do.
        CaptureError: `board-file`.
    """
    if options.chart == "checkerboard":
        _refuse_options(options, ("marker", "dictionary", "legacy"), "a checkerboard has none")
        columns, rows = parse_board_size(
            _required_option(options, "board", "inner corners, columns by rows: --board 9x6")
        )
        square, unit = parse_length(_required_option(options, "square", "the side of a square: --square 25mm"))
        return checkerboard(columns, rows, square, unit, inverted=options.inverted)
    file = _board_file(options, folder)
    if file is not None:
        _refuse_options(options, ("square", "marker", "dictionary"), f"{file} says it")
        board = read_board(file)
        inverted = board.inverted if options.inverted is None else options.inverted
        legacy = board.legacy if options.legacy is None or board.rows % 2 else options.legacy
        return replace(board, inverted=inverted, legacy=legacy)
    columns, rows = parse_board_size(_required_option(options, "board", "squares, columns by rows: --board 4x5"))
    square, unit = parse_length(_required_option(options, "square", "the side of a square: --square 54mm"))
    marker, other = parse_length(_required_option(options, "marker", "the side of a marker: --marker 40.5mm"))
    return charuco(
        columns, rows, square, convert_length(marker, other, unit), options.dictionary or BOARD_DEFAULT_DICTIONARY,
        unit, inverted=options.inverted, legacy=options.legacy,
    )  # fmt: skip


def _required_option(options: ChartOptions, name: str, what: str) -> str:
    value = getattr(options, name)
    if value is None:
        raise OptionError("chart", f"--chart {options.chart} needs --{name}", remedy=f"say {what}")
    return str(value)


def _refuse_options(options: ChartOptions, names: tuple[str, ...], why: str) -> None:
    for name in names:
        if getattr(options, name) is not None:
            raise OptionError("chart", f"--{name} does not go with it: {why}", remedy="leave it out")


def _board_file(options: ChartOptions, folder: Path) -> Path | None:
    if options.board is not None:
        return Path(options.board) if str(options.board).lower().endswith(".toml") else None
    return next((place / BOARD_FILE for place in (folder, folder.parent) if (place / BOARD_FILE).is_file()), None)
