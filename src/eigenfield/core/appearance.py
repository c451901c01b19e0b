"""The appearance of a scene in each of its observations: means, eigen textures, weights (equations 3 to 8)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.brief import brief_repr

COLOUR_STEP = 2.0**-10  # of the gains and offsets that a file keeps of colours that are mixed


@dataclass(frozen=True, eq=False)
class Basis:
    """N eigen textures and the weights of each observation.

    Attributes:
        textures: (N, H, W, C), float32 values as `encode` makes them, or uint8 or uint16 codes as a file keeps them.
        scale: (N, C) float32: value = (stored - zero) * scale; ones for float textures.
        zero: (N, C) float32; zeros for float textures.
        weights: (No, N) float32, the paper's ω(c, j), a row for each observation, in the order of `Scene.rows`.
        grid: (rows, columns) of the whole atlas at this basis's density; None: the textures are all of it.
        corner: Row and column of the grid at which the textures begin; they are zero elsewhere.
    """

    textures: NDArray[Any]
    scale: NDArray[np.float32]
    zero: NDArray[np.float32]
    weights: NDArray[np.float32]
    grid: tuple[int, int] | None = None
    corner: tuple[int, int] = (0, 0)

    __repr__ = brief_repr

    @property
    def count(self) -> int:
        """Number of eigen textures."""
        return int(self.textures.shape[0])

    @property
    def size(self) -> tuple[int, int]:
        """(rows, columns) of the whole atlas at this basis's density."""
        rows, columns = self.textures.shape[1:3]
        return self.grid or (int(rows), int(columns))

    def values(self, first: int = 0, last: int | None = None) -> NDArray[np.float32]:
        """(n, H, W, C) float32: the textures [first, last) as numbers."""
        part = slice(first, last)
        stored = self.textures[part].astype(np.float32)
        return (stored - self.zero[part, None, None]) * self.scale[part, None, None]

    def truncate(self, count: int) -> Basis:
        """The first `count` components."""
        parts = (self.textures[:count], self.scale[:count], self.zero[:count], self.weights[:, :count])
        return Basis(*parts, self.grid, self.corner)


@dataclass(frozen=True, eq=False)
class Plane:
    """Channels that share a mean and bases, which may have densities of their own.

    Attributes:
        mean: (H, W, C) float32 in 0..1 (of other attributes than colours: any range).
        bases: Summed onto the mean one after the other.
    """

    mean: NDArray[np.float32]
    bases: tuple[Basis, ...]

    __repr__ = brief_repr

    @property
    def sizes(self) -> list[tuple[int, int]]:
        """(rows, columns) of the mean's atlas, then of each basis's."""
        return [(int(self.mean.shape[0]), int(self.mean.shape[1])), *(basis.size for basis in self.bases)]


@dataclass(frozen=True, eq=False)
class Appearance:
    """Everything that is drawn on the proxy.

    Attributes:
        planes: One plane of three channels (R, G, B), or planes that `to_rgb` joins; any channels of other attributes.
        to_rgb: (3, K) float32, R, G and B from the K channels of all planes one after the other; None: the channels
            are drawn as they are.
        colours: (Nc, 2, 3) float32 gains and offsets of R, G, B, or None: each camera's map became gain * map + offset,
            so its own view is (drawn - offset) / gain. Gain 1 and offset 0 for held-out cameras.
        mixed_colours: Whether a view between cameras has their exposures by its view weights, and not the common one.
    """

    planes: tuple[Plane, ...]
    to_rgb: NDArray[np.float32] | None = None
    colours: NDArray[np.float32] | None = None
    mixed_colours: bool = True

    __repr__ = brief_repr

    @property
    def atlas(self) -> tuple[int, int]:
        """(rows, columns) of the texture that is composed and drawn: the most that any mean or basis has."""
        sizes = [size for plane in self.planes for size in plane.sizes]
        return max(rows for rows, _ in sizes), max(columns for _, columns in sizes)

    @property
    def channels(self) -> int:
        """Channels of a drawn picture."""
        return 3 if self.to_rgb is not None else sum(int(plane.mean.shape[2]) for plane in self.planes)

    @property
    def channel_slices(self) -> list[slice]:
        """Where each plane's channels lie among those of all planes."""
        return [
            slice(*ends) for ends in pairwise(accumulate((plane.mean.shape[2] for plane in self.planes), initial=0))
        ]

    @property
    def textures(self) -> int:
        """Number of eigen textures: of the basis that has most. Drawing with so many draws with all."""
        return max((basis.count for plane in self.planes for basis in plane.bases), default=0)
