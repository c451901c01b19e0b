"""Grid names: `PREFIX_RR_CC.ext`, any prefix, any constant ending (`view_03_11_rgb.png`).

The two numbers that differ between the names are row and column, in this order, with one underscore between them.
Which way rows and columns run is not said. A date and time (`20210430_080617`) also looks like this: numbers have three
digits at most, and at least half of the nodes must hold a photograph. One row alone looks like numbered frames: it must
be asked for.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

from eigenfield.capture.arrangement import (
    NAMES_MIN_FRACTION,
    NAMES_MIN_PHOTOGRAPHS,
    Arrangement,
    OpenOptions,
    make_grid_layout,
    photographs_of,
    require_photographs,
)
from eigenfield.capture.calibration import escape_name
from eigenfield.capture.readers.stanford import find_stanford
from eigenfield.core.errors import CaptureError

GRID_MAX_NODE_NUMBER = 999
GRID_MIN_FILLED_FRACTION = 0.5  # of the nodes must hold a photograph for the names to be taken for a grid


def find_grid_names(folder: Path) -> Path | None:
    """The folder, if its photographs have grid names of several rows and columns.

    Raises CaptureError `format-ambiguous` where they may be one row or column of a grid as well as numbered frames.
    """
    if find_stanford(folder):
        return None
    files, others, fields = largest_name_group(folder, _row_and_column)
    if len(files) < NAMES_MIN_PHOTOGRAPHS or len(files) < NAMES_MIN_FRACTION * (len(files) + len(others)):
        return None
    pair = _row_and_column(fields)
    if pair is None or max(max(int(f[i]) for i in pair) for f in fields) > GRID_MAX_NODE_NUMBER:
        return None
    rows, columns = ({int(f[i]) for f in fields} for i in pair)
    if len(files) < GRID_MIN_FILLED_FRACTION * len(rows) * len(columns):
        return None
    if min(len(rows), len(columns)) == 1:
        line = "row" if len(rows) == 1 else "column"
        raise CaptureError(
            "format-ambiguous",
            f"{escape_name(files[0].name)} and the like may be one {line} of a grid, or just numbered",
            path=folder,
            remedy="say --format grid, or --format folder",
        )
    return folder


def read_grid_names(folder: Path, options: OpenOptions) -> Arrangement:
    """The grid of a folder with grid names. Raises CaptureError: `names-unknown`, `node-twice`, `grid-size`."""
    files, others, fields = largest_name_group(folder, _row_and_column)
    pair = _row_and_column(fields)
    require_photographs(files if pair else [], folder, "*_RR_CC with two numbers that differ")
    assert pair is not None
    rows, columns = ([int(f[i]) for f in fields] for i in pair)
    layout, problems = make_grid_layout(files, rows, columns, options, folder)
    return Arrangement("grid", tuple(files), layout, tuple(problems), tuple(others))


def largest_name_group(
    folder: Path, fits: Callable[[list[list[str]]], object] = bool
) -> tuple[list[Path], list[Path], list[list[str]]]:
    """The largest group of photographs whose names differ in numbers alone.

    Args:
        folder: Of the photographs.
        fits: Whether a group counts, by its names in pieces.

    Returns:
        The group, the other photographs, and the group's names in pieces, text and numbers by turns.
    """
    groups: dict[tuple[str, ...], list[tuple[Path, list[str]]]] = defaultdict(list)
    files = photographs_of(folder)
    for path in files:
        pieces = re.split(r"([0-9]+)", path.stem)
        groups[tuple(pieces[::2])].append((path, pieces))
    fitting = [group for group in groups.values() if fits([pieces for _, pieces in group])]
    best = max(fitting, key=len, default=[])
    chosen = {path for path, _ in best}
    return [path for path, _ in best], [p for p in files if p not in chosen], [pieces for _, pieces in best]


def _row_and_column(fields: list[list[str]]) -> tuple[int, int] | None:
    """Indices of row and column among the pieces: the two that vary, or one that does and its only neighbour."""
    if not fields:
        return None
    places = range(1, len(fields[0]), 2)
    varying = [i for i in places if len({int(f[i]) for f in fields}) > 1]
    joined = [(i, i + 2) for i in places[:-1] if fields[0][i + 1] == "_"]
    if len(varying) == 2:
        return (varying[0], varying[1]) if (varying[0], varying[1]) in joined else None
    if len(varying) != 1:
        return None
    touching = [pair for pair in joined if varying[0] in pair]
    return touching[0] if len(touching) == 1 else None
