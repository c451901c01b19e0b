"""What the names of photographs say of how the cameras stood, before any of the files is opened."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from eigenfield.capture.calibration import Calibration, printable
from eigenfield.capture.layout import GridLayout
from eigenfield.capture.locate import photographs_in
from eigenfield.capture.messages import count, natural, some
from eigenfield.core.errors import CaptureError

FEWEST_NAMED = 3  # photographs that must bear a format's names
SHARE = 0.5  # of a folder's photographs, likewise
IMAGES = "images"


@dataclass(frozen=True)
class Wanted:
    """What the caller says of a capture beside its path.

    grid: (rows, columns) of photographs in row-major order.
    frame: which frame of each video: an index from 0, or seconds ("2.5s").
    work: a folder that keeps the frames taken from videos; None for a temporary one.
    """

    grid: tuple[int, int] | None = None
    frame: int | str | None = None
    work: Path | None = None


@dataclass(frozen=True, eq=False)
class Arrangement:
    """Photographs of one scene as their names place them.

    files: the photographs. layout: their nodes, in the order of `files`; None where names say nothing.
    others: photographs beside them that bear other names.
    calibration: whole cameras, where names (or a file beside them) say so much.
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
    here, inner = photographs_in(folder), photographs_in(folder / IMAGES)
    if len(here) >= FEWEST_NAMED and len(inner) >= FEWEST_NAMED:
        raise CaptureError(
            "photographs-twice",
            f"holds {len(here)} photographs itself and {len(inner)} in {IMAGES}/",
            path=folder,
            remedy=f"name {folder / IMAGES}, or move the others away",
        )
    return sorted(here if len(here) >= len(inner) else inner, key=lambda path: (natural(path.name), path.name))


def named_like(folder: Path, pattern: re.Pattern[str]) -> tuple[list[tuple[Path, re.Match[str]]], list[Path]]:
    """The photographs whose names without extension match, with their matches; and the others."""
    fitting, others = [], []
    for path in photographs_of(folder):
        match = pattern.fullmatch(path.stem)
        if match:
            fitting.append((path, match))
        else:
            others.append(path)
    return fitting, others


def is_named_like(folder: Path, pattern: re.Pattern[str]) -> bool:
    """Whether the photographs of a folder, at least most of them, bear such names."""
    fitting, others = named_like(folder, pattern)
    return len(fitting) >= FEWEST_NAMED and len(fitting) >= SHARE * (len(fitting) + len(others))


def told_by(pattern: re.Pattern[str]) -> Callable[[Path], Path | None]:
    """The `find` of a format that is told by its names alone."""
    return lambda folder: folder if is_named_like(folder, pattern) else None


def refuse_nothing(fitting: Sequence[object], folder: Path, what: str) -> None:
    if not fitting:
        raise CaptureError(
            "names-unknown",
            f"holds no photograph named {what}",
            path=folder,
            remedy="name the right folder, or another --format",
        )


def nodes(
    files: Sequence[Path], rows: Sequence[int], columns: Sequence[int], wanted: Wanted, folder: Path
) -> tuple[GridLayout, list[str]]:
    """The layout of photographs on nodes: X is the column, Y minus the row; and a line that names missing nodes.

    Raises CaptureError: `node-twice` (two photographs on one node), `grid-size` (not as `wanted.grid` says).
    """
    owner: dict[tuple[int, int], Path] = {}
    for path, node in zip(files, zip(rows, columns, strict=True), strict=True):
        if node in owner:
            raise CaptureError(
                "node-twice",
                f"{printable(owner[node].name)} and {printable(path.name)} are both row {node[0]}, column {node[1]}",
                path=folder,
                remedy="take one of them out",
            )
        owner[node] = path
    r, c = np.array(rows, np.int64), np.array(columns, np.int64)
    layout = GridLayout(r, c, np.stack([c, -r], axis=1).astype(np.float64))
    if wanted.grid is not None and layout.shape != wanted.grid:
        raise CaptureError(
            "grid-size",
            f"the names say {layout.shape[0]} rows x {layout.shape[1]} columns, not {wanted.grid[0]}x{wanted.grid[1]}",
            path=folder,
            remedy="leave --grid out, or add the photographs that are missing",
        )
    return layout, missing_line(layout)


def missing_line(layout: GridLayout) -> list[str]:
    missing = layout.missing
    if not missing:
        return []
    places = some([f"row {row} column {column}" for row, column in missing])
    return [f"{count(missing, 'node of the grid has', 'nodes of the grid have')} no photograph: {places}"]


def measured(layout: GridLayout, x: Sequence[float], y: Sequence[float]) -> GridLayout:
    """The layout with measured positions, X to the right and Y up."""
    return replace(layout, positions=np.stack([x, y], axis=1).astype(np.float64), measured=True)
