"""RGB to Y'CbCr and back as carefully as it can be done: BT.709, full range, 10 bits.

By hand, because swscale (ffmpeg's and PyAV's own conversion) repeats chroma on the way from 4:2:0 to RGB: a video
measured that way loses up to 3 dB that are not its codec's fault. Here chroma is halved by area and doubled by a cubic
filter, both with the samples in the middle of their four pixels.
"""

from __future__ import annotations

from typing import Any, Literal

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.colour import LUMA_BT709

Chroma = Literal["420", "444"]
Planes = tuple[NDArray[np.uint16], NDArray[np.uint16], NDArray[np.uint16]]
Picture = NDArray[np.uint8]

PEAK = 1023  # of 10 bits
MIDDLE = 512  # the code of no colour (ITU-T H.273, full range)


def _matrix() -> NDArray[np.float64]:
    """(3, 3): R'G'B' of 0..1 to Y' of 0..1 and Cb, Cr of ±0.5."""
    luma = np.array(LUMA_BT709)
    blue = (np.array([0, 0, 1]) - luma) / (2 * (1 - luma[2]))
    red = (np.array([1, 0, 0]) - luma) / (2 * (1 - luma[0]))
    return np.stack([luma, blue, red])


FORWARD = (_matrix() * (PEAK / 255)).astype(np.float32)  # 8-bit codes to 10-bit ones, chroma around 0
BACKWARD = np.linalg.inv(_matrix() * (PEAK / 255)).astype(np.float32)


def to_planes(picture: Picture, chroma: Chroma = "420") -> Planes:
    """(H, W, 3) uint8 R'G'B' to 10-bit Y', Cb, Cr.

    "444": three planes of (H, W). "420": the picture is padded by its edge to even sides first, and the chroma planes
    are half as wide and high as luma's.
    """
    if chroma == "420":
        picture = pad(picture, *even(picture.shape[0], picture.shape[1]))
    converted = np.asarray(cv2.transform(picture.astype(np.float32), FORWARD))
    blue, red = converted[..., 1], converted[..., 2]
    if chroma == "420":
        height, width = picture.shape[0] // 2, picture.shape[1] // 2
        blue, red = (c.reshape(height, 2, width, 2).mean(axis=(1, 3), dtype=np.float32) for c in (blue, red))
    return _codes(converted[..., 0]), _codes(blue + MIDDLE), _codes(red + MIDDLE)


def to_rgb(planes: Planes, height: int, width: int) -> Picture:
    """(height, width, 3) uint8 R'G'B' of 10-bit planes; padding at the bottom and on the right is cut off.

    Which of the two samplings the planes have is told by their sizes.
    """
    luma = planes[0]
    size = (luma.shape[1], luma.shape[0])
    converted = np.empty((*luma.shape, 3), np.float32)
    converted[..., 0] = luma
    for channel, plane in enumerate(planes[1:], start=1):
        coloured = plane.astype(np.float32) - MIDDLE
        if plane.shape != luma.shape:
            coloured = np.asarray(cv2.resize(coloured, size, interpolation=cv2.INTER_CUBIC))
        converted[..., channel] = coloured
    colours = np.asarray(cv2.transform(converted[:height, :width], BACKWARD))
    return np.clip(np.rint(colours), 0, 255).astype(np.uint8)


def ceiling(picture: Picture, chroma: Chroma) -> Picture:
    """There and back without a codec: the best that any codec in this sampling can do."""
    return to_rgb(to_planes(picture, chroma), picture.shape[0], picture.shape[1])


def even(height: int, width: int) -> tuple[int, int]:
    """The sizes, each raised to the next even one."""
    return height + height % 2, width + width % 2


def pad(picture: Picture, height: int, width: int) -> Picture:
    """The picture with its last row and column repeated up to a size that is at least its own."""
    below, beside = height - picture.shape[0], width - picture.shape[1]
    return picture if below == beside == 0 else np.pad(picture, ((0, below), (0, beside), (0, 0)), mode="edge")


def _codes(plane: NDArray[Any]) -> NDArray[np.uint16]:
    return np.clip(np.rint(plane), 0, PEAK).astype(np.uint16)
