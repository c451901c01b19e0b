"""Where textures lie in films: a place for each channel of each texture, and the way into a film and out of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.core.errors import OptionError
from eigenfield.core.films import FilmLayout, FilmPart, FilmPlane, Size

PLACE_STEP = 16  # texels of which a place is a multiple
SIDE_STEP = 64  # of a film's sides: no decoder has hidden rows or columns then
EMPTY_CODE = 341  # where no texture lies: zero of textures, and 85 of 255 exactly
MEANS, TEXTURES = 0, 1  # numbers of films
_PREFERRED = 1152, 2048  # rows and columns that every hardware decoder of AV1 takes (level 4.0)


@dataclass(frozen=True)
class PlaneSizes:
    """The sizes of a plane's textures.

    Attributes:
        bases: The size of the textures of each basis, and how many there are, at least 1.
    """

    channels: int
    mean: Size
    bases: tuple[tuple[Size, int], ...]


def film_layout(planes: Sequence[PlaneSizes], opacity: Size | None = None) -> FilmLayout:
    """A film of all means, one of all eigen textures where there are any, and last one of the opacity of sheets.

    Args:
        opacity: Its size; None: there are no sheets.

    Raises:
        OptionError: `film-size`: a film would be larger than readers take.
    """
    means = [(plane.mean, plane.channels) for plane in planes]
    textures = [(size, plane.channels * count) for plane in planes for size, count in plane.bases]
    films = [_pack(group) for group in (means, textures) if group]
    mean_places, texture_places = (iter(places) for _, places in [*films, ((0, 0), [])][:2])
    made = []
    for plane in planes:
        bases = tuple(FilmPart(size, TEXTURES, next(texture_places)) for size, _ in plane.bases)
        made.append(FilmPlane(FilmPart(plane.mean, MEANS, next(mean_places)), bases))
    alone = None
    if opacity is not None:
        films.append(_pack([(opacity, 1)]))
        alone = FilmPart(opacity, len(films) - 1, films[-1][1][0])
    return FilmLayout(tuple(size for size, _ in films), tuple(made), alone)


def film_parts(layout: FilmLayout, film: int) -> list[FilmPart]:
    """The parts of a film: of each plane its mean, then its bases; last the opacity."""
    parts = [part for plane in layout.planes for part in (plane.mean, *plane.bases)]
    return [part for part in (*parts, layout.opacity) if part is not None and part.film == film]


def join_parts(layout: FilmLayout, film: int, codes: Sequence[NDArray[np.uint16]]) -> NDArray[np.uint16]:
    """(rows, columns): a frame of a film.

    Args:
        codes: For each of `film_parts` its pictures (n, rows, columns), as many as it has places.
    """
    made = np.full(layout.sizes[film], EMPTY_CODE, np.uint16)
    for part, pictures in zip(film_parts(layout, film), codes, strict=True):
        rows, columns = map(_place_side, part.size)
        margin = ((0, 0), (0, rows - part.size[0]), (0, columns - part.size[1]))
        padded = np.pad(pictures, margin, "edge")  # a step at the edge would cost bytes
        for (row, column), picture in zip(part.at, padded, strict=True):
            made[row : row + rows, column : column + columns] = picture
    return made


def pictures_of(part: FilmPart, frame: NDArray[np.uint16]) -> NDArray[np.uint16]:
    """(n, rows, columns) of a part of a film's frame, one for each of its places."""
    rows, columns = part.size
    return np.stack([frame[row : row + rows, column : column + columns] for row, column in part.at])


def _place_side(side: int) -> int:
    return -(-side // PLACE_STEP) * PLACE_STEP


def _pack(groups: Sequence[tuple[Size, int]]) -> tuple[Size, list[tuple[Size, ...]]]:
    """The size of a film of so many pictures of each size, and their places."""
    sides = [(_place_side(rows), _place_side(columns)) for (rows, columns), count in groups for _ in range(count)]
    narrowest = -(-max(columns for _, columns in sides) // SIDE_STEP) * SIDE_STEP
    tried = [_shelves(sides, width) for width in range(narrowest, limits.MAX_FILM_SIDE + 1, SIDE_STEP)]
    fit = [one for one in tried if max(one[0]) <= limits.MAX_FILM_SIDE and _texels(one[0]) <= limits.MAX_FILM_PIXELS]
    if not fit:
        message = f"a film of {len(sides)} pictures of up to {sides[0][1]}x{sides[0][0]} is larger than readers take"
        raise OptionError("film-size", message, remedy="use fewer textures or a smaller atlas")
    size, places = min(fit, key=_badness)
    found = iter(places)
    return size, [tuple(next(found) for _ in range(count)) for _, count in groups]


def _texels(size: Size) -> int:
    return size[0] * size[1]


def _badness(one: tuple[Size, list[Size]]) -> tuple[bool, int, int]:
    """First whether it is beyond what hardware takes, then its texels, then how high it is."""
    rows, columns = one[0]
    return rows > _PREFERRED[0] or columns > _PREFERRED[1], _texels(one[0]), rows


def _shelves(sides: Sequence[Size], width: int) -> tuple[Size, list[Size]]:
    """Size and places in a film of a width: shelf below shelf, the highest pictures first, and below a picture what
    has room on its shelf."""
    places: list[Size] = [(0, 0)] * len(sides)
    top = bottom = left = right = below = 0  # of the shelf; of its last column, and where that has room
    for index in sorted(range(len(sides)), key=lambda index: sides[index], reverse=True):
        rows, columns = sides[index]
        if below + rows > bottom or left + columns > right:
            if right + columns > width or not bottom:
                top, bottom, right = bottom, bottom + rows, 0
            left, right, below = right, right + columns, top
        places[index] = below, left
        below += rows
    return (-(-bottom // SIDE_STEP) * SIDE_STEP, width), places
