"""Where the cameras of a planar array stand, as far as names and metadata tell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class GridLayout:
    """Where the cameras of a planar array stand, as far as names and metadata tell; nothing here is estimated.

    rows, columns: (n,) int64, each shot's node of the grid, as named.
    positions: (n, 2) float64, X to the right and Y up as the cameras see it, in any unit: measured ones where the names
        hold them, else the node numbers with the signs below applied.
    measured: positions were measured; otherwise rows and columns may be spaced differently.
    signs: whether +X is right and +Y up for certain; False: only the photographs can tell whether both are reversed.
    rectified: the pictures share a plane without parallax (two-plane parameterisation), True, or were taken by parallel
        cameras without shift, False; None where nothing says.
    exact: rendered: positions need no refinement.
    focal: pixels, None where nothing says (the frame is then projective).
    """

    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    positions: NDArray[np.float64]
    measured: bool = False
    signs: bool = False
    rectified: bool | None = None
    exact: bool = False
    focal: float | None = None

    def subset(self, indices: Sequence[int]) -> GridLayout:
        """The layout of some of the shots."""
        chosen = np.asarray(indices, np.int64)
        return replace(self, rows=self.rows[chosen], columns=self.columns[chosen], positions=self.positions[chosen])

    def exchanged(self) -> GridLayout:
        """The same grid with rows for columns."""
        return replace(self, rows=self.columns, columns=self.rows, positions=self.positions[:, ::-1].copy())

    @property
    def shape(self) -> tuple[int, int]:
        """How many different rows and columns there are; node numbers may have gaps."""
        return len(np.unique(self.rows)), len(np.unique(self.columns))

    @property
    def missing(self) -> list[tuple[int, int]]:
        """Nodes (row, column) where a row and a column in use cross and no photograph is."""
        taken = set(zip(self.rows.tolist(), self.columns.tolist(), strict=True))
        rows, columns = np.unique(self.rows).tolist(), np.unique(self.columns).tolist()
        return [(r, c) for r in rows for c in columns if (r, c) not in taken]
