"""Differences of R, G and B as a film's planes and back: BT.709, chroma halved by area and doubled by a cubic filter,
both with the samples in the middle of their four pixels (docs/format.md).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import FLAT, TOP
from eigenfield.coding.video.av1 import Planes
from eigenfield.imaging.colour import LUMA_BT709
from eigenfield.imaging.sampling import halve_picture

_CUBIC = np.array([-9, 111, 29, -3], np.float32) / 128  # Catmull and Rom's, a quarter of a sample from the second


def _matrix() -> NDArray[np.float64]:
    """(3, 3): R'G'B' to Y' and, of half their range, Cb and Cr."""
    luma = np.array(LUMA_BT709)
    blue = (np.array([0, 0, 1]) - luma) / (2 * (1 - luma[2]))
    red = (np.array([1, 0, 0]) - luma) / (2 * (1 - luma[0]))
    return np.stack([luma, blue, red])


FORWARD = _matrix().astype(np.float32)
BACKWARD = np.linalg.inv(_matrix()).astype(np.float32)


def to_planes(
    difference: NDArray[np.float32], size: tuple[int, int], scale: tuple[float, float], full: bool = False
) -> Planes:
    """(h, w, 3) differences of R, G, B as codes around 512; of no difference where `size` (rows, columns), both even,
    is larger. scale: what a code of luma, and of chroma, stands for. full: chroma below luma in luma's plane."""
    height, width = difference.shape[:2]
    converted = np.zeros((*size, 3), np.float32)
    converted[:height, :width] = difference @ FORWARD.T
    if full:
        stacked = np.concatenate([_codes(converted[..., channel], scale[min(channel, 1)]) for channel in range(3)])
        flat = np.full((stacked.shape[0] // 2, stacked.shape[1] // 2), FLAT, np.uint16)
        return stacked, flat, flat
    blue, red = (halve_picture(converted[..., channel]) for channel in (1, 2))
    return _codes(converted[..., 0], scale[0]), _codes(blue, scale[1]), _codes(red, scale[1])


def to_difference(
    planes: Planes, height: int, width: int, scale: tuple[float, float], full: bool = False
) -> NDArray[np.float32]:
    """(height, width, 3) differences of R, G, B of a frame's planes, whose top left part they are."""
    if full:
        luma, blue, red = np.split(planes[0].astype(np.float32) - FLAT, 3)
    else:
        luma, *halves = (plane.astype(np.float32) - FLAT for plane in planes)
        blue, red = (doubled(plane) for plane in halves)
    channels = luma * np.float32(scale[0]), blue * np.float32(scale[1]), red * np.float32(scale[1])
    converted = np.stack([channel[:height, :width] for channel in channels], axis=-1)
    return np.asarray(converted @ BACKWARD.T, np.float32)


def doubled(plane: NDArray[np.float32]) -> NDArray[np.float32]:
    """(2 h, 2 w) of (h, w), continued by its border."""
    for _ in range(2):  # rows, then columns
        rows = np.pad(plane, ((2, 2), (0, 0)), mode="edge")
        count = len(plane)
        taps = [rows[shift : shift + count + 1] for shift in range(4)]
        below = sum(weight * tap for weight, tap in zip(_CUBIC, taps, strict=True))  # at +1/4 of a sample
        above = sum(weight * tap for weight, tap in zip(_CUBIC[::-1], taps, strict=True))
        made = np.empty((2 * count, plane.shape[1]), np.float32)
        made[0::2], made[1::2] = above[:count], below[1:]
        plane = np.ascontiguousarray(made.T)
    return plane


def _codes(values: NDArray[np.float32], scale: float) -> NDArray[np.uint16]:
    return np.clip(np.rint(values / np.float32(scale)) + FLAT, 0, TOP).astype(np.uint16)
