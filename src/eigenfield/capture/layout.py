"""Where the cameras of a planar array stand according to names and metadata."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.brief import brief_repr


@dataclass(frozen=True, eq=False)
class GridLayout:
    """Where the cameras of a planar array stand according to names and metadata; nothing here is estimated.

    Attributes:
        rows: (n,) int64, the row of each shot's node, as named.
        columns: (n,) int64, likewise.
        positions: (n, 2) float64, X to the right and Y up as the cameras see it, in any unit: measured ones where the
            names contain them, otherwise the node numbers.
        measured: Positions were measured; otherwise rows and columns may be spaced differently.
        signs: +X is right and +Y is up. If False, both may be reversed, which only the photographs can show.
        rectified: True: the pictures share a plane without parallax (two-plane parameterisation). False: parallel
            cameras without shift. None: unknown.
        exact: The photographs are rendered: positions need no refinement.
        focal: Focal length in pixels; None if it is unknown (the frame is then projective).
    """

    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    positions: NDArray[np.float64]
    measured: bool = False
    signs: bool = False
    rectified: bool | None = None
    exact: bool = False
    focal: float | None = None

    __repr__ = brief_repr

    def subset(self, indices: Sequence[int]) -> GridLayout:
        """The layout of some of the shots."""
        chosen = np.asarray(indices, np.int64)
        return replace(self, rows=self.rows[chosen], columns=self.columns[chosen], positions=self.positions[chosen])

    def reduced(self, factor: int) -> GridLayout:
        """The layout of photographs that are smaller by this factor."""
        return self if self.focal is None else replace(self, focal=self.focal / factor)

    def transpose(self) -> GridLayout:
        """The same grid with rows for columns."""
        return replace(self, rows=self.columns, columns=self.rows, positions=self.positions[:, ::-1].copy())

    @property
    def shape(self) -> tuple[int, int]:
        """How many different rows and columns there are; node numbers may have gaps."""
        return len(np.unique(self.rows)), len(np.unique(self.columns))

    @property
    def missing_nodes(self) -> list[tuple[int, int]]:
        """Nodes (row, column) at which a row and a column in use cross, but which have no photograph."""
        taken = set(zip(self.rows.tolist(), self.columns.tolist(), strict=True))
        rows, columns = np.unique(self.rows).tolist(), np.unique(self.columns).tolist()
        return [(r, c) for r in rows for c in columns if (r, c) not in taken]
