"""Photographs as kernels read them, and the parallax of a set of views."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.stereo.taps import OUTSIDE_PIXEL

Pictures = NDArray[np.uint8] | NDArray[np.uint32]  # (V, H, W, 3), or packed (V, H, W)
PARALLAX_SECTORS = 8
OUTSIDE_IGNORED_PIXELS = 2  # rows or columns by which photographs of one camera may differ


def pack_pictures(pictures: Pictures) -> NDArray[np.uint32]:
    """Pictures as one uint32 a pixel, red in the lowest byte; packed pictures are returned unchanged.

    Every function of this package takes either form. Packing once saves time where many are called, and packed pictures
    can say which pixels no photograph has (`mark_outside`): no function takes these for seen.

    Returns:
        (V, H, W) uint32.

    Raises:
        ValueError: Another shape or type, or under 2 x 2 pixels.
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


def mark_outside(pictures: Pictures, places: Sequence[tuple[slice, slice]]) -> Pictures:
    """Packed pictures that know where photographs smaller than the frame end.

    The same, if none is smaller by more than a row or two, as those of one camera may be.

    Args:
        places: Rows and columns of each photograph.
    """
    outside = np.ones(pictures.shape[:3], np.bool_)
    for one, place in zip(outside, places, strict=True):
        one[place] = False
    lacking = [outside.all(axis=axis).sum(axis=1).max(initial=0) for axis in (1, 2)]  # columns, rows
    if max(lacking) <= OUTSIDE_IGNORED_PIXELS:
        return pictures
    packed = pack_pictures(pictures)
    packed[outside] |= OUTSIDE_PIXEL
    return packed


def inside_pictures(pictures: Pictures) -> NDArray[np.bool_]:
    """(V, H, W) where photographs have pixels; see `mark_outside`."""
    return np.asarray(pictures < OUTSIDE_PIXEL) if pictures.ndim == 3 else np.ones(pictures.shape[:3], np.bool_)


def unpack_pictures(pictures: NDArray[np.uint32]) -> NDArray[np.uint8]:
    """(..., H, W, 3) uint8 of packed pictures."""
    return picture_bytes(pictures)[..., :3]


def codes_of(pictures: Pictures) -> NDArray[np.uint8]:
    """(V, H, W, 3) uint8 of pictures in either form."""
    return unpack_pictures(pictures.view(np.uint32)) if pictures.ndim == 3 else pictures.view(np.uint8)


def picture_bytes(pictures: NDArray[np.uint32]) -> NDArray[np.uint8]:
    """(..., H, W, 4) uint8 of packed pictures: red, green, blue, and 255 outside photographs, else 0."""
    return np.ascontiguousarray(pictures[..., None]).view(np.uint8)


def check_matrices(matrices: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """View matrices as contiguous float64.

    Args:
        matrices: (count, 3, 4), finite.

    Raises:
        ValueError: Another shape, or not finite.
    """
    result = np.ascontiguousarray(matrices, np.float64)
    if result.shape != (count, 3, 4) or not np.isfinite(result).all():
        raise ValueError(f"matrices must be finite and ({count}, 3, 4), not {result.shape}")
    return result


def halve_pictures(pictures: Pictures) -> NDArray[np.uint32]:
    """Packed pictures at half the size (rounded up), each pixel the mean of four; outside where one of them is."""
    packed = pack_pictures(pictures)
    count, height, width = packed.shape
    result = np.empty((count, (height + 1) // 2, (width + 1) // 2), np.uint32)
    for index in range(count):
        colours = unpack_pictures(packed[index])
        colours = np.pad(colours, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge").astype(np.uint16)
        total = colours[::2, ::2] + colours[1::2, ::2] + colours[::2, 1::2] + colours[1::2, 1::2]
        result[index] = pack_pictures(((total + 2) // 4).astype(np.uint8)[None])[0]
        beyond = packed[index] & OUTSIDE_PIXEL
        if beyond.any():
            beyond = np.pad(beyond, ((0, height % 2), (0, width % 2)), mode="edge")
            result[index] |= beyond[::2, ::2] | beyond[1::2, ::2] | beyond[::2, 1::2] | beyond[1::2, 1::2]
    return result


HALF_FROM_FULL_INDEX = np.array([[0.5, 0, -0.25], [0, 0.5, -0.25], [0, 0, 1]])
FULL_FROM_HALF_POINT = np.array([[2, 0, 0, 0.5], [0, 2, 0, 0.5], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def halved_matrices(matrices: NDArray[np.float64]) -> NDArray[np.float64]:
    """View matrices for a reference view and pictures of half the resolution."""
    return HALF_FROM_FULL_INDEX @ matrices @ FULL_FROM_HALF_POINT


def label_parallax(matrices: NDArray[np.float64], shape: tuple[int, int], d: float = 0.0) -> NDArray[np.float64]:
    """Pixels that the centre of the reference view moves in each view for one unit of d.

    Args:
        d: The label at which it is measured.

    Returns:
        (V, 2) along x and y.
    """
    point = np.array([(shape[1] - 1) / 2, (shape[0] - 1) / 2, d, 1.0])
    p = matrices @ point
    return (matrices[:, :2, 2] - matrices[:, 2:, 2] * p[:, :2] / p[:, 2:]) / p[:, 2:]


def parallax_sectors(parallax: NDArray[np.float64]) -> NDArray[np.int64]:
    """Which eighth of the directions each view's parallax falls into.

    Args:
        parallax: (V, 2) of `label_parallax`.

    Returns:
        (V,) 0..7; -1 for views without parallax.
    """
    length = np.hypot(parallax[:, 0], parallax[:, 1])
    angle = np.arctan2(parallax[:, 1], parallax[:, 0]) / (2 * np.pi) * PARALLAX_SECTORS
    result = np.floor(angle + 0.25).astype(np.int64) % PARALLAX_SECTORS  # axis-aligned rows fall well inside a sector
    result[length < 0.05 * max(length.max(initial=0.0), 1e-12)] = -1
    return result
