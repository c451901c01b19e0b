"""LDR-FLIP: how much a drawn picture differs from its photograph to an eye that flips between the two.

Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating Images"
(HPG 2020); the constants are theirs, as are those of their program. Pictures are (H, W, 3) sRGB, float 0..1 or uint8;
floats are rounded to 8 bits first. 0 is no visible difference, 1 the greatest there is.

The authors' own package, flip-evaluator, is what the tests compare with (the maps agree within 1e-4) and not what
measures. Version 1.7 takes 1.6 s of one core for a million pixels, and this module 0.12 s. It holds Python's global
lock meanwhile, so that cameras would be measured one after another. It has no wheels for Linux on ARM nor for
Python 3.14.
"""

from __future__ import annotations

import math

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.colour import linear_of_srgb
from eigenfield.imaging.metrics import Picture, extent, to_codes
from eigenfield.runtime.parallel import pieces

PIXELS_PER_DEGREE = 67.0  # their default, rounded: 3840 pixels on 0.7 m, seen from 0.7 m
BAND = 128  # rows worked on at a time: the temporary pictures stay in the cache

# Contrast sensitivity as filters: sums of a √(π/b) exp(-π² x² / b), x in degrees; (a, b) of each.
LUMINANCE, RED_GREEN, BLUE_YELLOW = ((1.0, 0.0047),), ((1.0, 0.0053),), ((34.1, 0.04), (13.5, 0.025))
NEGLIGIBLE = 1e-7  # of a Gaussian's height: it is cut there, or at the radius of the original where that is less
COLOUR_POWER, BEND, BENT = 0.7, 0.4, 0.95  # q_c; at p_c of the greatest colour difference the scale reaches p_t
DETECTOR, FEATURE_POWER = 0.082, 0.5  # w, the width of edge and point detectors in degrees, and q_f

