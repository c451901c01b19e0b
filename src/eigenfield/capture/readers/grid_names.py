"""Grid names: `PREFIX_RR_CC.ext`, `x3_y11.png`, `row 3 col 11`, or as a pattern says; any constant ending.

Without letters the two numbers that differ between the names are row and column, in this order. A letter or word before
each of them (`GRID_WORDS`) says which is which. Which way rows and columns run is not said. A date and time
(`20210430_080617`) also looks like this: numbers have three digits at most, and at least half of the nodes must hold a
photograph. One row alone looks like numbered frames: it must be asked for.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from eigenfield.capture.arrangement import (
    NAMES_MIN_FRACTION,
    NAMES_MIN_PHOTOGRAPHS,
    Arrangement,
    make_grid_layout,
    photographs_of,
    require_photographs,
)
from eigenfield.capture.readers.stanford import find_stanford
from eigenfield.core.errors import CaptureError, OptionError, one_line
from eigenfield.core.open_options import OpenOptions

GRID_MAX_NODE_NUMBER = 999
GRID_MIN_FILLED_FRACTION = 0.5  # of the nodes must hold a photograph for the names to be taken for a grid
GRID_WORDS = {("row", "col"), ("row", "column"), ("r", "c"), ("y", "x"), ("v", "u"), ("t", "s")}  # of row, of column
GRID_LABEL = r"(?<![a-z])(row|r|y|v|t|column|col|c|x|u|s)[ _=(-]{0,2}?(-?\d{1,9})"
GRID_LABELLED_NAMES = re.compile(rf"{GRID_LABEL}[ _,;.)-]{{0,3}}{GRID_LABEL}(?!\d)", re.IGNORECASE)
GRID_SEPARATOR = re.compile(r"_|[ ]?[-,x][ ]?|[ ]|, ?|_-_", re.IGNORECASE)  # between a row and a column without words
GRID_PATTERN_FIELDS = re.compile(r"\{(row|col)\}|(\*)")


class _Nodes(NamedTuple):
    """Photographs of a folder on nodes of a grid.

    Attributes:
        rows: Of each of `files`.
    """

    files: list[Path]
    others: list[Path]
    rows: list[int]
    columns: list[int]


def find_grid_names(folder: Path) -> Path | None:
    """The folder, if its photographs have grid names of several rows and columns.

    Raises CaptureError `format-ambiguous` where they may be one row or column of a grid as well as numbered frames.
    """
    if find_stanford(folder):
        return None
    files, others, rows, columns = _find_nodes(folder)
    if len(files) < NAMES_MIN_PHOTOGRAPHS or len(files) < NAMES_MIN_FRACTION * (len(files) + len(others)):
        return None
    if max(map(abs, rows + columns)) > GRID_MAX_NODE_NUMBER:
        return None
    shape = len(set(rows)), len(set(columns))
    if len(files) < GRID_MIN_FILLED_FRACTION * shape[0] * shape[1]:
        return None
    if min(shape) == 1:
        line = "row" if shape[0] == 1 else "column"
        raise CaptureError(
            "format-ambiguous",
            f"{one_line(files[0].name)} and the like may be one {line} of a grid, or just numbered",
            path=folder,
            remedy="say --format grid, or --format folder",
        )
    return folder


def read_grid_names(folder: Path, options: OpenOptions) -> Arrangement:
    """The grid of a folder with grid names, or with names as `options.pattern` describes them.

    Raises CaptureError: `names-unknown`, `node-twice`, `grid-size`; OptionError `pattern-unknown`.
    """
    if options.pattern is None:
        found, what = _find_nodes(folder), "*_RR_CC, rowR_colC, xC_yR or the like with two numbers that differ"
    else:
        found, what = _match_pattern(folder, options.pattern), f"like {one_line(options.pattern)}"
    require_photographs(found.files, folder, what)
    layout, problems = make_grid_layout(found.files, found.rows, found.columns, options, folder)
    return Arrangement("grid", tuple(found.files), layout, tuple(problems), tuple(found.others))


def compile_pattern(pattern: str) -> re.Pattern[str]:
    """The names that a pattern describes: `{row}` and `{col}` stand for numbers, `*` for any text; the ending may be
    left out. OptionError `pattern-unknown`."""
    fields = [match[1] for match in GRID_PATTERN_FIELDS.finditer(pattern) if match[1]]
    if sorted(fields) != ["col", "row"]:
        raise OptionError(
            "pattern-unknown",
            f"--pattern {one_line(pattern)} does not hold {{row}} and {{col}} once each",
            remedy="say it as 'view_{row}_{col}.png'",
        )
    parts, at = [], 0
    for match in GRID_PATTERN_FIELDS.finditer(pattern):
        parts += [re.escape(pattern[at : match.start()]), ".*" if match[2] else rf"(?P<{match[1]}>-?\d{{1,9}})"]
        at = match.end()
    return re.compile("".join(parts) + re.escape(pattern[at:]), re.IGNORECASE)


def _match_pattern(folder: Path, pattern: str) -> _Nodes:
    names = compile_pattern(pattern)
    files = photographs_of(folder)
    matches = [names.fullmatch(path.name) or names.fullmatch(path.stem) for path in files]
    fitting = [(path, match) for path, match in zip(files, matches, strict=True) if match]
    others = [path for path, match in zip(files, matches, strict=True) if not match]
    rows, columns = ([int(match[key]) for _, match in fitting] for key in ("row", "col"))
    return _Nodes([path for path, _ in fitting], others, rows, columns)


def _find_nodes(folder: Path) -> _Nodes:
    """The nodes of the names with words, else of those with numbers alone; whichever are more."""
    labelled = _find_labelled(folder)
    files, others, fields = largest_name_group(folder, _row_and_column)
    pair = _row_and_column(fields)
    if pair is None or len(labelled.files) >= len(files):
        return labelled
    rows, columns = ([int(f[i]) for f in fields] for i in pair)
    return _Nodes(files, others, rows, columns)


def _find_labelled(folder: Path) -> _Nodes:
    """The largest group of names that have words before row and column, and are the same but for the numbers."""
    files = photographs_of(folder)
    groups: dict[tuple[object, ...], list[tuple[Path, str, str]]] = defaultdict(list)
    for path in files:
        match = GRID_LABELLED_NAMES.search(path.stem)
        while match:
            first, one, second, other = match.groups()
            words = first.lower(), second.lower()
            if words in GRID_WORDS or words[::-1] in GRID_WORDS:
                row, column = (one, other) if words in GRID_WORDS else (other, one)
                key = words, path.stem[: match.start()], path.stem[match.end() :]
                groups[key].append((path, row, column))
                break
            match = GRID_LABELLED_NAMES.search(path.stem, match.start() + 1)
    best = max(groups.values(), key=len, default=[])
    chosen = {path for path, _, _ in best}
    rows, columns = _signed([row for _, row, _ in best]), _signed([column for _, _, column in best])
    return _Nodes([path for path, _, _ in best], [path for path in files if path not in chosen], rows, columns)


def _signed(words: list[str]) -> list[int]:
    """Numbers of words; a minus before each of them only separates."""
    return [abs(int(word)) for word in words] if all(w.startswith("-") for w in words) else [int(w) for w in words]


def largest_name_group(
    folder: Path, fits: Callable[[list[list[str]]], object] = bool
) -> tuple[list[Path], list[Path], list[list[str]]]:
    """The largest group of photographs whose names differ in numbers alone.

    Args:
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
    if len(varying) == 2:
        between = fields[0][varying[0] + 1]
        return (varying[0], varying[1]) if varying[1] == varying[0] + 2 and GRID_SEPARATOR.fullmatch(between) else None
    joined = [(i, i + 2) for i in places[:-1] if fields[0][i + 1] == "_"]
    if len(varying) != 1:
        return None
    touching = [pair for pair in joined if varying[0] in pair]
    return touching[0] if len(touching) == 1 else None
