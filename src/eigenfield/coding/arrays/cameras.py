"""Intrinsics and poses of cameras in few bytes.

A camera is eleven numbers: fx, fy, skew, cx, cy in pixels; its rotation against that of the first camera as modified
Rodrigues parameters p = tan(angle / 4) axis, |p| <= 1; its centre. Each is rounded to a step. On a regular grid the
plane over rows and columns that fits each of them best is taken off. What is left is coded as it is, or less that of
the camera before, whichever takes fewer bytes. On a regular grid nothing is left, and most of the header is zeros: so
the stream is deflated (`cameras-2`).
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from eigenfield.coding import limits
from eigenfield.coding.arrays.grid import checked_grid, read_grid
from eigenfield.coding.entropy import range_coder
from eigenfield.coding.entropy.table_kernels import CONTEXTS, MIXTURES, code_cells, code_lines
from eigenfield.core.camera import Camera
from eigenfield.core.errors import FormatError

VERSION, DEFLATED_VERSION = 1, 2
HEADER = struct.Struct("<BBHHI3d4d8d")  # version, kind, rows, columns, cameras; steps; first rotation; first numbers
CAMERA_NUMBERS = 11
ON_GRID, FROM_BEFORE = 1, 2  # bits of the kind
CAMERA_MAX_STEPS = 2**20  # steps
NO_SLOPE_STEPS = 1e-3  # what a slope or a value is taken for nothing below
MAX_INFLATED = 4 * CAMERA_NUMBERS * limits.MAX_CAMERAS + 1024  # bytes


def code_cameras(
    cameras: Sequence[Camera],
    *,
    intrinsic_step: float,
    rotation_step: float,
    centre_step: float,
    grid: ArrayLike | None = None,
) -> tuple[bytes, NDArray[np.float32], NDArray[np.float32]]:
    """The bytes, and what they decode to: intrinsics (Nc, 5) and poses (Nc, 3, 4) float32 as a scene file keeps them.

    Every number is off by at most half of its step.

    Args:
        cameras: Nc of them.
        intrinsic_step: In pixels, positive.
        rotation_step: In radians, positive.
        centre_step: In world units, positive.
        grid: (rows, columns) camera indices, -1 where there is none; None where the cameras stand on no grid.

    Raises:
        ValueError: No cameras, no grid, or numbers more than 2^20 steps from their prediction.
    """
    steps = _short(np.array([intrinsic_step, rotation_step / 4, centre_step]))
    if not cameras or not (np.isfinite(steps).all() and (steps > 0).all()):
        raise ValueError("cameras are needed, and steps that are positive")
    count = len(cameras)
    cells = None if grid is None else checked_grid(grid, count)
    turn = Rotation.from_matrix([camera.R for camera in cameras])
    first = _short(turn[0].as_quat())
    numbers = np.zeros((count, CAMERA_NUMBERS))
    numbers[:, :5] = [[c.K[0, 0], c.K[1, 1], c.K[0, 1], c.K[0, 2], c.K[1, 2]] for c in cameras]
    numbers[:, 5:8] = (turn * turn[0].inv()).as_mrp()
    numbers[:, 8:] = [camera.centre for camera in cameras]
    base = _short(numbers[0, [0, 1, 2, 3, 4, 8, 9, 10]])
    unit = np.repeat(steps, [5, 3, 3])
    places = _places(cells, count)
    planes = np.zeros((3, CAMERA_NUMBERS), np.float32)
    rest = numbers - _base(base)
    if cells is not None:
        planes = np.linalg.lstsq(places, rest, rcond=None)[0].astype(np.float32)
        planes[np.abs(planes) < NO_SLOPE_STEPS * unit] = 0
        rest = rest - places @ planes.astype(np.float64)
    table = np.rint(rest / unit)
    if not np.abs(table).max() <= CAMERA_MAX_STEPS:
        raise ValueError(f"cameras more than {CAMERA_MAX_STEPS} steps off what is expected")
    order = np.arange(count) if cells is None else cells[cells >= 0]
    whole = table.astype(np.int64)[order]

    def stream(kind: int) -> bytes:
        def run(coder: Any) -> None:
            if cells is not None:
                code_cells(coder, cells.reshape(-1).copy())
            code_lines(coder, whole.copy(), _before(kind, count))

        shape = (0, 0) if cells is None else cells.shape
        front = HEADER.pack(VERSION, kind, *shape, count, *steps, *first, *base)
        surface = b"" if cells is None else planes.astype("<f4").tobytes()
        body = range_coder.coded_bytes(run, CONTEXTS, MIXTURES, room=4 * CAMERA_NUMBERS * count + 1024)
        return range_coder.pad_bytes(front + surface + body, max(CAMERA_NUMBERS * count, shape[0] * shape[1]))

    kind = 0 if cells is None else ON_GRID
    data = min(stream(kind), stream(kind | FROM_BEFORE), key=len)
    return data, *_assemble(whole[np.argsort(order)] * unit + _base(base) + places @ planes.astype(np.float64), first)


def code_deflated(cameras: Sequence[Camera], **given: Any) -> tuple[bytes, NDArray[np.float32], NDArray[np.float32]]:
    """As `code_cameras`, in the bytes of `cameras-2`."""
    data, intrinsics, poses = code_cameras(cameras, **given)
    coder = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    return bytes([DEFLATED_VERSION]) + coder.compress(data[1:]) + coder.flush(), intrinsics, poses


def decode_deflated(data: bytes, where: str = "cameras") -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """As `decode_cameras`, of the bytes of `cameras-2`."""
    range_coder.check_header(data, 1, DEFLATED_VERSION, where)
    inflater = zlib.decompressobj(-zlib.MAX_WBITS)
    try:
        inflated = inflater.decompress(data[1:], MAX_INFLATED + 1)
    except zlib.error as error:
        raise range_coder.damaged_error(f"cameras that do not inflate: {error}", where) from None
    if len(inflated) > MAX_INFLATED:
        raise FormatError("coded-size", f"more than {MAX_INFLATED} bytes of cameras", where=where)
    if not inflater.eof:
        raise FormatError("coded-truncated", "cameras are cut off", where=where)
    if inflater.unused_data:
        raise range_coder.damaged_error("bytes behind the cameras", where)
    return decode_cameras(bytes([VERSION]) + inflated, where)


def decode_cameras(data: bytes, where: str = "cameras") -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Intrinsics (Nc, 5): fx, fy, skew, cx, cy; poses (Nc, 3, 4): [R t], world to camera; both float32. FormatError
    `coded-truncated`, `coded-version`, `coded-size`, `coded-damaged`."""
    range_coder.check_header(data, HEADER.size, VERSION, where)
    _, kind, rows, columns, count, *rest = HEADER.unpack_from(data)
    steps, first, base = np.array(rest[:3]), np.array(rest[3:7]), np.array(rest[7:])
    gridded = bool(kind & ON_GRID)
    if kind > 3 or count == 0 or not np.isfinite(rest).all():
        raise range_coder.damaged_error("cameras of an unknown kind, none, or not finite", where)
    if count > limits.MAX_CAMERAS or (gridded and rows * columns < count):
        raise range_coder.damaged_error("a number of cameras that cannot be", where)
    size = max(CAMERA_NUMBERS * count, rows * columns if gridded else 0)
    range_coder.check_numbers(data, size, CAMERA_NUMBERS * limits.MAX_CAMERAS, where)
    body = HEADER.size + (3 * CAMERA_NUMBERS * 4 if gridded else 0)
    range_coder.check_header(data, body, VERSION, where)
    planes = np.zeros((3, CAMERA_NUMBERS))
    if gridded:
        planes = range_coder.float32_numbers(data, 3 * CAMERA_NUMBERS, HEADER.size).reshape(3, CAMERA_NUMBERS)
    coder = range_coder.decoder(data[body:], CONTEXTS, MIXTURES)
    cells = read_grid(coder, rows, columns, count, where) if gridded else None
    whole = np.zeros((count, CAMERA_NUMBERS), np.int64)
    code_lines(coder, whole, _before(kind, count))
    range_coder.check_end(coder, where)
    order = np.arange(count) if cells is None else cells[cells >= 0]
    unit = np.repeat(steps, [5, 3, 3])
    with np.errstate(all="ignore"):
        numbers = whole[np.argsort(order)] * unit + _base(base) + _places(cells, count) @ planes
        intrinsics, poses = _assemble(numbers, first)
    if not (np.isfinite(intrinsics).all() and np.isfinite(poses).all()):
        raise range_coder.damaged_error("cameras that are not finite", where)
    return intrinsics, poses