RGB_TO_XYZ = np.array(
    [
        [10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
        [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
        [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382],
    ]
)
RGB_TO_WHITE = RGB_TO_XYZ / RGB_TO_XYZ.sum(axis=1, keepdims=True)  # X, Y and Z as shares of D65's
WHITE_TO_OPPONENT = np.array([[0.0, 1, 0], [1, -1, 0], [0, 1, -1]])  # YyCxCz without its factors, which cancel
KNEE = (6 / 29) ** 3  # below it CIELAB's cube root is continued by its tangent

Plane = NDArray[np.float32]
Kernel = NDArray[np.float32]


def flip(drawn: Picture, photograph: Picture, covered: NDArray[np.bool_] | None = None) -> float | None:
    """The mean of `flip_map` over the covered pixels, (H, W) bool; over all without it.

    Uncovered pixels of the drawn picture are replaced by the photograph's first, so that the filters see no edge
    there, as in masked SSIM. None where no pixel is covered.
    """
    a, b = _pair(drawn, photograph)
    if covered is None:
        return float(flip_map(a, b).mean(dtype=np.float64))
    rows, columns = extent(covered)
    if rows.start == rows.stop:
        return None
    a = np.where(covered[..., None], a, b)
    part = _mapped(a, b, rows, columns)
    return float(part[covered[rows, columns]].mean(dtype=np.float64))


def flip_map(drawn: Picture, photograph: Picture) -> Plane:
    """(H, W) float32, 0..1: the FLIP difference of each pixel. Past its border a picture is continued by its edge."""
    a, b = _pair(drawn, photograph)
    return _mapped(a, b, slice(0, a.shape[0]), slice(0, a.shape[1]))


def _pair(drawn: Picture, photograph: Picture) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    assert drawn.shape == photograph.shape and drawn.shape[2:] == (3,), (drawn.shape, photograph.shape)
    return to_codes(drawn), to_codes(photograph)


def _mapped(a: NDArray[np.uint8], b: NDArray[np.uint8], rows: slice, columns: slice) -> Plane:
    """The map at the given rows and columns, a band at a time, each with the margin that its filters reach into."""
    height, width = a.shape[:2]
    made = np.empty((rows.stop - rows.start, columns.stop - columns.start), np.float32)
    left, right = max(columns.start - MARGIN, 0), min(columns.stop + MARGIN, width)
    for start, stop in pieces(len(made), BAND):
        first, last = rows.start + start, rows.start + stop
        top, bottom = max(first - MARGIN, 0), min(last + MARGIN, height)
        part = _difference(a[top:bottom, left:right], b[top:bottom, left:right])
        made[start:stop] = part[first - top : last - top, columns.start - left : columns.stop - left]
    return made


def _difference(a: NDArray[np.uint8], b: NDArray[np.uint8]) -> Plane:
    """Equation 9: the colour difference to the power of one less the feature difference."""
    opponents = [_opponent(codes) for codes in (a, b)]
    colour = _colour_difference(*(_seen(opponent) for opponent in opponents))
    feature = _feature_difference(*(_features(opponent[0]) for opponent in opponents))
    return np.power(colour, np.subtract(np.float32(1), feature, out=feature), out=colour)


def _opponent(codes: NDArray[np.uint8]) -> list[Plane]:
    """Y, X - Y and Y - Z of 8-bit sRGB, each as a share of white's: the linear axes of luminance, red-green and
    blue-yellow."""
    planes = cv2.transform(cv2.LUT(codes, LINEAR), (WHITE_TO_OPPONENT @ RGB_TO_WHITE).astype(np.float32))
    return [np.asarray(plane, np.float32) for plane in cv2.split(planes)]


def _seen(opponent: list[Plane]) -> list[Plane]:
    """L*, a* and b* of what the eye makes of a picture at this distance, a* and b* lessened where it is dark (Hunt)."""
    luminance = _filtered(opponent[0], SMOOTH_LUMINANCE)
    x = _filtered(opponent[1], SMOOTH_RED_GREEN) + luminance
    z = luminance - _filtered(opponent[2], SMOOTH_BLUE_YELLOW)
    linear = cv2.transform(cv2.merge([x, luminance, z]), np.linalg.inv(RGB_TO_WHITE).astype(np.float32))
    np.clip(linear, 0, 1, out=linear)
    return _hunt_lab(np.asarray(cv2.transform(linear, RGB_TO_WHITE.astype(np.float32)), np.float32))


def _hunt_lab(white: NDArray[np.float32]) -> list[Plane]:
    """CIELAB of (H, W, 3) X, Y, Z as shares of white's, which are overwritten, with a* and b* times L* / 100."""
    root = np.asarray(cv2.pow(np.maximum(white, np.float32(KNEE)), 1 / 3), np.float32)
    white -= np.float32(KNEE)
    root += np.minimum(white, 0, out=white) * np.float32(KNEE ** (-2 / 3) / 3)
    x, y, z = (np.asarray(plane, np.float32) for plane in cv2.split(root))
    lightness = 116 * y - 16
    return [lightness, (x - y) * (5 * lightness), (y - z) * (2 * lightness)]


def _colour_difference(a: list[Plane], b: list[Plane]) -> Plane:
    """HyAB, a city-block step in lightness and a straight one in colour, to the power q_c and scaled to 0..1: most of
    the scale is for small differences."""
    difference = _hyab(a, b)
    difference = np.asarray(cv2.pow(difference, COLOUR_POWER), np.float32)
    bend = BEND * GREATEST
    above = difference * np.float32((1 - BENT) / (GREATEST - bend))
    above += np.float32(BENT - bend * (1 - BENT) / (GREATEST - bend))
    difference *= np.float32(BENT / bend)
    return np.minimum(difference, above, out=difference)  # the steeper line up to where they cross


def _hyab(a: list[Plane], b: list[Plane]) -> Plane:
    lightness, red_green, blue_yellow = (x - y for x, y in zip(a, b, strict=True))
    return np.abs(lightness) + _length(red_green, blue_yellow)


def _features(luminance: Plane) -> list[Plane]:
    """Strength of edges and of points (or lines) at each pixel, 0..1."""
    strengths = []
    for kernel in (EDGE, POINT):
        across = cv2.sepFilter2D(luminance, cv2.CV_32F, kernel, DETECTOR_SMOOTH, borderType=cv2.BORDER_REPLICATE)
        down = cv2.sepFilter2D(luminance, cv2.CV_32F, DETECTOR_SMOOTH, kernel, borderType=cv2.BORDER_REPLICATE)
        strengths.append(_length(np.asarray(across, np.float32), np.asarray(down, np.float32)))
    return strengths


def _feature_difference(a: list[Plane], b: list[Plane]) -> Plane:
    """Equation 8: the greater of the two differences in strength, over √2, to the power q_f, which is a root."""
    assert FEATURE_POWER == 0.5
    edge, point = (cv2.absdiff(x, y) for x, y in zip(a, b, strict=True))
    return np.asarray(cv2.sqrt(cv2.max(edge, point) * np.float32(math.sqrt(0.5))), np.float32)


def _length(x: Plane, y: Plane) -> Plane:
    """√(x² + y²), the same wherever its memory lies; cv2.magnitude rounds by that."""
    return np.sqrt(x * x + y * y)


def _filtered(plane: Plane, gaussians: list[tuple[float, Kernel]]) -> Plane:
    parts = [
        share * cv2.sepFilter2D(plane, cv2.CV_32F, kernel, kernel, borderType=cv2.BORDER_REPLICATE)
        for share, kernel in gaussians
    ]
    return np.asarray(sum(parts[1:], parts[0]), np.float32)


def _gaussians(terms: tuple[tuple[float, float], ...], radius: int) -> list[tuple[float, Kernel]]:
    """Each Gaussian of a contrast filter as a kernel of sum 1 and its share of the whole, on pixels up to `radius`."""
    made = []
    for a, b in terms:
        degrees = np.arange(-radius, radius + 1) / PIXELS_PER_DEGREE
        shape = np.exp(-((np.pi * degrees) ** 2) / b)
        volume = a * math.sqrt(math.pi / b) * shape.sum() ** 2
        kept = shape[shape > NEGLIGIBLE]
        made.append((volume, (kept / kept.sum()).astype(np.float32)))
    whole = sum(volume for volume, _ in made)
    return [(volume / whole, kernel) for volume, kernel in made]


def _detectors() -> tuple[Kernel, Kernel, Kernel]:
    """A Gaussian of sum 1, and its first and second derivative, positive and negative values of sum 1 each."""
    sigma = 0.5 * DETECTOR * PIXELS_PER_DEGREE
    radius = math.ceil(3 * sigma)
    x = np.arange(-radius, radius + 1)
    shape = np.exp(-(x**2) / (2 * sigma**2))
    made = [shape / shape.sum()]
    for derivative in (-x * shape, (x**2 / sigma**2 - 1) * shape):
        up, down = np.maximum(derivative, 0), np.minimum(derivative, 0)
        made.append(up / up.sum() - down / down.sum())
    smooth, edge, point = (kernel.astype(np.float32) for kernel in made)
    return smooth, edge, point


def _linear_codes() -> NDArray[np.float32]:
    """(1, 256): linear light of each 8-bit sRGB code."""
    return linear_of_srgb(np.arange(256) / 255).astype(np.float32)[None]


def _greatest() -> float:
    """The greatest colour difference there is, of pure green and pure blue, to the power q_c."""
    green, blue = (_hunt_lab((RGB_TO_WHITE @ axis)[None, None].astype(np.float32)) for axis in np.eye(3)[1:])
    return float(_hyab(green, blue).item() ** COLOUR_POWER)


RADIUS = math.ceil(3 * PIXELS_PER_DEGREE * math.sqrt(BLUE_YELLOW[0][1] / (2 * math.pi**2)))
SMOOTH_LUMINANCE, SMOOTH_RED_GREEN, SMOOTH_BLUE_YELLOW = (
    _gaussians(terms, RADIUS) for terms in (LUMINANCE, RED_GREEN, BLUE_YELLOW)
)
DETECTOR_SMOOTH, EDGE, POINT = _detectors()
MARGIN = max(RADIUS, len(DETECTOR_SMOOTH) // 2)
LINEAR = _linear_codes()
GREATEST = _greatest()
