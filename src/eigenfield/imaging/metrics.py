"""PSNR and SSIM of a drawn picture against its photograph (docs/measures.md has each definition).

Pictures are (H, W, C), float 0..1 or uint8; floats are rounded to 8 bits first. `covered` is (H, W) bool: the pixels
that count. Without it the whole frame does.
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.colour import LUMA_BT709
from eigenfield.runtime.parallel import pieces

PSNR_MAX_DECIBELS = 100.0  # also of identical pictures, whose PSNR is infinite

SSIM_RADIUS_PIXELS = 5  # an 11 x 11 window, as in the paper that introduced SSIM
SSIM_SIGMA_PIXELS = 1.5  # of the Gaussian window
SSIM_C1, SSIM_C2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
SSIM_BAND_ROWS = 64  # processed at a time: the temporary pictures stay in the cache
SSIM_MIDDLE_CODE = np.float32(127.5)  # subtracted before squaring, so that float32 keeps the small variances

PictureArray = NDArray[Any]


def to_codes(picture: PictureArray) -> NDArray[np.uint8]:
    """A picture as it would be written with 8 bits: rounded, clipped; uint8 is returned as it is."""
    if picture.dtype == np.uint8:
        return picture
    return np.clip(np.rint(picture * np.float32(255)), 0, 255).astype(np.uint8)


def psnr(drawn: PictureArray, photograph: PictureArray, covered: NDArray[np.bool_] | None = None) -> float | None:
    """Peak signal-to-noise ratio in dB, peak 255, the squared error pooled over pixels and channels.

    At most PSNR_MAX_DECIBELS. None where no pixel is covered.
    """
    a, b = code_pair(drawn, photograph)
    return _decibels(_sum_squares(a, b, covered), _count_pixels(a, covered) * a.shape[2])


def psnr_luma(drawn: PictureArray, photograph: PictureArray, covered: NDArray[np.bool_] | None = None) -> float | None:
    """PSNR of Y' = 0.2126 R + 0.7152 G + 0.0722 B of the rounded pictures; Y' itself is not rounded again."""
    a, b = code_pair(drawn, photograph)
    difference = cv2.subtract(a, b, dtype=cv2.CV_32F)
    luma = cv2.transform(np.asarray(difference), np.array([LUMA_BT709], np.float32))
    return _decibels(_sum_squares(np.asarray(luma), np.zeros_like(luma), covered), _count_pixels(a, covered))


def ssim(drawn: PictureArray, photograph: PictureArray, covered: NDArray[np.bool_] | None = None) -> float | None:
    """Structural similarity (Wang, Bovik, Sheikh, Simoncelli 2004, equation 13), the mean over channels and pixels.

    Gaussian window of σ = 1.5 cut to 11 x 11, K = 0.01 and 0.03, population covariance, range 255; past its border a
    picture is mirrored. With `covered`, uncovered pixels of the drawn picture are replaced by the photograph's, and the
    map is averaged over all covered pixels; None where there are none. Without it, the 5 outermost pixels, whose
    windows reach over the border, are left out of the average, as in Wang's program and scikit-image. Sums are float32:
    within 1e-6 of scikit-image's on photographs, 2e-5 on flat, bright pictures.
    """
    a, b = code_pair(drawn, photograph)
    height, width = a.shape[:2]
    if covered is None:
        covered = np.zeros((height, width), bool)
        edge = SSIM_RADIUS_PIXELS if min(height, width) > 2 * SSIM_RADIUS_PIXELS else 0
        covered[edge : height - edge, edge : width - edge] = True
    else:
        a = np.where(covered[..., None], a, b)
    rows, columns = bounding_slices(covered)
    total, count = 0.0, int(covered.sum())
    if count == 0:
        return None
    left, right = max(columns.start - SSIM_RADIUS_PIXELS, 0), min(columns.stop + SSIM_RADIUS_PIXELS, width)
    for start, stop in pieces(rows.stop - rows.start, SSIM_BAND_ROWS):
        first, last = rows.start + start, rows.start + stop
        top, bottom = max(first - SSIM_RADIUS_PIXELS, 0), min(last + SSIM_RADIUS_PIXELS, height)
        structure = _ssim_map(a[top:bottom, left:right], b[top:bottom, left:right])
        inside = structure[first - top : last - top, columns.start - left : columns.stop - left]
        total += float(inside[covered[first:last, columns]].sum(dtype=np.float64))
    return total / float(count * a.shape[2])


def _ssim_map(a: NDArray[np.uint8], b: NDArray[np.uint8]) -> NDArray[np.floating[Any]]:
    """(H, W, C) float32 SSIM map. The variances enter only as their sum, so four smoothed pictures are enough."""
    x, y = (picture.astype(np.float32) - SSIM_MIDDLE_CODE for picture in (a, b))
    mean_x, mean_y = _smooth(x), _smooth(y)
    product = mean_x * mean_y
    power = mean_x * mean_x + mean_y * mean_y
    covariance = _smooth(x * y) - product
    variances = _smooth(x * x + y * y) - power
    # back to means of 0..255: (x + m)(y + m) = xy + m (x + y + m)
    shift = SSIM_MIDDLE_CODE * (mean_x + mean_y + SSIM_MIDDLE_CODE)
    product += shift
    power += 2 * shift
    product *= 2
    covariance *= 2
    result = (product + np.float32(SSIM_C1)) * (covariance + np.float32(SSIM_C2))
    result /= (power + np.float32(SSIM_C1)) * (variances + np.float32(SSIM_C2))
    return result


def _smooth(picture: NDArray[np.float32]) -> NDArray[np.float32]:
    kernel = cv2.getGaussianKernel(2 * SSIM_RADIUS_PIXELS + 1, SSIM_SIGMA_PIXELS, cv2.CV_32F)
    smooth = cv2.sepFilter2D(picture, cv2.CV_32F, kernel, kernel, borderType=cv2.BORDER_REFLECT)
    return np.asarray(smooth, np.float32).reshape(picture.shape)


def bounding_slices(covered: NDArray[np.bool_]) -> tuple[slice, slice]:
    """Rows and columns of the smallest rectangle around all covered pixels; empty where there are none."""
    spans = []
    for axis in (1, 0):
        at = np.flatnonzero(covered.any(axis=axis))
        spans.append(slice(int(at[0]), int(at[-1]) + 1) if len(at) else slice(0, 0))
    return spans[0], spans[1]


def _sum_squares(a: PictureArray, b: PictureArray, covered: NDArray[np.bool_] | None) -> float:
    """Sum of squared differences over the covered pixels and all channels; exact for uint8."""
    if covered is None:
        return float(cv2.norm(a, b, cv2.NORM_L2SQR))
    return float(cv2.norm(a, b, cv2.NORM_L2SQR, np.ascontiguousarray(covered).view(np.uint8)))


def _count_pixels(picture: PictureArray, covered: NDArray[np.bool_] | None) -> int:
    return int(picture.shape[0] * picture.shape[1] if covered is None else np.count_nonzero(covered))


def code_pair(drawn: PictureArray, photograph: PictureArray) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Both pictures as `to_codes`, which must have the same shape (H, W, C)."""
    assert drawn.shape == photograph.shape and drawn.ndim == 3, (drawn.shape, photograph.shape)
    return to_codes(drawn), to_codes(photograph)


def _decibels(squares: float, count: int) -> float | None:
    """PSNR from a sum of squared errors over `count` values."""
    if count == 0:
        return None
    if squares == 0:
        return PSNR_MAX_DECIBELS
    return float(min(PSNR_MAX_DECIBELS, 10 * np.log10(255.0**2 * count / squares)))
