"""The textures, laid out for summing: a tile's components side by side.

Equation 8 reads every eigen texture once a frame, 120 MB for 40 of them at 1024 x 1024, and does two operations a
byte: it is bound by memory. Component after component, the sum itself would travel as often as the textures, at four
times their size. Tile by tile it stays in the first cache, and tiles that the view does not show are not read at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.errors import FormatError
from eigenfield.parallel import parallel_map, pieces
from eigenfield.rendering.kernels import AREA, TILE, compose_tiles
from eigenfield.scene import Plane

AT_ONCE = 64  # tiles that a thread composes at a time


@dataclass(frozen=True, eq=False)
class TiledPlane:
    """A plane's mean and bases by tile.

    mean: (tiles, C, AREA) float32. codes: (tiles, C, N, AREA), uint8 as stored or float32, all bases one after the
    other. scale, zero: (N, C) float64. weights: (Ne, N) float64. places: (tiles, 2) int32 rows and columns of tiles.
    """

    mean: NDArray[np.float32]
    codes: NDArray[np.uint8] | NDArray[np.float32]
    scale: NDArray[np.float64]
    zero: NDArray[np.float64]
    weights: NDArray[np.float64]
    places: NDArray[np.int32]

    @property
    def channels(self) -> int:
        return int(self.mean.shape[1])


def tile_plane(plane: Plane, used: NDArray[np.bool_]) -> TiledPlane:
    """Lay out a plane's textures; `used` (tile rows, tile columns) are the tiles kept.

    Raises FormatError `unsupported-layout` if a basis has another size or other channels than the mean.
    """
    height, width, channels = plane.mean.shape
    for number, basis in enumerate(plane.bases):
        if basis.textures.shape[1:] != (height, width, channels):
            theirs = "x".join(str(n) for n in basis.textures.shape[1:])
            raise FormatError(
                "unsupported-layout",
                f"eigen textures of {theirs} on a mean of {height}x{width}x{channels} cannot be drawn yet",
                where=f"basis {number}",
                remedy="encode with mean and eigen textures of one size",
            )
    places = np.argwhere(used).astype(np.int32)
    count = sum(basis.count for basis in plane.bases)
    coded = all(basis.textures.dtype == np.uint8 for basis in plane.bases)
    codes: NDArray[np.uint8] | NDArray[np.float32] = np.empty(
        (len(places), channels, count, AREA), np.uint8 if coded else np.float32
    )
    jobs = [(texture, j) for j, texture in enumerate(t for basis in plane.bases for t in basis.textures)]
    parallel_map(lambda job: _cut(job[0], places, codes[:, :, job[1]]), jobs)
    mean = np.empty((len(places), channels, AREA), np.float32)
    _cut(plane.mean, places, mean)
    none = np.zeros((0, channels))
    return TiledPlane(
        mean,
        codes,
        np.concatenate([none, *(basis.scale.astype(np.float64) for basis in plane.bases)]),
        np.concatenate([none, *(basis.zero.astype(np.float64) for basis in plane.bases)]),
        np.concatenate([basis.weights.astype(np.float64) for basis in plane.bases], axis=1)
        if plane.bases
        else np.zeros((0, 0)),
        places,
    )


def _cut(texture: NDArray[np.generic], places: NDArray[np.int32], out: NDArray[np.generic]) -> None:
    """(H, W, C) into out (tiles, C, AREA); what a tile has beyond the border is repeated and never drawn."""
    height, width, channels = texture.shape
    padded = np.pad(texture, ((0, -height % TILE), (0, -width % TILE), (0, 0)), mode="edge")
    tiled = padded.reshape(-(-height // TILE), TILE, -(-width // TILE), TILE, channels).transpose(0, 2, 4, 1, 3)
    out[...] = tiled[places[:, 0], places[:, 1]].reshape(len(places), channels, AREA)


def compose(
    plane: TiledPlane, omega: NDArray[np.float64], tiles: NDArray[np.int64], texture: NDArray[np.float32], at: int
) -> None:
    """Equation 8: mean + sum of omega (n,) times the first n components, for `tiles` (indices into `places`), into
    texture (H, W, >= at + C) from channel `at` on."""
    count = len(omega)
    coefficients = omega[:, None] * plane.scale[:count]
    offset = -(coefficients * plane.zero[:count]).sum(axis=0)
    chosen = np.flatnonzero(coefficients.any(axis=1))
    rounded, start = coefficients.astype(np.float32), offset.astype(np.float32)
    parallel_map(
        lambda part: compose_tiles(
            tiles[part[0] : part[1]], plane.places, plane.mean, plane.codes, chosen, rounded, start, at, texture
        ),
        pieces(len(tiles), AT_ONCE),
    )
