"""Flicker of a clip: how its pictures change where photographs stand still, and whether they change where those do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.colour import LUMA_BT709
from eigenfield.imaging.metrics import ssim

STILL_WINDOW_PIXELS = 5  # side: a pixel is still where the mean of so many around it stays
STILL_NOISE_RATIO = 1.5  # how far that mean may stray, in standard deviations of one pixel's noise
STILL_MIN_LEVELS = 1.0  # grey levels that it may stray in any case

Picture = NDArray[np.uint8]
Mask = NDArray[np.bool_]


class StillPixels:
    """Finds the pixels of one camera that do not change, from its photographs alone, one after the other."""

    def __init__(self) -> None:
        self._first: NDArray[np.float32] | None = None

    def add(self, photograph: Picture, mask: NDArray[np.float32] | None = None) -> None:
        """Take the next photograph.

        Args:
            photograph: (H, W, 3).
            mask: (H, W) valid pixels. One that is not valid counts as it was last seen.
        """
        luma = luma_of(photograph)
        if self._first is None:
            self._first = self._last = luma
            self._sum, self._squares, self._count = np.zeros_like(luma), np.zeros_like(luma), 0
            self._low = self._high = _smooth(luma)
        if mask is not None:
            luma = np.where(mask > 0.5, luma, self._last)
        change, smooth = luma - self._first, _smooth(luma)
        self._sum, self._squares, self._count = self._sum + change, self._squares + change * change, self._count + 1
        self._low, self._high, self._last = np.minimum(self._low, smooth), np.maximum(self._high, smooth), luma

    @property
    def still(self) -> Mask:
        """(H, W): where the window's mean never strays from its mean over time by more than STILL_NOISE_RATIO allows.

        The noise of a pixel is the lower quartile of the standard deviations over time, so at least a quarter of the
        picture must stand still for it to be the camera's.
        """
        assert self._first is not None
        mean = self._sum / np.float32(self._count)
        deviations = np.sqrt(np.maximum(self._squares / np.float32(self._count) - mean * mean, 0))
        middle = _smooth(self._first + mean)
        strays = np.maximum(self._high - middle, middle - self._low)
        noise = float(np.percentile(deviations, 25))
        return np.asarray(strays <= max(STILL_MIN_LEVELS, STILL_NOISE_RATIO * noise))


class Flicker:
    """Measures the pictures drawn for one camera against its photographs, one after the other.

    Args:
        still: (H, W) of `StillPixels`.
    """

    def __init__(self, still: Mask) -> None:
        self._still, self._counted = still, np.ones_like(still)
        self._before: tuple[Picture, Picture, Mask] | None = None
        self._first: NDArray[np.float32] | None = None
        self._alike: list[float] = []
        self._frames = 0

    def add(self, drawn: Picture, photograph: Picture, covered: Mask) -> None:
        """Take the next picture, (H, W, 3), its photograph, and (H, W) the pixels that count."""
        if self._before is not None:
            drawn_before, photograph_before, covered_before = self._before
            moving = covered & covered_before & ~self._still
            changes = _change(drawn_before, drawn), _change(photograph_before, photograph)
            alike = ssim(*changes, moving)
            self._alike += [] if alike is None else [alike]
        luma = luma_of(drawn)
        if self._first is None:
            self._first = luma
            self._sum, self._squares = np.zeros_like(luma), np.zeros_like(luma)
        change = luma - self._first
        self._sum, self._squares, self._frames = self._sum + change, self._squares + change * change, self._frames + 1
        self._counted &= covered
        self._before = drawn, photograph, covered

    @property
    def figures(self) -> dict[str, float | None]:
        """The camera's figures.

        `still`: grey levels, the root mean square over still pixels of the standard deviation over time of the drawn
        luma; `still_pixels`: how many these are; `still_share`: of all that are covered in each frame; `moving_ssim`:
        SSIM of the differences between pictures that follow each other, in pixels that are not still. None where no
        such pixels are.
        """
        counted = self._still & self._counted
        pixels, covered = int(np.count_nonzero(counted)), int(np.count_nonzero(self._counted))
        level = None
        if pixels:
            mean = self._sum[counted].astype(np.float64) / self._frames
            variance = self._squares[counted].astype(np.float64) / self._frames - mean**2
            level = float(np.sqrt(np.maximum(variance, 0).mean()))
        return {
            "still": level,
            "still_pixels": pixels,
            "still_share": pixels / covered if covered else None,
            "moving_ssim": float(np.mean(self._alike)) if self._alike else None,
        }


def pool_flicker(cameras: Sequence[Mapping[str, float | None]]) -> dict[str, float | None]:
    """The figures of several cameras as one: `still` over all their still pixels, the others as means over cameras."""
    levels = [(one["still"], one["still_pixels"]) for one in cameras if one["still"] is not None]
    pixels = sum(count or 0 for _, count in levels)
    squares = sum((level or 0) ** 2 * (count or 0) for level, count in levels)
    found: dict[str, float | None] = {"still": float(np.sqrt(squares / pixels)) if pixels else None}
    for key in ("still_share", "moving_ssim"):
        values = [value for one in cameras if (value := one[key]) is not None]
        found[key] = float(np.mean(values)) if values else None
    return found


def border_step(psnr: Mapping[int, float], starts: Sequence[int]) -> dict[str, float | int] | None:
    """The largest change of PSNR from the last frame of a group to the first of the next.

    Args:
        psnr: dB by frame; a border of which a side is missing does not count.
        starts: The first frame of each group.

    Returns:
        `step` in dB and `frame`, the first of the group behind it; None where no border has both sides.
    """
    steps = [(abs(psnr[start] - psnr[start - 1]), start) for start in starts if {start, start - 1} <= psnr.keys()]
    step, frame = max(steps, default=(None, None), key=lambda pair: pair[0])
    return None if step is None or frame is None else {"step": step, "frame": frame}


def luma_of(picture: Picture) -> NDArray[np.float32]:
    """(H, W) BT.709 luma in grey levels, not rounded."""
    return np.asarray(cv2.transform(picture.astype(np.float32), np.array([LUMA_BT709], np.float32)), np.float32)


def _smooth(luma: NDArray[np.float32]) -> NDArray[np.float32]:
    side = STILL_WINDOW_PIXELS
    return np.asarray(cv2.blur(luma, (side, side), borderType=cv2.BORDER_REFLECT), np.float32)


def _change(before: Picture, after: Picture) -> Picture:
    """The difference of two pictures about the middle code; what exceeds 127 levels is cut."""
    difference = after.astype(np.int16) - before
    return np.asarray(np.clip(difference, -127, 127) + 128, np.uint8)
