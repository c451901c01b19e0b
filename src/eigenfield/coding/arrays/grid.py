"""The grid of cameras on a regular array."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.coding.entropy.range_coder import damaged_error
from eigenfield.coding.entropy.table_kernels import code_cells


def checked_grid(grid: ArrayLike, cameras: int) -> NDArray[np.int64]:
    """(rows, columns) int64 with every camera once and -1 where there is none.

    Raises:
        ValueError: It is anything else.
    """
    cells = np.asarray(grid, np.int64)
    complete = np.array_equal(np.sort(cells[cells >= 0]), np.arange(cameras))
    if cells.ndim != 2 or cells.min(initial=0) < -1 or not complete:
        raise ValueError("a grid has every camera once, and -1 where there is none")
    if max(cells.shape) > 65535:
        raise ValueError("a grid has at most 65535 rows and columns")
    return cells


def read_grid(coder: Any, rows: int, columns: int, cameras: int, where: str) -> NDArray[np.int64]:
    """The grid of `cameras` cameras that `code_cells` coded. FormatError `coded-damaged`, no such grid."""
    cells = np.full(rows * columns, -1, np.int64)
    code_cells(coder, cells)
    if not np.array_equal(np.sort(cells[cells >= 0]), np.arange(cameras)):
        raise damaged_error("a grid that has not every camera once", where)
    return cells.reshape(rows, columns)
