"""Differences of R, G and B as a video's planes and back: BT.709, chroma halved by area and doubled by a cubic filter,
both with the samples in the middle of their four pixels (docs/format.md).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import MAX_CODE, MIDDLE_CODE
from eigenfield.coding.video.av1 import Planes
from eigenfield.imaging.colour import LUMA_BT709
from eigenfield.imaging.sampling import halve_picture

# Catmull and Rom's, a quarter of a sample from the second
QUARTER_CUBIC_TAPS = np.array([-9, 111, 29, -3], np.float32) / 128


def _matrix() -> NDArray[np.float64]:
    """(3, 3): R'G'B' to Y' and, of half their range, Cb and Cr."""
    luma = np.array(LUMA_BT709)
    blue = (np.array([0, 0, 1]) - luma) / (2 * (1 - luma[2]))
    red = (np.array([1, 0, 0]) - luma) / (2 * (1 - luma[0]))
    return np.stack([luma, blue, red])


RGB_TO_YCBCR = _matrix().astype(np.float32)
YCBCR_TO_RGB = np.linalg.inv(_matrix()).astype(np.float32)


def to_planes(
    difference: NDArray[np.float32], size: tuple[int, int], scale: tuple[float, float], full_chroma: bool = False
) -> Planes:
    """Differences of R, G and B as codes around 512.

    Args:
        difference: (h, w, 3) float32.
        size: (rows, columns) of luma's plane, both even; beyond (h, w) there is no difference.
        scale: What a code of luma, and of chroma, stands for.
        full_chroma: Whether chroma lies below luma in luma's plane, as fine as luma.
    """
    height, width = difference.shape[:2]
    converted = np.zeros((*size, 3), np.float32)
    converted[:height, :width] = difference @ RGB_TO_YCBCR.T
    if full_chroma:
        stacked = np.concatenate([_codes(converted[..., channel], scale[min(channel, 1)]) for channel in range(3)])
        flat = np.full((stacked.shape[0] // 2, stacked.shape[1] // 2), MIDDLE_CODE, np.uint16)
        return stacked, flat, flat
    blue, red = (halve_picture(converted[..., channel]) for channel in (1, 2))
    return _codes(converted[..., 0], scale[0]), _codes(blue, scale[1]), _codes(red, scale[1])


def to_difference(
    planes: Planes, height: int, width: int, scale: tuple[float, float], full_chroma: bool = False
) -> NDArray[np.float32]:
    """(height, width, 3) differences of R, G, B from the top left part of a frame's planes. Others as `to_planes`."""
    if full_chroma:
        luma, blue, red = np.split(planes[0].astype(np.float32) - MIDDLE_CODE, 3)
    else:
        luma, *halves = (plane.astype(np.float32) - MIDDLE_CODE for plane in planes)
        blue, red = (double_size(plane) for plane in halves)
    channels = luma * np.float32(scale[0]), blue * np.float32(scale[1]), red * np.float32(scale[1])
    converted = np.stack([channel[:height, :width] for channel in channels], axis=-1)
    return np.asarray(converted @ YCBCR_TO_RGB.T, np.float32)


def double_size(plane: NDArray[np.float32]) -> NDArray[np.float32]:
    """(2 h, 2 w) of (h, w), continued by its border."""
    for _ in range(2):  # rows, then columns
        rows = np.pad(plane, ((2, 2), (0, 0)), mode="edge")
        count = len(plane)
        taps = [rows[shift : shift + count + 1] for shift in range(4)]
        below = sum(weight * tap for weight, tap in zip(QUARTER_CUBIC_TAPS, taps, strict=True))  # at +1/4 of a sample
        above = sum(weight * tap for weight, tap in zip(QUARTER_CUBIC_TAPS[::-1], taps, strict=True))
        made = np.empty((2 * count, plane.shape[1]), np.float32)
        made[0::2], made[1::2] = above[:count], below[1:]
        plane = np.ascontiguousarray(made.T)
    return plane


def _codes(values: NDArray[np.float32], scale: float) -> NDArray[np.uint16]:
    return np.clip(np.rint(values / np.float32(scale)) + MIDDLE_CODE, 0, MAX_CODE).astype(np.uint16)
