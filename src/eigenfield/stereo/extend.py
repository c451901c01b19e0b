"""Extrapolation of depth where too few photographs look, and removal of speckles."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from eigenfield.imaging.graph import components

EXTEND_SLOPE_SIGMA_PIXELS = 16.0  # of the window over which the slope at the border is measured
EXTEND_MAX_SLOPE_RANGES = 2.0  # steeper than this many times the range of d over the longer side is noise
EXTEND_UNTRUSTED_RIM_PIXELS = 4  # known pixels next to unknown ones: windows there include unknown pixels


def extend_depth(d: NDArray[np.float32], known: NDArray[np.bool_], low: float, high: float) -> NDArray[np.float32]:
    """Depth where it is known; elsewhere the plane of the nearest known point.

    Slopes are least squares over a Gaussian window of known points. If nothing is known, d is returned unchanged.

    Args:
        low: Lower bound of extrapolated labels.
        high: Upper bound.
    """
    if known.all() or not known.any():
        return d
    eroded = cv2.erode(
        known.astype(np.uint8),
        np.ones((2 * EXTEND_UNTRUSTED_RIM_PIXELS + 1, 2 * EXTEND_UNTRUSTED_RIM_PIXELS + 1)),
        borderValue=1,
    )
    known = _remove_small_components(np.asarray(eroded, np.uint8))
    if not known.any():
        return d
    weight = known.astype(np.float32)
    y, x = np.mgrid[: d.shape[0], : d.shape[1]].astype(np.float32)

    def mean(values: NDArray[np.float32]) -> NDArray[np.float32]:
        blurred = cv2.GaussianBlur(values * weight, (0, 0), EXTEND_SLOPE_SIGMA_PIXELS, borderType=cv2.BORDER_CONSTANT)
        return np.asarray(blurred / total, np.float32)

    total = np.maximum(
        cv2.GaussianBlur(weight, (0, 0), EXTEND_SLOPE_SIGMA_PIXELS, borderType=cv2.BORDER_CONSTANT), 1e-6
    )
    x -= d.shape[1] / 2
    y -= d.shape[0] / 2
    mx, my, md = mean(x), mean(y), mean(d)
    xx, yy, xy = mean(x * x) - mx * mx + 1, mean(y * y) - my * my + 1, mean(x * y) - mx * my
    xd, yd = mean(x * d) - mx * md, mean(y * d) - my * md
    determinant = xx * yy - xy * xy
    steepest = EXTEND_MAX_SLOPE_RANGES * (high - low) / max(d.shape)
    slope_x = np.clip((xd * yy - yd * xy) / determinant, -steepest, steepest)
    slope_y = np.clip((yd * xx - xd * xy) / determinant, -steepest, steepest)
    row, column = ndimage.distance_transform_edt(~known, return_distances=False, return_indices=True)
    extrapolated = (
        d[row, column] + slope_x[row, column] * (x - x[row, column]) + slope_y[row, column] * (y - y[row, column])
    )
    blurred = cv2.GaussianBlur(np.where(known, d, extrapolated), (0, 0), 2.0)  # the nearest point changes abruptly
    return np.where(known, d, np.clip(blurred, low, high)).astype(np.float32)


def remove_speckles(
    d: NDArray[np.float32], discontinuities: tuple[NDArray[np.bool_], NDArray[np.bool_]], min_pixels: int
) -> NDArray[np.float32]:
    """Depth without small regions that discontinuities separate from everything around them.

    Their pixels take the depth of the nearest pixel that stays. The pixels of a smeared step are such regions: the step
    becomes sharp.

    Args:
        discontinuities: Masks of the horizontal and vertical pixel edges (`find_discontinuities`).
    """
    index = np.arange(d.size).reshape(d.shape)
    one = np.concatenate([index[:, :-1][~discontinuities[0]], index[:-1][~discontinuities[1]]])
    other = np.concatenate([index[:, 1:][~discontinuities[0]], index[1:][~discontinuities[1]]])
    piece = components(d.size, one, other)
    speckles = (np.bincount(piece) < min_pixels)[piece].reshape(d.shape)
    if not speckles.any() or speckles.all():
        return d
    row, column = ndimage.distance_transform_edt(speckles, return_distances=False, return_indices=True)
    return np.asarray(d[row, column], np.float32)


def _remove_small_components(known: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Drop components smaller than a hundredth of the largest: chance matches where hardly any view looks."""
    count, labels, about, _ = cv2.connectedComponentsWithStats(known, connectivity=4)
    areas = about[1:count, cv2.CC_STAT_AREA]
    if len(areas) == 0:
        return known > 0
    keep = np.concatenate([[False], areas >= areas.max() / 100])
    return np.asarray(keep[labels])