def _short(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """As float32 has them: half of their bytes are then zeros, or nearly."""
    return numbers.astype(np.float32).astype(np.float64)


def _base(base: NDArray[np.float64]) -> NDArray[np.float64]:
    """(11,) the first camera's numbers, rotation apart."""
    return np.concatenate([base[:5], np.zeros(3), base[5:]])


def _places(cells: NDArray[np.int64] | None, count: int) -> NDArray[np.float64]:
    """(Nc, 3): 1, row, column of every camera."""
    places = np.zeros((count, 3))
    if cells is not None:
        row, column = np.nonzero(cells >= 0)
        places[cells[row, column]] = np.stack([np.ones(count), row, column], axis=1)
    return places


def _before(kind: int, count: int) -> NDArray[np.int64]:
    return np.arange(count) - 1 if kind & FROM_BEFORE else np.full(count, -1)


def _assemble(
    numbers: NDArray[np.float64], first: NDArray[np.float64]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Intrinsics and poses of the eleven numbers; first: (4,) the first rotation as a quaternion x, y, z, w."""
    p = numbers[:, 5:8]
    square = (p * p).sum(axis=1, keepdims=True)
    turn = _matrices(np.concatenate([2 * p, 1 - square], axis=1) / (1 + square)) @ _matrices(first[None])
    shift = -(turn @ numbers[:, 8:, None])
    return numbers[:, :5].astype(np.float32), np.concatenate([turn, shift], axis=2).astype(np.float32)


def _matrices(q: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 3, 3) rotations of unit quaternions (n, 4) x, y, z, w."""
    x, y, z, w = q.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)
