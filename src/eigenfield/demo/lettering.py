"""The letters in the demo's scene, filled from the outlines of matplotlib's font."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class PosterSheet(NamedTuple):
    """A rectangle on the wall, in world units.

    Attributes:
        left: x of the left border.
        top: y of the top border.
        width: To the right.
        height: Downwards.
    """

    left: float
    top: float
    width: float
    height: float


POSTER = PosterSheet(-1.19, 1.56, 0.82, 0.90)
POSTER_DOTS_PER_WIDTH = 640  # raster of the poster
BLOCK_LETTERS = ("V", "W", "E")  # on the sides across the block's x, y and z
POSTER_LINES = (  # text, cap height and baseline, in sheet widths
    ("E I G E N", 0.125, 0.235), ("F I E L D", 0.125, 0.400), ("nine by nine views", 0.034, 0.475),
    ("of a jar, glass, chrome, an orange and a block", 0.030, 0.530),
    ("T = mean + w1 E1 + w2 E2 + w3 E3 + w4 E4", 0.028, 0.640),
    ("L I G H T", 0.085, 0.785), ("THE  SMALL  PRINT  IS  A  FEW  PIXELS  HIGH", 0.024, 0.850),
    ("each ray that leaves a thing is kept; what they have in", 0.019, 0.900),
    ("common is the mean, what differs is an eigen texture", 0.019, 0.935),
    ("a b c d e f g h i j k l m n o p q r s t u v w x y z", 0.016, 0.975),
    ("0 1 2 3 4 5 6 7 8 9  +  -  =  ( )  [ ]  { }  %  &  #  ?", 0.014, 1.010),
    ("A B C D E F G H I J K L M N O P Q R S T U V W X Y Z", 0.012, 1.040),
)  # fmt: skip
POSTER_RULES = ((0.05, 0.555), (0.05, 0.675))  # margins and levels of ruled lines
POSTER_RED_LINES = (5,)


@cache
def _draw_poster() -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    ratio = POSTER.height / POSTER.width
    ink, red = (
        np.zeros((4 * round(POSTER_DOTS_PER_WIDTH * ratio), 4 * POSTER_DOTS_PER_WIDTH), np.uint8) for _ in range(2)
    )
    for k, (text, capital, baseline) in enumerate(POSTER_LINES):
        scale = capital / _outline_points("H").max(axis=0)[1]
        x = _outline_points(text)[:, 0]
        wide = float(x.max() - x.min()) * scale
        if wide > 0.9:  # too long: smaller letters
            scale *= 0.9 / wide
            wide = 0.9
        start = 0.5 - wide / 2 - float(x.min()) * scale
        _fill_outlines(
            red if k in POSTER_RED_LINES else ink,
            text,
            scale * POSTER_DOTS_PER_WIDTH,
            (start * POSTER_DOTS_PER_WIDTH, baseline * POSTER_DOTS_PER_WIDTH),
        )
    for margin, level in POSTER_RULES:
        row, column = round(4 * level * POSTER_DOTS_PER_WIDTH), round(4 * margin * POSTER_DOTS_PER_WIDTH)
        ink[row : row + 9, column:-column] = 255
    return _downsample(ink), _downsample(red)


def poster_mask(u: Array, v: Array) -> tuple[Array, Array]:
    """(n,) black and red ink, 0..1.

    Args:
        u: (n,) sheet coordinates to the right, 0..1.
        v: (n,) sheet coordinates downwards, 0..1.
    """
    ink, red = _draw_poster()
    return _sample_bilinear(ink, u, v), _sample_bilinear(red, u, v)


@cache
def _draw_letter(letter: str) -> NDArray[np.float32]:
    side = 256
    picture = np.zeros((4 * side, 4 * side), np.uint8)
    outline = _outline_points(letter)
    low, high = outline.min(axis=0), outline.max(axis=0)
    scale = 0.52 * side / float((high - low).max())
    middle = (low + high) / 2 * scale
    _fill_outlines(picture, letter, scale, (side / 2 - float(middle[0]), side / 2 + float(middle[1])))
    return _downsample(picture)


def letter_mask(letter: str, u: Array, v: Array) -> Array:
    """(n,) ink of a letter in the middle of a square, 0..1.

    Args:
        u: (n,) coordinates to the right, 0..1.
        v: (n,) coordinates downwards, 0..1.
    """
    return _sample_bilinear(_draw_letter(letter), u, v)


def _text_polygons(text: str) -> list[NDArray[np.float64]]:
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    font = FontProperties(family="DejaVu Serif", weight="bold")
    return [p for p in map(np.asarray, TextPath((0, 0), text, size=100, prop=font).to_polygons()) if len(p) > 2]


def _outline_points(text: str) -> NDArray[np.float64]:
    return np.concatenate(_text_polygons(text))


def _fill_outlines(fine: NDArray[np.uint8], text: str, scale: float, origin: tuple[float, float]) -> None:
    """Fill a text's outlines (even-odd) on a raster four times as fine as the coordinates."""
    import cv2

    polygons = [
        np.round(4 * (np.array(origin) + polygon * (scale, -scale))).astype(np.int32)
        for polygon in _text_polygons(text)
    ]
    cv2.fillPoly(fine, polygons, 255)


def _downsample(fine: NDArray[np.uint8]) -> NDArray[np.float32]:
    height, width = fine.shape[0] // 4, fine.shape[1] // 4
    return (fine.reshape(height, 4, width, 4).mean(axis=(1, 3)) / 255).astype(np.float32)


def _sample_bilinear(picture: NDArray[np.float32], u: Array, v: Array) -> Array:
    """Bilinear interpolation; 0 outside."""
    height, width = picture.shape
    inside = (u > 0) & (u < 1) & (v > 0) & (v < 1)
    x = np.clip(u * width - 0.5, 0, width - 1.001)
    y = np.clip(v * height - 0.5, 0, height - 1.001)
    i, j = y.astype(np.int64), x.astype(np.int64)
    a, b = x - j, y - i
    top = picture[i, j] * (1 - a) + picture[i, j + 1] * a
    bottom = picture[i + 1, j] * (1 - a) + picture[i + 1, j + 1] * a
    return np.asarray(np.where(inside, top * (1 - b) + bottom * b, 0.0))
