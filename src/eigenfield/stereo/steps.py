"""Where a depth map steps from one surface to another, as opposed to where a surface slants."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

SLOPE = 15  # sides along the line, of whose differences the median is the slope there: a smear is less than half
SMEAR = 7  # sides over which a step may be smeared
LEAST = 0.15  # pixels in the outermost view by which a side of a step departs from the slope ..
WHOLE = 0.8  # .. and by which the whole step does
NOISE_WINDOW = 21  # pixels
NOISE_TIMES = 4.0
NOISE_GRAIN = 0.02  # pixels


def step_sides(d: NDArray[np.float32], pixel: float, cut: float) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """(h, w - 1) and (h - 1, w): which sides between horizontal and vertical neighbours of d (h, w) are part of a step.

    pixel: the difference in d that moves a point by a pixel in the outermost view; all that follows is in such pixels.
    With j the differences along a line and s their median over SLOPE sides, the departure from the slope is e = j - s:
    nought on slants and at their kinks (but those next to the border). A step may be smeared over a few pixels, and is
    where e sums up to more than WHOLE over SMEAR sides. Its sides are those near there with
    |e| > max(LEAST, NOISE_TIMES the median of |e| over NOISE_WINDOW x NOISE_WINDOW). Differences of more than `cut`,
    in d, are steps whatever the slope.
    """
    d = np.ascontiguousarray(d, np.float32)
    right, down = _along_rows(d, pixel, cut), _along_rows(np.ascontiguousarray(d.T), pixel, cut)
    return right, np.ascontiguousarray(down.T)


def _along_rows(d: NDArray[np.float32], pixel: float, cut: float) -> NDArray[np.bool_]:
    j = np.diff(d, axis=1)
    e = (j - median_filter(j, (1, SLOPE), mode="reflect")) / np.float32(pixel)
    grains = np.minimum(np.abs(e) / np.float32(NOISE_GRAIN), 255).astype(np.uint8)
    noise = cv2.medianBlur(grains, NOISE_WINDOW) * np.float32(NOISE_GRAIN)
    whole = np.abs(cv2.blur(e, (SMEAR, 1))) * np.float32(SMEAR)
    near = cv2.dilate(whole, np.ones((1, SMEAR), np.uint8)) > WHOLE
    return np.asarray((near & (np.abs(e) > np.maximum(LEAST, NOISE_TIMES * noise))) | (np.abs(j) > cut), np.bool_)
