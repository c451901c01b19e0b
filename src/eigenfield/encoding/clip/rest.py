"""What stands still in a group of frames: there each photograph is replaced by the average over the group.

Then mean and textures are the same in all frames there without a term that says so, the films have nothing to code, and
noise is less by the root of the number of frames. A pixel is still where a small window around it varies no more than
noise does, and has the same average in both halves of the group.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.observations import Observations, Photograph
from eigenfield.imaging.metrics import to_codes
from eigenfield.runtime.files import read_arrays

WINDOW_PIXELS = 5
MIN_FRAMES = 4  # of fewer nothing is averaged
RANGE_SIGMAS = 10.0  # from the least to the greatest value of a window, in standard deviations of its noise
DRIFT_SIGMAS = 5.0  # between the averages of both halves, likewise
MIN_RANGE, MIN_DRIFT = 1.5 / 255, 0.75 / 255  # that are always still
NOISE_QUANTILE = 0.25  # of the windows' variances, which is taken as the camera's noise
NOISE_MAX = 0.5 / 255  # of a window: what is more is motion everywhere, as of a lamp that flickers
MARGIN_PIXELS = 7  # around what moves, which counts as moving
BLEND_PIXELS = 5
ARRAYS_FILE = "camera_{}.npz"


@dataclass(frozen=True, eq=False)
class CameraAtRest:
    """What stands still before one camera.

    Attributes:
        average: (h, w, 3) uint8 codes of the average over the frames.
        share: (h, w) uint8, 255 where the average stands for all frames, 0 where each shows its own.
    """

    average: NDArray[np.uint8]
    share: NDArray[np.uint8]

    def save(self, folder: Path, camera: int) -> None:
        """Write it as a file of a stage."""
        np.savez(folder / ARRAYS_FILE.format(camera), average=self.average, share=self.share)

    @staticmethod
    def load(folder: Path, camera: int) -> CameraAtRest:
        """What `save` has written."""
        return CameraAtRest(**read_arrays(folder / ARRAYS_FILE.format(camera)))

    def shown(self, photograph: Photograph) -> Photograph:
        """A photograph with its still pixels averaged."""
        share = self.share[..., None].astype(np.float32) / np.float32(255)
        average = self.average.astype(np.float32) / np.float32(255)
        return Photograph(photograph.pixels + share * (average - photograph.pixels), photograph.mask)


@dataclass(frozen=True, eq=False)
class AtRest:
    """Observations of which the still pixels are averaged, a camera each.

    Attributes:
        folder: Of the stage that has what stands still before each camera.
    """

    whole: Observations
    folder: Path

    def __len__(self) -> int:
        return len(self.whole)

    def camera_of(self, index: int) -> int:
        return self.whole.camera_of(index)

    def time_of(self, index: int) -> int:
        return self.whole.time_of(index)

    def photograph(self, index: int) -> Photograph:
        return CameraAtRest.load(self.folder, self.camera_of(index)).shown(self.whole.photograph(index))


def camera_at_rest(
    photographs: Iterable[Photograph], frames: int, surface_moves: NDArray[np.bool_] | None = None
) -> CameraAtRest:
    """What stands still in the photographs of a camera, which are looked at one after the other.

    Args:
        frames: How many there are, at least 2.
        surface_moves: (h, w) which pixels see a surface that moves: they are none that stand still, whatever they show.
    """
    totals: list[NDArray[np.float32]] = []
    low = high = before = change = np.zeros(0, np.float32)
    for number, one in enumerate(photographs):
        smooth = np.asarray(cv2.blur(one.pixels, (WINDOW_PIXELS, WINDOW_PIXELS)), np.float32)
        mask = np.ones(smooth.shape[:2], np.float32) if one.mask is None else one.mask
        seen = mask[..., None] > 0.5
        if not totals:
            height, width, _ = smooth.shape
            totals = [np.zeros((height, width, 4), np.float32) for _ in range(2)]
            low, high = np.full_like(smooth, np.inf), np.full_like(smooth, -np.inf)
            before, change = smooth, np.zeros((height, width), np.float32)
        half = totals[int(2 * number >= frames)]
        half[..., :3] += seen * one.pixels
        half[..., 3:] += seen
        low, high = np.minimum(low, np.where(seen, smooth, np.inf)), np.maximum(high, np.where(seen, smooth, -np.inf))
        change += np.square(smooth - before).mean(axis=2)
        before = smooth
    noise = min(math.sqrt(float(np.quantile(change / (2 * (frames - 1)), NOISE_QUANTILE))), NOISE_MAX)
    first, second = (cv2.blur(one[..., :3] / np.maximum(one[..., 3:], 1), (WINDOW_PIXELS,) * 2) for one in totals)
    both = totals[0] + totals[1]
    moves = (high - low).max(axis=2) > max(RANGE_SIGMAS * noise, MIN_RANGE)
    moves |= np.abs(first - second).max(axis=2) > max(2 * DRIFT_SIGMAS * noise / math.sqrt(frames), MIN_DRIFT)
    moves = cv2.morphologyEx(moves.astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))  # specks are noise
    unseen = np.minimum(totals[0][..., 3], totals[1][..., 3]) < 1  # also a speck of these has no average
    moves = np.maximum(moves, unseen.astype(np.uint8))
    if surface_moves is not None:
        moves = np.maximum(moves, surface_moves.astype(np.uint8))
    around = cv2.dilate(moves, np.ones((MARGIN_PIXELS, MARGIN_PIXELS), np.uint8))
    share = np.minimum(cv2.blur(1 - around.astype(np.float32), (BLEND_PIXELS, BLEND_PIXELS)), 1 - moves)
    average = both[..., :3] / np.maximum(both[..., 3:], 1)
    return CameraAtRest(to_codes(average), np.rint(255 * share).astype(np.uint8))
