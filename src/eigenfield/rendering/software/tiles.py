"""The textures, laid out for summing: a tile's components side by side.

Equation 8 reads every eigen texture once a frame, 120 MB for 40 of them at 1024 x 1024, and does two operations a
byte: it is bound by memory. Component after component, the sum itself would travel as often as the textures, at four
times their size. Tile by tile it stays in the first cache, and tiles that the view does not show are not read at all.

Tried, ms of one thread for 40 x 1024 x 1024 x 3 (reading alone: 3.7): components in rows of a tile 6.1, groups of four
in blocks of 16 texels 5.1; and written out as (H, W, 4) 10.6, as tiles 6.2: the rows of a tile lie 16 kB apart.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Basis
from eigenfield.rendering.software.kernels import CODE_LANES, LAYER_CHANNELS, TILE_AREA, TILE_TEXELS, compose_tiles
from eigenfield.rendering.software.resample_kernels import IMAGE_BORDER_TEXELS, compose_image
from eigenfield.runtime.parallel import parallel_map, pieces

TILES_PER_TASK = 64


@dataclass(frozen=True, eq=False)
class Tiled:
    """A mean and components of one size, by tile.

    Attributes:
        mean: (tiles, C, TILE_AREA) float32; None: zeros.
        codes: (tiles, C, G, TILE_AREA / CODE_LANES, 4, CODE_LANES), uint8 or uint16 as stored, or float32: the
            components of all bases one after the other, in groups of four, the last padded with zeros.
        scale: (N, C) float64: value = (code - zero) * scale.
        zero: (N, C) float64.
        places: (tiles,) the tiles' numbers in the atlas.
    """

    mean: NDArray[np.float32] | None
    codes: NDArray[Any]
    scale: NDArray[np.float64]
    zero: NDArray[np.float64]
    places: NDArray[np.int64]


def tile(mean: NDArray[np.float32] | None, bases: Sequence[Basis], used: NDArray[np.bool_], channels: int) -> Tiled:
    """Lay out bases that share their size, grid and corner, and a mean of that size.

    Args:
        mean: (H, W, C); None: zeros.
        used: (tile rows, tile columns) the tiles of the grid that are laid out.
    """
    places, none = np.flatnonzero(used), np.zeros((0, channels))
    textures = [texture for basis in bases for texture in basis.textures]
    kinds = {texture.dtype for texture in textures} | {np.dtype(np.uint8)}
    shape = (len(places), channels, -(-len(textures) // 4), TILE_AREA // CODE_LANES, 4, CODE_LANES)
    codes = np.zeros(shape, np.result_type(*kinds) if all(kind.kind == "u" for kind in kinds) else np.float32)

    def place(j: int) -> None:
        cut = cut_tiles(_in_grid(textures[j], bases[0].size, bases[0].corner), channels)[places]
        codes[:, :, j // 4, :, j % 4, :] = cut.reshape(len(places), channels, TILE_AREA // CODE_LANES, CODE_LANES)

    parallel_map(place, range(len(textures)))
    start = None if mean is None else cut_tiles(mean, channels)[places]
    scale = np.concatenate([none, *(basis.scale.astype(np.float64) for basis in bases)])
    zero = np.concatenate([none, *(basis.zero.astype(np.float64) for basis in bases)])
    return Tiled(start, codes, scale, zero, places)


def tile_shape(size: tuple[int, int]) -> tuple[int, int]:
    """(tile rows, tile columns) of an atlas of (rows, columns) texels."""
    return -(-size[0] // TILE_TEXELS), -(-size[1] // TILE_TEXELS)


def _in_grid(texture: NDArray[Any], size: tuple[int, int], corner: tuple[int, int]) -> NDArray[Any]:
    """A texture at its place in the grid; what lies outside is cleared after summing, whatever stands here."""
    if texture.shape[:2] == size:
        return texture
    whole = np.zeros((*size, texture.shape[2]), texture.dtype)
    row, column = corner
    whole[row : row + texture.shape[0], column : column + texture.shape[1]] = texture
    return whole


def cut_tiles(texture: NDArray[Any], channels: int) -> NDArray[Any]:
    """(tiles, C, TILE_AREA) of a texture (H, W, C), row by row; its border is repeated beyond it."""
    height, width, _ = texture.shape
    padded = np.pad(texture, ((0, -height % TILE_TEXELS), (0, -width % TILE_TEXELS), (0, 0)), mode="edge")
    rows, columns = tile_shape((height, width))
    tiled = padded.reshape(rows, TILE_TEXELS, columns, TILE_TEXELS, channels).transpose(0, 2, 4, 1, 3)
    return tiled.reshape(rows * columns, channels, TILE_AREA)


def empty_layers(height: int, width: int, channels: int) -> NDArray[np.float32]:
    """(L, tiles, TILE_AREA, 4) zeros for a texture as the shading reads it (`kernels`)."""
    rows, columns = tile_shape((height, width))
    return np.zeros((-(-channels // LAYER_CHANNELS), rows * columns, TILE_AREA, 4), np.float32)


def fill_layers(texture: NDArray[np.float32], layers: NDArray[np.float32]) -> None:
    """Lay out a plain texture (H, W, C) in `empty_layers`."""
    channels = texture.shape[2]
    tiled = cut_tiles(texture, channels)
    for k in range(channels):
        layers[k // LAYER_CHANNELS, :, :, k % LAYER_CHANNELS] = tiled[:, k]


def read_layers(layers: NDArray[np.float32], height: int, width: int, channels: int) -> NDArray[np.float32]:
    """The texture (H, W, C) in layers, (L, tiles, TILE_AREA, 4)."""
    rows, columns = tile_shape((height, width))
    tiled = layers[..., :LAYER_CHANNELS].reshape(len(layers), rows, columns, TILE_TEXELS, TILE_TEXELS, LAYER_CHANNELS)
    whole = tiled.transpose(1, 3, 2, 4, 0, 5).reshape(rows * TILE_TEXELS, columns * TILE_TEXELS, -1)
    return np.ascontiguousarray(whole[:height, :width, :channels])


def make_image(size: tuple[int, int], channels: int, texture: NDArray[np.float32] | None = None) -> NDArray[np.float32]:
    """(C, rows, columns) room for whole tiles and a border that repeats the edge, for `resample_kernels`.

    Args:
        size: (rows, columns) of its texels.
        texture: (*size, C) to be laid out. Default: zeros.
    """
    rows, columns = tile_shape(size)
    border = 2 * IMAGE_BORDER_TEXELS
    image = np.zeros((channels, rows * TILE_TEXELS + border, columns * TILE_TEXELS + border), np.float32)
    if texture is not None:
        inner = slice(IMAGE_BORDER_TEXELS, IMAGE_BORDER_TEXELS + size[0])
        image[:, inner, IMAGE_BORDER_TEXELS : IMAGE_BORDER_TEXELS + size[1]] = texture.transpose(2, 0, 1)
        repeat_edge(image, size)
    return image


def repeat_edge(image: NDArray[np.float32], size: tuple[int, int]) -> None:
    """Fill the border of an image of `make_image`."""
    first, (bottom, right) = IMAGE_BORDER_TEXELS, (IMAGE_BORDER_TEXELS + size[0], IMAGE_BORDER_TEXELS + size[1])
    image[:, :, :first] = image[:, :, first, None]
    image[:, :, right : right + first] = image[:, :, right - 1, None]
    image[:, :first] = image[:, first, None]
    image[:, bottom : bottom + first] = image[:, bottom - 1, None]


def compose(
    plane: Tiled,
    omega: NDArray[np.float64],
    tiles: NDArray[np.int64],
    opacity: NDArray[np.float32],
    layers: NDArray[np.float32],
) -> None:
    """Equation 8: the mean plus the weighted sum of the first components.

    Args:
        omega: (n,) weights of the first n components.
        tiles: (t,) the tiles to be summed, indices into `plane.places`.
        layers: (L, tiles of the atlas, TILE_AREA, 4), written.
    """
    numbers = _numbers(plane, omega)
    parallel_map(
        lambda part: compose_tiles(
            tiles[part[0] : part[1]], plane.places, plane.mean, plane.codes, *numbers, opacity, layers
        ),
        pieces(len(tiles), TILES_PER_TASK),
    )


def compose_without_mean(
    plane: Tiled,
    omega: NDArray[np.float64],
    tiles: NDArray[np.int64],
    size: tuple[int, int],
    rectangle: tuple[int, int, int, int],
    image: NDArray[np.float32],
) -> None:
    """Equation 8 without the mean.

    Args:
        omega: (n,) weights of the first n components.
        tiles: (t,) the tiles to be summed, indices into `plane.places`.
        size: (rows, columns) of the image's texels.
        rectangle: [top, bottom) x [left, right) outside of which it is zero.
        image: Of `make_image`, written.
    """
    numbers, columns, within = _numbers(plane, omega), tile_shape(size)[1], np.array(rectangle)
    parallel_map(
        lambda part: compose_image(
            tiles[part[0] : part[1]], plane.places, plane.codes, *numbers, columns, within, image
        ),
        pieces(len(tiles), TILES_PER_TASK),
    )
    repeat_edge(image, size)


def _numbers(
    plane: Tiled, omega: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float32], NDArray[np.float32]]:
    """Groups, coefficients and offset of `compose_tiles`."""
    count, channels = len(omega), plane.codes.shape[1]
    scaled = omega[:, None] * plane.scale[:count]
    coefficients = np.zeros((4 * plane.codes.shape[2], channels), np.float32)
    coefficients[:count] = scaled
    offset = -(scaled * plane.zero[:count]).sum(axis=0).astype(np.float32)
    return np.flatnonzero(coefficients.reshape(-1, 4 * channels).any(axis=1)), coefficients, offset
