"""Rows of numbers and of lists, of bytes or of numbers that were text."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

from eigenfield.runtime.jit import kernel


@kernel()
def _length(data, at, size, signed, swapped):
    """The whole number of `size` units at a place."""
    if size == 1:
        value = int(data[at])
    else:
        value = 0
        for k in range(size):
            value = value * 256 + int(data[at + (k if swapped else size - 1 - k)])
    if signed and data.itemsize == 1 and value >= 1 << (8 * size - 1):
        value -= 1 << (8 * size)
    return value


@kernel()
def measure_rows(data, start, layout, swapped, counts):
    """How many numbers each property of each row has.

    Args:
        data: Bytes, or the numbers of a text.
        start: Of the first row.
        layout: (3, properties) units of a list's length, 0 of a scalar; units of a number; whether a length is signed.
        swapped: Whether the first byte is the highest.
        counts: (rows, properties); filled.

    Returns:
        Where the rows end; -1 - r if row r does not fit, or has a list of negative length.
    """
    at = start
    for row in range(counts.shape[0]):
        for k in range(counts.shape[1]):
            count = 1
            if layout[0, k] > 0:
                if at + layout[0, k] > data.size:
                    return -1 - row
                count = _length(data, at, layout[0, k], layout[2, k], swapped)
                at += layout[0, k]
            if count < 0 or count > data.size or at + count * layout[1, k] > data.size:
                return -1 - row
            counts[row, k] = count
            at += count * layout[1, k]
    return at


@kernel()
def copy_lists(data, start, layout, counts, wanted, copied):
    """Copy the numbers of one property of all rows.

    Args:
        data: As in `measure_rows`.
        start: As there.
        layout: As there.
        counts: As it was filled.
        wanted: The property.
        copied: Its numbers' units, one row after the other; filled.
    """
    at, written = start, 0
    for row in range(counts.shape[0]):
        for k in range(counts.shape[1]):
            at += layout[0, k]
            units = counts[row, k] * layout[1, k]
            if k == wanted:
                for unit in range(units):
                    copied[written + unit] = data[at + unit]
                written += units
            at += units
