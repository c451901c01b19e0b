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
from eigenfield.coding.arrays.grid import checked_grid, read_grid, write_grid
from eigenfield.coding.entropy.range_coder import (
    check_end,
    check_header,
    check_numbers,
    coded_bytes,
    damaged_error,
    decoder,
    float32_numbers,
    pad_bytes,
)
from eigenfield.coding.entropy.range_kernels import AT, HIGH, LOW
from eigenfield.coding.entropy.table_kernels import (
    CONTEXTS,
    FREQUENCIES,
    MIXTURES,
    SLOPES,
    VALUES,
    code_table,
    code_way,
)

VERSION = 1
HEADER = struct.Struct("<BBHHII")  # version, whether there is a grid, its rows and columns, cameras, components
WEIGHT_MAX_STEPS = 2**20  # steps


def code_weights(
    weights: NDArray[np.float32], step: ArrayLike, grid: ArrayLike | None = None, *, dead_zone: float = 0.0
) -> tuple[bytes, NDArray[np.float32]]:
    """The bytes, and the weights that they decode to.

    Args:
        weights: (Ne, N) float32.
        step: (N,) or one for all, positive: the weights, or their cosine transform, are off by at most half of it.
        grid: (rows, columns) camera indices, -1 where there is none; None where the cameras stand on no grid.
        dead_zone: In steps, up to 0.5: numbers are rounded towards 0 by this much more; the error grows by as much.

    Raises:
        ValueError: Numbers beyond 2^20 steps, or not finite; steps that are not positive; no grid.
    """
    count, components = weights.shape
    steps = np.broadcast_to(np.asarray(step, np.float32), components).copy()
    if not (np.isfinite(steps).all() and (steps > 0).all() and np.isfinite(weights).all()):
        raise ValueError("weights and steps must be finite, steps positive")
    cells = None if grid is None else checked_grid(grid, count)
    rows, columns = (1, count) if cells is None else cells.shape
    if max(rows, columns) > 65535 and cells is not None:
        raise ValueError("a grid has at most 65535 rows and columns")
    result = np.zeros((count, components), np.float32)

    def run(coder: Any) -> None:
        if cells is not None:
            write_grid(coder, cells)
        before = _no_tables(rows, columns)
        for k in range(components):
            scaled = np.zeros((rows, columns))
            _put(scaled, cells, weights[:, k].astype(np.float64) / float(steps[k]))
            way, table = _cheapest(coder, scaled, before, _ways(cells), dead_zone)
            code_way(coder, way)
            code_table(coder, table, before[way], way)
            before[way] = table
            result[:, k] = _values(table, way, cells, float(steps[k]))

    front = HEADER.pack(VERSION, int(cells is not None), *((0, 0) if cells is None else cells.shape), count, components)
    body = coded_bytes(run, CONTEXTS, MIXTURES, room=2 * weights.size + rows * columns + 1024)
    return pad_bytes(front + steps.astype("<f4").tobytes() + body, max(rows * columns, 1) * components), result


def decode_weights(data: bytes, where: str = "weights") -> NDArray[np.float32]:
    """(Ne, N) float32.

    Raises:
        FormatError: `coded-truncated`, `coded-version`, `coded-size`, `coded-damaged`.
    """
    check_header(data, HEADER.size, VERSION, where)
    _, kind, rows, columns, count, components = HEADER.unpack_from(data)
    if kind > 1 or count == 0:
        raise damaged_error("weights of no camera, or of an unknown kind", where)
    if kind == 0:
        rows, columns = 1, count
    check_numbers(data, rows * columns * max(components, 1), limits.MAX_WEIGHTS, where)
    body = HEADER.size + 4 * components
    check_header(data, body, VERSION, where)
    steps = float32_numbers(data, components, HEADER.size)
    if not (np.isfinite(steps).all() and (steps > 0).all()) or rows * columns < count:
        raise damaged_error("steps that are not positive, or a grid with too few cells", where)
    coder = decoder(data[body:], CONTEXTS, MIXTURES)
    cells = read_grid(coder, rows, columns, count, where) if kind == 1 else None
    result = np.zeros((count, components), np.float32)
    before = _no_tables(rows, columns)
    for k in range(components):
        way = int(code_way(coder, 0))
        table = np.zeros((rows, columns), np.int64)
        code_table(coder, table, before[way], way)
        if way not in _ways(cells) or np.abs(table).max() > 4 * WEIGHT_MAX_STEPS * max(rows, columns):
            raise damaged_error(f"numbers of component {k} that cannot be", where)
        before[way] = table
        with np.errstate(over="ignore", invalid="ignore"):
            result[:, k] = _values(table, way, cells, steps[k])
        check_end(coder, where)
    if not np.isfinite(result).all():
        raise damaged_error("weights that are not finite", where)
    return result


def _no_tables(rows: int, columns: int) -> list[NDArray[np.int64]]:
    return [np.zeros((rows, columns), np.int64) for _ in (VALUES, SLOPES, FREQUENCIES)]


def _ways(cells: NDArray[np.int64] | None) -> tuple[int, ...]:
    """What may be tried: a transform needs a camera in every cell."""
    return (VALUES, SLOPES) if cells is None or (cells < 0).any() else (VALUES, SLOPES, FREQUENCIES)


def _put(table: NDArray[np.float64], cells: NDArray[np.int64] | None, values: NDArray[np.float64]) -> None:
    if cells is None:
        table[0] = values
    else:
        table[cells >= 0] = values[cells[cells >= 0]]


def _values(table: NDArray[np.int64], way: int, cells: NDArray[np.int64] | None, step: float) -> NDArray[np.float32]:
    """(Ne,) the weights of a table."""
    numbers = table * step
    if way == FREQUENCIES:
        numbers = idctn(numbers, norm="ortho")
    if cells is None:
        return numbers[0].astype(np.float32)
    result = np.zeros(int(cells.max()) + 1, np.float32)
    result[cells[cells >= 0]] = numbers[cells >= 0]
    return result


def _cheapest(
    coder: Any, scaled: NDArray[np.float64], before: list[NDArray[np.int64]], ways: tuple[int, ...], dead_zone: float
) -> tuple[int, NDArray[np.int64]]:
    """The way of shortest code in the coder's present state, which is restored."""
    kept = [part.copy() for part in coder[1:]]
    best, found = np.inf, (VALUES, np.zeros(scaled.shape, np.int64))
    for way in ways:
        exact = dctn(scaled, norm="ortho") if way == FREQUENCIES else scaled
        table = np.sign(exact) * np.floor(np.abs(exact) + 0.5 - dead_zone)
        if np.abs(table).max(initial=0) > WEIGHT_MAX_STEPS:
            if way == VALUES:
                raise ValueError(f"weights of more than {WEIGHT_MAX_STEPS} steps")
            continue
        whole = table.astype(np.int64)
        code_way(coder, way)
        code_table(coder, whole, before[way], way)
        bits = 8.0 * float(coder.state[AT]) - float(np.log2(coder.state[HIGH] - coder.state[LOW] + 1))
        if bits < best:
            best, found = bits, (way, whole)
        for part, was in zip(coder[1:], kept, strict=True):
            part[...] = was
    return found
