"""Depth where no or too few photographs look: drawn on from where they do."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from eigenfield.imaging.graph import components

REACH = 16.0  # pixels, one sigma, over which the slope at the border is taken
STEEPEST = 2.0  # times the range of d over the canvas's longer side: steeper slopes are noise
RIM = 4  # pixels next to the unknown that are not trusted either: windows there reach beyond


def extended(d: NDArray[np.float32], known: NDArray[np.bool_], low: float, high: float) -> NDArray[np.float32]:
    """d (h, w) where `known`; elsewhere the nearest known point's plane, within [low, high].

    Slopes are least squares over a Gaussian window of known points. Nothing known: d as it is.
    """
    if known.all() or not known.any():
        return d
    eroded = cv2.erode(known.astype(np.uint8), np.ones((2 * RIM + 1, 2 * RIM + 1)), borderValue=1)
    known = _without_islands(np.asarray(eroded, np.uint8))
    if not known.any():
        return d
    weight = known.astype(np.float32)
    y, x = np.mgrid[: d.shape[0], : d.shape[1]].astype(np.float32)

    def mean(values: NDArray[np.float32]) -> NDArray[np.float32]:
        blurred = cv2.GaussianBlur(values * weight, (0, 0), REACH, borderType=cv2.BORDER_CONSTANT)
        return np.asarray(blurred / total, np.float32)

    total = np.maximum(cv2.GaussianBlur(weight, (0, 0), REACH, borderType=cv2.BORDER_CONSTANT), 1e-6)
    x -= d.shape[1] / 2
    y -= d.shape[0] / 2
    mx, my, md = mean(x), mean(y), mean(d)
    xx, yy, xy = mean(x * x) - mx * mx + 1, mean(y * y) - my * my + 1, mean(x * y) - mx * my
    xd, yd = mean(x * d) - mx * md, mean(y * d) - my * md
    determinant = xx * yy - xy * xy
    steepest = STEEPEST * (high - low) / max(d.shape)
    slope_x = np.clip((xd * yy - yd * xy) / determinant, -steepest, steepest)
    slope_y = np.clip((yd * xx - xd * xy) / determinant, -steepest, steepest)
    row, column = ndimage.distance_transform_edt(~known, return_distances=False, return_indices=True)
    drawn = d[row, column] + slope_x[row, column] * (x - x[row, column]) + slope_y[row, column] * (y - y[row, column])
    blurred = cv2.GaussianBlur(np.where(known, d, drawn), (0, 0), 2.0)  # the nearest point changes abruptly
    return np.where(known, d, np.clip(blurred, low, high)).astype(np.float32)


def without_specks(
    d: NDArray[np.float32], steps: tuple[NDArray[np.bool_], NDArray[np.bool_]], smallest: int
) -> NDArray[np.float32]:
    """d (h, w) without pieces of fewer than `smallest` pixels that steps (`step_sides`) set apart from all around.

    They take the depth of the nearest pixel that stays. The pixels of a smeared step are such pieces: it gets sharp.
    """
    index = np.arange(d.size).reshape(d.shape)
    one = np.concatenate([index[:, :-1][~steps[0]], index[:-1][~steps[1]]])
    other = np.concatenate([index[:, 1:][~steps[0]], index[1:][~steps[1]]])
    piece = components(d.size, one, other)
    specks = (np.bincount(piece) < smallest)[piece].reshape(d.shape)
    if not specks.any() or specks.all():
        return d
    row, column = ndimage.distance_transform_edt(specks, return_distances=False, return_indices=True)
    return np.asarray(d[row, column], np.float32)


def _without_islands(known: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Without pieces smaller than a hundredth of the largest: chance matches out where hardly anybody looks."""
    count, labels, about, _ = cv2.connectedComponentsWithStats(known, connectivity=4)
    areas = about[1:count, cv2.CC_STAT_AREA]
    if len(areas) == 0:
        return known > 0
    keep = np.concatenate([[False], areas >= areas.max() / 100])
    return np.asarray(keep[labels])
