"""Means and eigen textures of a group as films: their scales, their codes, and what decoders make of them.

A frame of AV1 has one quantiser. Each plane has a step of its own, in the photographs' range, so that the scale of its
codes is chosen to make that step the same number of codes for all. The film takes the most codes a step at which the
strongest texture still fits into 10 bits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import crf_of, encoder_step
from eigenfield.coding.video.film import decode_film, encode_film
from eigenfield.coding.video.film_layout import film_parts, join_parts, pictures_of
from eigenfield.core.films import FilmLayout
from eigenfield.core.payloads import Affine
from eigenfield.encoding.clip.frames import load_arrays, save_arrays
from eigenfield.encoding.fitted.code_planes import CODE_MIN_UNIT, ZERO_CODE

LEAST_CODE, MOST_CODE = 64, 940  # others are lost in browsers that take a film for video of limited range: Firefox 153
FILM_PRESET = 4  # of SVT-AV1, as for stills
COARSEST_CRF = 63  # what is to be coarser has coarser codes
# Of the quantiser steps that films are asked for, to those of pictures, in groups of SETTLED_FRAMES and more
MEAN_STEP_RATIOS = 2.0, 3.0  # of luma and of chroma
TEXTURE_STEP_RATIO = 4.0
SETTLED_FRAMES = 8


@dataclass(frozen=True, eq=False)
class FilmScale:
    """From codes to numbers, and how coarsely the film is coded.

    Attributes:
        units: What a code stands for, of each plane.
        zeros: The code of 0, of each plane.
        limits: The least and the greatest code.
    """

    crf: int
    units: tuple[float, ...]
    zeros: tuple[int, ...]
    limits: tuple[int, int] = LEAST_CODE, MOST_CODE

    def codes(self, values: NDArray[np.float32], plane: int) -> NDArray[np.uint16]:
        """Of numbers of a plane."""
        codes = np.rint(values / np.float32(self.units[plane]) + self.zeros[plane])
        return np.asarray(codes.clip(*self.limits), np.uint16)

    def values(self, codes: NDArray[np.uint16], plane: int) -> NDArray[np.float32]:
        """As decoders compute them."""
        return ((codes - float(self.zeros[plane])) * self.units[plane]).astype(np.float32)

    def affine(self, plane: int, count: int) -> Affine:
        """As a file has it, alike for `count` channels."""
        return Affine(np.full(count, self.units[plane]), np.full(count, float(self.zeros[plane])))


def film_scale(steps: Sequence[float], ranges: Sequence[tuple[float, float]], signed: Sequence[bool]) -> FilmScale:
    """The scale of a film.

    Args:
        steps: Of the quantiser that each plane wants.
        ranges: The least and the greatest number of each plane, in all frames.
        signed: Whether numbers of a plane lie to both sides of 0, which then is ZERO_CODE; else it is LEAST_CODE.
    """
    least = [
        max(CODE_MIN_UNIT, -low / (ZERO_CODE - LEAST_CODE), high / (MOST_CODE - ZERO_CODE))
        if both
        else min(max(high, 1e-3), 1.0) / (MOST_CODE - LEAST_CODE)
        for (low, high), both in zip(ranges, signed, strict=True)
    ]
    fitting = (step / unit for step, unit in zip(steps, least, strict=True))
    codes = min(encoder_step(COARSEST_CRF), *fitting)
    units = tuple(math.ceil(step / codes * 1e6) / 1e6 for step in steps)
    return FilmScale(crf_of(codes), units, tuple(ZERO_CODE if both else LEAST_CODE for both in signed))


def film_step(step: float, ratio: float, frames: int) -> float:
    """The quantiser step that a film of so many frames is asked for, by a picture's.

    What stays from frame to frame is coded more finely than was asked for, since each later frame gains by it, and
    later means make up for what textures lose. A film of one frame is a picture.
    """
    return float(step * ratio ** min(1.0, math.log2(frames) / math.log2(SETTLED_FRAMES)))


def range_of(arrays: Iterable[NDArray[np.float32]]) -> tuple[float, float]:
    """The least and the greatest number of all frames."""
    low, high = 0.0, 0.0
    for values in arrays:
        low, high = min(low, float(values.min(initial=0.0))), max(high, float(values.max(initial=0.0)))
    return low, high


@dataclass(frozen=True, eq=False)
class CodedFilm:
    """A film of a group.

    Attributes:
        number: Of the film in the layout.
        units: The temporal unit of each frame.
    """

    layout: FilmLayout
    number: int
    scale: FilmScale
    units: tuple[bytes, ...]

    def decoded(self) -> Iterator[list[NDArray[np.float32]]]:
        """Of each frame the pictures of each plane, (n, rows, columns), as decoders have them."""
        parts = film_parts(self.layout, self.number)
        for frame in decode_film(self.units, self.layout.sizes[self.number], "film"):
            yield [self.scale.values(pictures_of(part, frame), plane) for plane, part in enumerate(parts)]


def code_film(
    layout: FilmLayout,
    number: int,
    scale: FilmScale,
    frames: Iterable[Sequence[NDArray[np.float32]]],
    kept: Callable[[Callable[[Path], None]], Path],
) -> CodedFilm:
    """A film of a group, coded.

    Args:
        number: Of the film in the layout.
        frames: Of each frame the pictures of each plane, (n, rows, columns).
        kept: Makes a finished stage by a function that writes its files, or finds it.
    """

    def joined() -> Iterator[NDArray[np.uint16]]:
        for planes in frames:
            yield join_parts(layout, number, [scale.codes(one, plane) for plane, one in enumerate(planes)])

    def write(folder: Path) -> None:
        units = encode_film(joined(), layout.sizes[number], scale.crf, FILM_PRESET)
        save_arrays(folder, {str(at): np.frombuffer(unit, np.uint8) for at, unit in enumerate(units)})

    arrays = load_arrays(kept(write))
    return CodedFilm(layout, number, scale, tuple(arrays[str(at)].tobytes() for at in range(len(arrays))))
