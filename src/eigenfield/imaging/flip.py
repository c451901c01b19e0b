"""LDR-FLIP: the difference of a drawn picture to its photograph as seen by an eye that flips between the two.

Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating Images"
(HPG 2020); the constants are theirs, as are those of their program. Pictures are (H, W, 3) sRGB, float 0..1 or uint8;
floats are rounded to 8 bits first. 0 is no visible difference, 1 the greatest there is.

The tests compare with the authors' own package, flip-evaluator: the maps agree within 1e-4. It is not used here.
Version 1.7 takes 1.6 s of one core for a million pixels, and this module 0.12 s. It holds Python's global lock
meanwhile, so that cameras would be measured one after another. It has no wheels for Linux on ARM nor for Python 3.14.
"""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.colour import linear_of_srgb
from eigenfield.imaging.metrics import PictureArray, bounding_slices, code_pair
from eigenfield.runtime.parallel import pieces

# With the symbols of the paper. A contrast filter is a sum of terms a √(π/b) exp(-π² x² / b), x in degrees: here (a, b)
FLIP_PIXELS_PER_DEGREE = 67.0  # the authors' default, rounded: 3840 pixels on 0.7 m, seen from 0.7 m
FLIP_BAND_ROWS = 128  # processed at a time: the temporary pictures stay in the cache
FLIP_LUMINANCE = ((1.0, 0.0047),)
FLIP_RED_GREEN = ((1.0, 0.0053),)
FLIP_BLUE_YELLOW = ((34.1, 0.04), (13.5, 0.025))
FLIP_MIN_GAUSSIAN_RATIO = 1e-7  # of its peak, at which a Gaussian's kernel ends, unless at the authors' radius before
FLIP_COLOUR_POWER = 0.7  # q_c
FLIP_KNEE_DIFFERENCE_FRACTION = 0.4  # p_c, of the greatest colour difference
FLIP_KNEE_ERROR_FRACTION = 0.95  # p_t, the error at p_c, of the greatest error
FLIP_DETECTOR_DEGREES = 0.082  # w, the width of edge and point detectors
FLIP_RGB_TO_XYZ = np.array(
    [
        [10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
        [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
        [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382],
    ]
)
FLIP_RGB_TO_WHITE = FLIP_RGB_TO_XYZ / FLIP_RGB_TO_XYZ.sum(axis=1, keepdims=True)  # X, Y and Z as shares of D65's
FLIP_WHITE_TO_OPPONENT = np.array([[0.0, 1, 0], [1, -1, 0], [0, 1, -1]])  # YyCxCz without its factors, which cancel
FLIP_LAB_KNEE = (6 / 29) ** 3  # below it CIELAB's cube root is continued by its tangent

Channel = NDArray[np.float32]
FilterKernel = NDArray[np.float32]


def flip(drawn: PictureArray, photograph: PictureArray, covered: NDArray[np.bool_] | None = None) -> float | None:
    """The mean of `flip_map` over the covered pixels; None where no pixel is covered.

    Uncovered pixels of the drawn picture are replaced by the photograph's first, so that the filters see no edge
    there, as in masked SSIM.

    Args:
        drawn: (H, W, 3).
        photograph: (H, W, 3).
        covered: (H, W) the pixels that count; None: all.
    """
    a, b = code_pair(drawn, photograph)
    if covered is None:
        return float(flip_map(a, b).mean(dtype=np.float64))
    rows, columns = bounding_slices(covered)
    if rows.start == rows.stop:
        return None
    a = np.where(covered[..., None], a, b)
    part = _map_region(a, b, rows, columns)
    return float(part[covered[rows, columns]].mean(dtype=np.float64))


def flip_map(drawn: PictureArray, photograph: PictureArray) -> Channel:
    """(H, W) float32, 0..1: the FLIP difference of each pixel. Past its border a picture is continued by its edge."""
    a, b = code_pair(drawn, photograph)
    return _map_region(a, b, slice(0, a.shape[0]), slice(0, a.shape[1]))


def _map_region(a: NDArray[np.uint8], b: NDArray[np.uint8], rows: slice, columns: slice) -> Channel:
    """The map at the given rows and columns, a band at a time, each with the margin that its filters reach into."""
    assert a.shape[2] == 3, a.shape
    height, width = a.shape[:2]
    made = np.empty((rows.stop - rows.start, columns.stop - columns.start), np.float32)
    left, right = max(columns.start - FLIP_MARGIN_PIXELS, 0), min(columns.stop + FLIP_MARGIN_PIXELS, width)
    for start, stop in pieces(len(made), FLIP_BAND_ROWS):
        first, last = rows.start + start, rows.start + stop
        top, bottom = max(first - FLIP_MARGIN_PIXELS, 0), min(last + FLIP_MARGIN_PIXELS, height)
        part = _difference(a[top:bottom, left:right], b[top:bottom, left:right])
        made[start:stop] = part[first - top : last - top, columns.start - left : columns.stop - left]
    return made


def _difference(a: NDArray[np.uint8], b: NDArray[np.uint8]) -> Channel:
    """Equation 9: the colour difference to the power of one less the feature difference."""
    opponents = [_opponent_channels(codes) for codes in (a, b)]
    colour = _colour_difference(*(_perceived_lab(opponent) for opponent in opponents))
    feature = _feature_difference(*(_features(opponent[0]) for opponent in opponents))
    return np.power(colour, np.subtract(np.float32(1), feature, out=feature), out=colour)


def _opponent_channels(codes: NDArray[np.uint8]) -> list[Channel]:
    """Y, X - Y and Y - Z of 8-bit sRGB, each as a share of white's: the linear axes of luminance, red-green and
    blue-yellow."""
    planes = cv2.transform(
        cv2.LUT(codes, FLIP_LINEAR_CODES), (FLIP_WHITE_TO_OPPONENT @ FLIP_RGB_TO_WHITE).astype(np.float32)
    )
    return [np.asarray(plane, np.float32) for plane in cv2.split(planes)]


def _perceived_lab(opponent: list[Channel]) -> list[Channel]:
    """L*, a* and b* as the eye perceives a picture at this distance, a* and b* reduced where it is dark (Hunt)."""
    luminance = _filter_channel(opponent[0], FLIP_LUMINANCE_FILTER)
    x = _filter_channel(opponent[1], FLIP_RED_GREEN_FILTER) + luminance
    z = luminance - _filter_channel(opponent[2], FLIP_BLUE_YELLOW_FILTER)
    linear = cv2.transform(cv2.merge([x, luminance, z]), np.linalg.inv(FLIP_RGB_TO_WHITE).astype(np.float32))
    np.clip(linear, 0, 1, out=linear)
    return _hunt_lab(np.asarray(cv2.transform(linear, FLIP_RGB_TO_WHITE.astype(np.float32)), np.float32))


def _hunt_lab(white: NDArray[np.float32]) -> list[Channel]:
    """CIELAB of (H, W, 3) X, Y, Z as shares of white's, which are overwritten, with a* and b* times L* / 100."""
    root = np.asarray(cv2.pow(np.maximum(white, np.float32(FLIP_LAB_KNEE)), 1 / 3), np.float32)
    white -= np.float32(FLIP_LAB_KNEE)
    root += np.minimum(white, 0, out=white) * np.float32(FLIP_LAB_KNEE ** (-2 / 3) / 3)
    x, y, z = (np.asarray(plane, np.float32) for plane in cv2.split(root))
    lightness = 116 * y - 16
    return [lightness, (x - y) * (5 * lightness), (y - z) * (2 * lightness)]


def _colour_difference(a: list[Channel], b: list[Channel]) -> Channel:
    """HyAB, a city-block step in lightness and a straight one in colour, to the power q_c and scaled to 0..1: most of
    the scale is for small differences."""
    difference = _hyab(a, b)
    difference = np.asarray(cv2.pow(difference, FLIP_COLOUR_POWER), np.float32)
    knee, error = FLIP_KNEE_DIFFERENCE_FRACTION * FLIP_MAX_COLOUR_DIFFERENCE, FLIP_KNEE_ERROR_FRACTION
    above = difference * np.float32((1 - error) / (FLIP_MAX_COLOUR_DIFFERENCE - knee))
    above += np.float32(error - knee * (1 - error) / (FLIP_MAX_COLOUR_DIFFERENCE - knee))
    difference *= np.float32(error / knee)
    return np.minimum(difference, above, out=difference)  # the steeper line up to where they cross


def _hyab(a: list[Channel], b: list[Channel]) -> Channel:
    lightness, red_green, blue_yellow = (x - y for x, y in zip(a, b, strict=True))
    return np.abs(lightness) + _length(red_green, blue_yellow)


def _features(luminance: Channel) -> list[Channel]:
    """Strength of edges and of points (or lines) at each pixel, 0..1."""
    strengths = []
    for kernel in (FLIP_EDGE_DETECTOR, FLIP_POINT_DETECTOR):
        across = cv2.sepFilter2D(luminance, cv2.CV_32F, kernel, FLIP_DETECTOR_SMOOTH, borderType=cv2.BORDER_REPLICATE)
        down = cv2.sepFilter2D(luminance, cv2.CV_32F, FLIP_DETECTOR_SMOOTH, kernel, borderType=cv2.BORDER_REPLICATE)
        strengths.append(_length(np.asarray(across, np.float32), np.asarray(down, np.float32)))
    return strengths


def _feature_difference(a: list[Channel], b: list[Channel]) -> Channel:
    """Equation 8: the greater of the two differences in strength, over √2, to the power q_f = 1/2."""
    edge, point = (cv2.absdiff(x, y) for x, y in zip(a, b, strict=True))
    return np.asarray(cv2.sqrt(cv2.max(edge, point) * np.float32(math.sqrt(0.5))), np.float32)


def _length(x: Channel, y: Channel) -> Channel:
    """√(x² + y²), the same wherever its memory lies; cv2.magnitude rounds by that."""
    return np.sqrt(x * x + y * y)


def _filter_channel(plane: Channel, gaussians: list[tuple[float, FilterKernel]]) -> Channel:
    parts = [
        share * cv2.sepFilter2D(plane, cv2.CV_32F, kernel, kernel, borderType=cv2.BORDER_REPLICATE)
        for share, kernel in gaussians
    ]
    return np.asarray(sum(parts[1:], parts[0]), np.float32)


def _make_gaussians(terms: tuple[tuple[float, float], ...], radius: int) -> list[tuple[float, FilterKernel]]:
    """Each Gaussian of a contrast filter as a kernel of sum 1 and its share of the whole, on pixels up to `radius`."""
    made = []
    for a, b in terms:
        degrees = np.arange(-radius, radius + 1) / FLIP_PIXELS_PER_DEGREE
        shape = np.exp(-((np.pi * degrees) ** 2) / b)
        volume = a * math.sqrt(math.pi / b) * shape.sum() ** 2
        kept = shape[shape > FLIP_MIN_GAUSSIAN_RATIO]
        made.append((volume, (kept / kept.sum()).astype(np.float32)))
    whole = sum(volume for volume, _ in made)
    return [(volume / whole, kernel) for volume, kernel in made]


def _make_detectors() -> tuple[FilterKernel, FilterKernel, FilterKernel]:
    """A Gaussian of sum 1, and its first and second derivative, positive and negative values of sum 1 each."""
    sigma = 0.5 * FLIP_DETECTOR_DEGREES * FLIP_PIXELS_PER_DEGREE
    radius = math.ceil(3 * sigma)
    x = np.arange(-radius, radius + 1)
    shape = np.exp(-(x**2) / (2 * sigma**2))
    made = [shape / shape.sum()]
    for derivative in (-x * shape, (x**2 / sigma**2 - 1) * shape):
        up, down = np.maximum(derivative, 0), np.minimum(derivative, 0)
        made.append(up / up.sum() - down / down.sum())
    smooth, edge, point = (kernel.astype(np.float32) for kernel in made)
    return smooth, edge, point


def _max_colour_difference() -> float:
    """The greatest colour difference there is, of pure green and pure blue, to the power q_c."""
    green, blue = (_hunt_lab((FLIP_RGB_TO_WHITE @ axis)[None, None].astype(np.float32)) for axis in np.eye(3)[1:])
    return float(_hyab(green, blue).item() ** FLIP_COLOUR_POWER)


FLIP_RADIUS_PIXELS = math.ceil(3 * FLIP_PIXELS_PER_DEGREE * math.sqrt(FLIP_BLUE_YELLOW[0][1] / (2 * math.pi**2)))
FLIP_LUMINANCE_FILTER, FLIP_RED_GREEN_FILTER, FLIP_BLUE_YELLOW_FILTER = (
    _make_gaussians(terms, FLIP_RADIUS_PIXELS) for terms in (FLIP_LUMINANCE, FLIP_RED_GREEN, FLIP_BLUE_YELLOW)
)
FLIP_DETECTOR_SMOOTH, FLIP_EDGE_DETECTOR, FLIP_POINT_DETECTOR = _make_detectors()
FLIP_MARGIN_PIXELS = max(FLIP_RADIUS_PIXELS, len(FLIP_DETECTOR_SMOOTH) // 2)
FLIP_LINEAR_CODES = linear_of_srgb(np.arange(256) / 255).astype(np.float32)[None]  # (1, 256), of 8-bit sRGB
FLIP_MAX_COLOUR_DIFFERENCE = _max_colour_difference()
