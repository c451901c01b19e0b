"""How the textures of a clip lie in films, and a group of frames as it is coded.

A film is a grey video in which each texture has a rectangle of its own. Means are one film, eigen textures another and
the opacity of sheets a third, since each is coded at its own turn.
"""

from __future__ import annotations

from dataclasses import dataclass

from eigenfield.core.brief import brief_repr
from eigenfield.core.payloads import Affine, Payload

Size = tuple[int, int]  # rows, columns


@dataclass(frozen=True)
class FilmPart:
    """Where pictures of one size lie in a film.

    Attributes:
        size: (rows, columns) of each.
        film: The number of the film.
        at: (row, column) of the top left texel of each, multiples of 16: every channel of a texture, then those of the
            next texture by rank.
    """

    size: Size
    film: int
    at: tuple[Size, ...]


@dataclass(frozen=True)
class FilmPlane:
    """Where the textures of a plane lie.

    Attributes:
        mean: A place for each of the plane's channels.
        bases: Of each basis, channels times textures.
    """

    mean: FilmPart
    bases: tuple[FilmPart, ...]

    @property
    def channels(self) -> int:
        """Of the plane."""
        return len(self.mean.at)


@dataclass(frozen=True)
class FilmLayout:
    """The films of a clip, which are the same in all groups.

    Attributes:
        sizes: (rows, columns) of each film, multiples of 64.
        planes: As in `Appearance`.
        opacity: Where that of sheets lies, at a single place; None: the proxy is one opaque surface.
    """

    sizes: tuple[Size, ...]
    planes: tuple[FilmPlane, ...]
    opacity: FilmPart | None = None


@dataclass(frozen=True, eq=False)
class CodedGroup:
    """A group of frames as a file has it.

    Attributes:
        weights: Of each basis of each plane.
        means: Of each plane, from codes to numbers for each channel.
        bases: Of each basis of each plane, likewise for each channel of each texture.
        units: For each frame the temporal unit of each film; the first of a film is a key picture.
        motion: Where the mesh's vertices are in each frame; None: where the mesh has them.
    """

    weights: tuple[tuple[Payload, ...], ...]
    means: tuple[Affine, ...]
    bases: tuple[tuple[Affine, ...], ...]
    units: tuple[tuple[bytes, ...], ...]
    motion: Payload | None = None

    __repr__ = brief_repr
