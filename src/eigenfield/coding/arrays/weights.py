"""The weights of eigen textures in few bytes.

The numbers of one component after the other are divided by its step and rounded. Where the encoded cameras stand on a
regular grid, a component is a table of its rows and columns, and either its numbers are rounded or those of its
discrete cosine transform (orthonormal: the squared error is the same), whichever takes fewer bytes.
"""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import dctn, idctn

from eigenfield.coding import limits
from eigenfield.coding.arrays.grid import checked_grid, read_grid
from eigenfield.coding.entropy import range_coder
from eigenfield.coding.entropy import table_kernels as tables
from eigenfield.coding.entropy.range_kernels import AT, HIGH, LOW

VERSION = 1
HEADER = struct.Struct("<BBHHII")  # version, whether there is a grid, its rows and columns, cameras, components
WEIGHT_MAX_STEPS = 2**20  # steps


def code_weights(
    weights: NDArray[np.float32], step: ArrayLike, grid: ArrayLike | None = None
) -> tuple[bytes, NDArray[np.float32]]:
    """The bytes, and the weights that they decode to.

    Args:
        weights: (Ne, N) float32.
        step: (N,) or one for all, positive: the weights, or their cosine transform, are off by at most half of it.
        grid: (rows, columns) camera indices, -1 where there is none; None where the cameras stand on no grid.

    Raises:
        ValueError: Numbers beyond 2^20 steps, or not finite; steps that are not positive; no grid.
    """
    count, components = weights.shape
    steps = np.broadcast_to(np.asarray(step, np.float32), components).copy()
    if not (np.isfinite(steps).all() and (steps > 0).all() and np.isfinite(weights).all()):
        raise ValueError("weights and steps must be finite, steps positive")
    cells = None if grid is None else checked_grid(grid, count)
    rows, columns = (1, count) if cells is None else cells.shape
    result = np.zeros((count, components), np.float32)

    def run(coder: Any) -> None:
        if cells is not None:
            tables.code_cells(coder, cells.reshape(-1).copy())
        before = _no_tables(rows, columns)
        for k in range(components):
            scaled, values = np.zeros((rows, columns)), weights[:, k].astype(np.float64) / float(steps[k])
            if cells is None:
                scaled[0] = values
            else:
                scaled[cells >= 0] = values[cells[cells >= 0]]
            way, table = _cheapest(coder, scaled, before, _ways(cells))
            tables.code_way(coder, way)
            tables.code_table(coder, table, before[way], way)
            before[way] = table
            result[:, k] = _values(table, way, cells, float(steps[k]))

    shape = (0, 0) if cells is None else cells.shape
    front = HEADER.pack(VERSION, int(cells is not None), *shape, count, components) + steps.astype("<f4").tobytes()
    body = range_coder.coded_bytes(run, tables.CONTEXTS, tables.MIXTURES, room=2 * weights.size + rows * columns + 1024)
    return range_coder.pad_bytes(front + body, max(rows * columns, 1) * components), result


def decode_weights(data: bytes, where: str = "weights") -> NDArray[np.float32]:
    """(Ne, N) float32. FormatError `coded-truncated`, `coded-version`, `coded-size`, `coded-damaged`."""
    range_coder.check_header(data, HEADER.size, VERSION, where)
    _, kind, rows, columns, count, components = HEADER.unpack_from(data)
    if kind > 1 or count == 0:
        raise range_coder.damaged_error("weights of no camera, or of an unknown kind", where)
    if kind == 0:
        rows, columns = 1, count
    range_coder.check_numbers(data, rows * columns * max(components, 1), limits.MAX_WEIGHTS, where)
    body = HEADER.size + 4 * components
    range_coder.check_header(data, body, VERSION, where)
    steps = range_coder.float32_numbers(data, components, HEADER.size)
    if not (np.isfinite(steps).all() and (steps > 0).all()) or rows * columns < count:
        raise range_coder.damaged_error("steps that are not positive, or a grid with too few cells", where)
    coder = range_coder.decoder(data[body:], tables.CONTEXTS, tables.MIXTURES)
    cells = read_grid(coder, rows, columns, count, where) if kind == 1 else None
    result = np.zeros((count, components), np.float32)
    before = _no_tables(rows, columns)
    for k in range(components):
        way = int(tables.code_way(coder, 0))
        table = np.zeros((rows, columns), np.int64)
        tables.code_table(coder, table, before[way], way)
        if way not in _ways(cells) or np.abs(table).max() > 4 * WEIGHT_MAX_STEPS * max(rows, columns):
            raise range_coder.damaged_error(f"numbers of component {k} that cannot be", where)
        before[way] = table
        with np.errstate(over="ignore", invalid="ignore"):
            result[:, k] = _values(table, way, cells, steps[k])
        range_coder.check_end(coder, where)
    if not np.isfinite(result).all():
        raise range_coder.damaged_error("weights that are not finite", where)
    return result


def _no_tables(rows: int, columns: int) -> list[NDArray[np.int64]]:
    return [np.zeros((rows, columns), np.int64) for _ in (tables.VALUES, tables.SLOPES, tables.FREQUENCIES)]


def _ways(cells: NDArray[np.int64] | None) -> tuple[int, ...]:
    """What may be tried: a transform needs a camera in every cell."""
    always = tables.VALUES, tables.SLOPES
    return always if cells is None or (cells < 0).any() else (*always, tables.FREQUENCIES)


def _values(table: NDArray[np.int64], way: int, cells: NDArray[np.int64] | None, step: float) -> NDArray[np.float32]:
    """(Ne,) the weights of a table."""
    numbers = table * step
    if way == tables.FREQUENCIES:
        numbers = idctn(numbers, norm="ortho")
    if cells is None:
        return numbers[0].astype(np.float32)
    result = np.zeros(int(cells.max()) + 1, np.float32)
    result[cells[cells >= 0]] = numbers[cells >= 0]
    return result


def _cheapest(
    coder: Any, scaled: NDArray[np.float64], before: list[NDArray[np.int64]], ways: tuple[int, ...]
) -> tuple[int, NDArray[np.int64]]:
    """The way of shortest code in the coder's present state, which is restored."""
    kept = [part.copy() for part in coder[1:]]
    best, found = np.inf, (tables.VALUES, np.zeros(scaled.shape, np.int64))
    for way in ways:
        exact = dctn(scaled, norm="ortho") if way == tables.FREQUENCIES else scaled
        table = np.sign(exact) * np.floor(np.abs(exact) + 0.5)
        if np.abs(table).max(initial=0) > WEIGHT_MAX_STEPS:
            if way == tables.VALUES:
                raise ValueError(f"weights of more than {WEIGHT_MAX_STEPS} steps")
            continue
        whole = table.astype(np.int64)
        tables.code_way(coder, way)
        tables.code_table(coder, whole, before[way], way)
        bits = 8.0 * float(coder.state[AT]) - float(np.log2(coder.state[HIGH] - coder.state[LOW] + 1))
        if bits < best:
            best, found = bits, (way, whole)
        for part, was in zip(coder[1:], kept, strict=True):
            part[...] = was
    return found
