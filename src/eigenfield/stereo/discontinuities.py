"""Depth discontinuities: where a depth map steps from one surface to another, as opposed to where a surface slants."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

STEP_SLOPE_WINDOW_EDGES = 15  # the median difference over them is the slope: a smear covers less than half
STEP_MAX_SMEAR_EDGES = 7  # over which a step may be smeared
STEP_MIN_EDGE_PIXELS = 0.15  # in the outermost view: least departure of one edge of a step from the slope
STEP_MIN_TOTAL_PIXELS = 0.8  # least departure of the whole step
STEP_NOISE_WINDOW_PIXELS = 21
STEP_NOISE_FACTOR = 4.0
STEP_NOISE_QUANTUM_PIXELS = 0.02


def find_discontinuities(
    d: NDArray[np.float32], pixel_labels: float, cut_labels: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which pixel edges between horizontal and vertical neighbours are part of a depth step.

    With j the differences along a line and s their median over STEP_SLOPE_WINDOW_EDGES edges, the departure from the
    slope is e = j - s. It is zero on slants and at their kinks, except next to the border. A step may be smeared over a
    few pixels. It lies where e sums to more than STEP_MIN_TOTAL_PIXELS over STEP_MAX_SMEAR_EDGES edges. Its edges are
    those near there with |e| > max(STEP_MIN_EDGE_PIXELS, STEP_NOISE_FACTOR times the local median of |e|).

    Args:
        pixel_labels: The difference in d that moves a point by one pixel in the outermost view: the unit of e.
        cut_labels: Differences of more than this in d are steps whatever the slope.

    Returns:
        (h, w - 1) and (h - 1, w) masks.
    """
    d = np.ascontiguousarray(d, np.float32)
    right = _along_rows(d, pixel_labels, cut_labels)
    down = _along_rows(np.ascontiguousarray(d.T), pixel_labels, cut_labels)
    return right, np.ascontiguousarray(down.T)


def _along_rows(d: NDArray[np.float32], pixel_labels: float, cut_labels: float) -> NDArray[np.bool_]:
    j = np.diff(d, axis=1)
    e = (j - median_filter(j, (1, STEP_SLOPE_WINDOW_EDGES), mode="reflect")) / np.float32(pixel_labels)
    quantised = np.minimum(np.abs(e) / np.float32(STEP_NOISE_QUANTUM_PIXELS), 255).astype(np.uint8)
    noise = cv2.medianBlur(quantised, STEP_NOISE_WINDOW_PIXELS) * np.float32(STEP_NOISE_QUANTUM_PIXELS)
    whole = np.abs(cv2.blur(e, (STEP_MAX_SMEAR_EDGES, 1))) * np.float32(STEP_MAX_SMEAR_EDGES)
    near = cv2.dilate(whole, np.ones((1, STEP_MAX_SMEAR_EDGES), np.uint8)) > STEP_MIN_TOTAL_PIXELS
    return np.asarray(
        (near & (np.abs(e) > np.maximum(STEP_MIN_EDGE_PIXELS, STEP_NOISE_FACTOR * noise))) | (np.abs(j) > cut_labels),
        np.bool_,
    )
