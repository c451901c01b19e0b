"""Photographs as kernels read them, and what is known of how a set of views looks at a canvas."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Pictures = NDArray[np.uint8] | NDArray[np.uint32]  # (V, H, W, 3), or packed (V, H, W)
SECTORS = 8


def pack(pictures: Pictures) -> NDArray[np.uint32]:
    """(V, H, W, 3) uint8 as (V, H, W) uint32, red in the lowest byte; packed pictures are handed back as they are.

    Every function of this room takes either; packing once saves time where many are called.
    """
    if pictures.ndim == 3 and pictures.dtype == np.uint32:
        return np.ascontiguousarray(pictures)
    if pictures.ndim != 4 or pictures.shape[3] != 3 or pictures.dtype != np.uint8:
        raise ValueError(f"pictures must be (V, H, W, 3) uint8, not {pictures.shape} {pictures.dtype}")
    if min(pictures.shape[1:3]) < 2:
        raise ValueError("pictures must be at least 2 x 2 pixels")
    packed = np.zeros((*pictures.shape[:3], 4), np.uint8)
    packed[..., :3] = pictures
    return packed.view(np.uint32)[..., 0]


def unpack(pictures: NDArray[np.uint32]) -> NDArray[np.uint8]:
    """(..., H, W) packed as (..., H, W, 3) uint8."""
    return np.ascontiguousarray(pictures[..., None]).view(np.uint8)[..., :3]


def check_matrices(matrices: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """`matrices` as (count, 3, 4) float64, finite; ValueError if not."""
    result = np.ascontiguousarray(matrices, np.float64)
    if result.shape != (count, 3, 4) or not np.isfinite(result).all():
        raise ValueError(f"matrices must be finite and ({count}, 3, 4), not {result.shape}")
    return result


def halve(pictures: Pictures) -> NDArray[np.uint32]:
    """Packed pictures at half the size (rounded up), each pixel the mean of four."""
    packed = pack(pictures)
    count, height, width = packed.shape
    result = np.empty((count, (height + 1) // 2, (width + 1) // 2), np.uint32)
    for index in range(count):
        colours = unpack(packed[index])
        colours = np.pad(colours, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge").astype(np.uint16)
        total = colours[::2, ::2] + colours[1::2, ::2] + colours[::2, 1::2] + colours[1::2, 1::2]
        result[index] = pack(((total + 2) // 4).astype(np.uint8)[None])[0]
    return result


HALVE_PICTURE = np.array([[0.5, 0, -0.25], [0, 0.5, -0.25], [0, 0, 1]])
HALVE_CANVAS = np.array([[2, 0, 0, 0.5], [0, 2, 0, 0.5], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def halved_matrices(matrices: NDArray[np.float64], pictures: bool = True) -> NDArray[np.float64]:
    """The matrices from a canvas of half the resolution, into pictures halved as well (or not)."""
    return (HALVE_PICTURE if pictures else np.eye(3)) @ matrices @ HALVE_CANVAS


def motion(matrices: NDArray[np.float64], shape: tuple[int, int], d: float = 0.0) -> NDArray[np.float64]:
    """(V, 2) pixels that the point in the canvas's middle moves in each view for one unit of d, at label d."""
    point = np.array([(shape[1] - 1) / 2, (shape[0] - 1) / 2, d, 1.0])
    p = matrices @ point
    return (matrices[:, :2, 2] - matrices[:, 2:, 2] * p[:, :2] / p[:, 2:]) / p[:, 2:]


def sectors(moves: NDArray[np.float64]) -> NDArray[np.int64]:
    """(V,) which eighth of the directions each view's `motion` has; -1 for views without parallax."""
    length = np.hypot(moves[:, 0], moves[:, 1])
    turn = np.arctan2(moves[:, 1], moves[:, 0]) / (2 * np.pi) * SECTORS
    result = np.floor(turn + 0.25).astype(np.int64) % SECTORS  # axis-aligned rows fall well inside a sector
    result[length < 0.05 * max(length.max(initial=0.0), 1e-12)] = -1
    return result
