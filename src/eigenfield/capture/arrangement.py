"""Where the cameras stand according to the names of the photographs, before any of the files is opened."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration
from eigenfield.capture.layout import GridLayout
from eigenfield.capture.locate import IMAGES_FOLDER, photographs_in
from eigenfield.capture.messages import describe, natural_key
from eigenfield.capture.unread import describe_inner, describe_unread
from eigenfield.core.errors import CaptureError, one_line
from eigenfield.core.open_options import OpenOptions

NAMES_MIN_PHOTOGRAPHS = 3  # photographs that must bear a format's names
NAMES_MIN_FRACTION = 0.5  # of a folder's photographs, likewise


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Photographs of one scene as their names place them.

    Attributes:
        layout: Their nodes, in the order of `files`; None if the names state none.
        others: Photographs beside them that have other names.
        calibration: Whole cameras, where the names or a file beside them state them.
    """

    format: str
    files: tuple[Path, ...]
    layout: GridLayout | None = None
    problems: tuple[str, ...] = ()
    others: tuple[Path, ...] = ()
    calibration: Calibration | None = None


def photographs_of(folder: Path) -> list[Path]:
    """The photographs of a capture without cameras, in natural order: those in the folder, or in its `images/`.

    Raises CaptureError `photographs-twice` where both hold some, and neither few.
    """
    here, inner = photographs_in(folder), photographs_in(folder / IMAGES_FOLDER)
    if len(here) >= NAMES_MIN_PHOTOGRAPHS and len(inner) >= NAMES_MIN_PHOTOGRAPHS:
        raise CaptureError(
            "photographs-twice",
            f"holds {len(here)} photographs itself and {len(inner)} in {IMAGES_FOLDER}/",
            path=folder,
            remedy=f"name {folder / IMAGES_FOLDER}, or move the others away",
        )
    return sorted(here if len(here) >= len(inner) else inner, key=lambda path: natural_key(path.name))


def match_names(folder: Path, pattern: re.Pattern[str]) -> tuple[list[tuple[Path, re.Match[str]]], list[Path]]:
    """The photographs whose names without extension match, with their matches; and the others."""
    fitting, others = [], []
    for path in photographs_of(folder):
        match = pattern.fullmatch(path.stem)
        if match:
            fitting.append((path, match))
        else:
            others.append(path)
    return fitting, others


def find_by_names(pattern: re.Pattern[str]) -> Callable[[Path], Path | None]:
    """The `find` of a format that is recognised by its names alone: at least most of a folder's photographs bear it."""

    def find(folder: Path) -> Path | None:
        fitting, others = match_names(folder, pattern)
        least = max(NAMES_MIN_PHOTOGRAPHS, NAMES_MIN_FRACTION * (len(fitting) + len(others)))
        return folder if len(fitting) >= least else None

    return find


def require_photographs(fitting: Sequence[object], folder: Path, what: str) -> None:
    """Raise CaptureError `names-unknown` where no photograph of the folder is named as `what` describes."""
    if not fitting:
        unread = describe_unread((folder, folder / IMAGES_FOLDER))
        raise CaptureError(
            "names-unknown",
            f"holds no photograph named {what}",
            path=folder,
            remedy="; ".join(unread) or describe_inner(folder) or "name the right folder, or another --format",
        )


def make_grid_layout(
    files: Sequence[Path], rows: Sequence[int], columns: Sequence[int], options: OpenOptions, folder: Path
) -> tuple[GridLayout, list[str]]:
    """The layout of photographs on nodes: X is the column, Y minus the row.

    Args:
        rows: Of each photograph's node.
        columns: Of each photograph's node.

    Returns:
        The layout, and a line that names missing nodes.

    Raises:
        CaptureError: `node-twice` (two photographs on one node), `grid-size` (not as `options.grid` says).
    """
    owner: dict[tuple[int, int], Path] = {}
    for path, node in zip(files, zip(rows, columns, strict=True), strict=True):
        if node in owner:
            one, other = one_line(owner[node].name), one_line(path.name)
            raise CaptureError(
                "node-twice",
                f"{one} and {other} are both row {node[0]}, column {node[1]}",
                path=folder,
                remedy="take one of them out",
            )
        owner[node] = path
    r, c = np.array(rows, np.int64), np.array(columns, np.int64)
    layout = GridLayout(r, c, np.stack([c, -r], axis=1).astype(np.float64))
    if options.grid is not None and layout.shape != options.grid:
        (named_rows, named_columns), (asked_rows, asked_columns) = layout.shape, options.grid
        raise CaptureError(
            "grid-size",
            f"the names say {named_rows} rows x {named_columns} columns, not {asked_rows}x{asked_columns}",
            path=folder,
            remedy="leave --grid out, or add the photographs that are missing",
        )
    return layout, describe_missing_nodes(layout)


def describe_missing_nodes(layout: GridLayout) -> list[str]:
    """A line that names nodes without a photograph, if there are any."""
    places = [f"row {row} column {column}" for row, column in layout.missing_nodes]
    return describe(places, "node of the grid has", "nodes of the grid have", "no photograph")


def with_measured_positions(
    layout: GridLayout, x: NDArray[np.float64], y: NDArray[np.float64], **changes: Any
) -> GridLayout:
    """The layout with measured positions, X to the right and Y up, and other changes."""
    return replace(layout, positions=np.stack([x, y], axis=1), measured=True, **changes)
