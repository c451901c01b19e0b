"""Tables of whole numbers, in contexts of what is beside, above and in the table before; one body codes and decodes."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.coding.entropy.range_kernels import binary_digits, code_flag, code_integer
from eigenfield.runtime.jit import kernel

SIZES = 12  # classes of a sum of magnitudes
ZONES = 12  # classes of places in a table of frequencies
VALUES, SLOPES, FREQUENCIES = 0, 1, 2  # ways of a table: as they are; less what the neighbours suggest; as a DCT
WAYS = 3
OWN = SIZES * SIZES + 2 * SIZES + SIZES * ZONES  # contexts of a way
WAY = WAYS * OWN
LINE = WAY + 2
SPREAD = 24  # classes of a magnitude in a line
COLUMNS = 16  # of a line with contexts of their own
CELL = LINE + COLUMNS * SPREAD + COLUMNS * SPREAD + COLUMNS
CONTEXTS = CELL + 4
M_WAY, M_CELL, M_LINE = WAYS, WAYS + 1, WAYS + 2
MIXTURES = M_LINE + COLUMNS


@kernel()
def _size(value):
    return min(binary_digits(value), SIZES - 1)


@kernel()
def _at(table, row, column):
    """0 outside the table."""
    if row < 0 or column < 0 or column >= table.shape[1]:
        return np.int64(0)
    return np.int64(table[row, column])


@kernel()
def code_table(coder, table, before, way):
    """A table (rows, columns) int64, in place, after the table `before` of the same shape.

    SLOPES: each number less the median of left, above and left + above - above left (LOCO-I); its neighbourhood is how
    much these differ, not how large they are.
    """
    own = way * OWN
    last = np.int64(0)
    for row in range(table.shape[0]):
        for column in range(table.shape[1]):
            left, above = _at(table, row, column - 1), _at(table, row - 1, column)
            corner, ahead = _at(table, row - 1, column - 1), _at(table, row - 1, column + 1)
            expected = np.int64(0)
            if way == SLOPES:
                if row == 0:
                    expected = left
                elif column == 0:
                    expected = above
                else:
                    expected = max(min(left, above), min(max(left, above), left + above - corner))
                near = abs(left - corner) + abs(above - corner) + abs(ahead - above)
                far = last
            else:
                near = 2 * abs(left) + 2 * abs(above) + abs(corner) + abs(ahead)
                far = abs(_at(table, row, column - 2)) + abs(_at(table, row - 2, column))
            old = 2 * abs(before[row, column]) + abs(_at(before, row, column - 1)) + abs(_at(before, row, column + 1))
            zone = min(row, 2) * 4 + min(column, 3) if way == FREQUENCIES else min(row, 1)
            a, b = _size(near), _size(old)
            off = code_integer(
                coder, table[row, column] - expected, own + a * SIZES + b, own + SIZES * SIZES + _size(near + far),
                own + SIZES * SIZES + 2 * SIZES + zone * SIZES + _size(old + abs(left)), way,
            )  # fmt: skip
            table[row, column] = expected + off
            last = abs(off)


@kernel()
def code_lines(coder, table, before):
    """A table (rows, columns) int64, in place, row by row: each number less that of row before[row] (-1: less 0), in
    contexts of its column and how large the differences to its left and above it were."""
    columns = table.shape[1]
    recent = np.zeros(columns, np.int64)
    for row in range(table.shape[0]):
        beside = np.int64(0)
        for column in range(columns):
            expected = table[before[row], column] if before[row] >= 0 else np.int64(0)
            kind = min(column, COLUMNS - 1)
            up, left = min(binary_digits(recent[column]), SPREAD - 1), min(binary_digits(beside), SPREAD - 1)
            off = code_integer(
                coder, table[row, column] - expected, LINE + kind * SPREAD + up,
                LINE + (COLUMNS + kind) * SPREAD + left, LINE + 2 * COLUMNS * SPREAD + kind, M_LINE + kind,
            )  # fmt: skip
            table[row, column] = expected + off
            beside = abs(off)
            recent[column] = (recent[column] + abs(off) + 1) // 2


@kernel()
def code_way(coder, way):
    """Which of the three ways a table is coded."""
    if code_flag(coder, np.int64(way == FREQUENCIES), WAY, WAY, WAY, M_WAY):
        return FREQUENCIES
    return SLOPES if code_flag(coder, np.int64(way == SLOPES), WAY + 1, WAY + 1, WAY + 1, M_WAY) else VALUES


@kernel()
def code_cells(coder, cells):
    """Cells (n,) int64 of a grid, in place: whether there is a camera, and by how much its number differs from that of
    the last one plus one."""
    expected = np.int64(0)
    there = np.int64(1)
    for k in range(cells.shape[0]):
        there = code_flag(coder, np.int64(cells[k] >= 0), CELL + there, CELL + there, CELL + 2, M_CELL)
        if there:
            cells[k] = expected + code_integer(coder, cells[k] - expected, CELL + 3, CELL + 3, CELL + 3, M_CELL)
            expected = cells[k] + 1
        else:
            cells[k] = -1
