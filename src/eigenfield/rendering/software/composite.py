"""Equation 8 over a whole scene: what each plane keeps at densities of its own becomes one texture that is drawn.

The sums are made where they are cheap, at the density at which eigen textures are stored, and upsampled afterwards. The
means do not change from view to view: they are upsampled once, when a scene is opened.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Basis
from eigenfield.core.scene import Scene
from eigenfield.rendering.software.kernels import TILE_AREA
from eigenfield.rendering.software.resample import TileUpsampler, make_tile_upsampler, tiles_read, tiles_reading
from eigenfield.rendering.software.resample_kernels import add_tiles, enlarge_tiles, join_tiles
from eigenfield.rendering.software.tiles import (
    TILES_PER_TASK,
    Tiled,
    compose,
    compose_without_mean,
    make_image,
    tile,
    tile_shape,
)
from eigenfield.rendering.weights import ViewWeights
from eigenfield.runtime.parallel import parallel_map, pieces


@dataclass(frozen=True, eq=False)
class Part:
    """Bases of one plane with one grid and corner.

    Attributes:
        channels: Its own among the K of all planes.
        size: (rows, columns) of the grid.
        weights: (No, n) float64 for each basis.
        number: (tile rows, tile columns) each tile's index in `tiled`; -1: the tile is left out.
        upsampler: Makes it as fine as the atlas; None where it is.
        rectangle: [top, bottom) x [left, right) outside of which it is zero.
        reached: (tiles of the atlas,) bool, those where it is not zero.
    """

    channels: slice
    size: tuple[int, int]
    tiled: Tiled
    weights: tuple[NDArray[np.float64], ...]
    number: NDArray[np.int64]
    upsampler: TileUpsampler | None
    rectangle: tuple[int, int, int, int]
    reached: NDArray[np.bool_]

    def omega(self, view: ViewWeights, count: int | None) -> NDArray[np.float64]:
        """(N,) weights of the components; those of each basis from `count` on are 0, and None means none of them."""
        each = [view.blend(weights) for weights in self.weights]
        return np.concatenate([np.where(np.arange(len(w)) < (len(w) if count is None else count), w, 0) for w in each])


@dataclass(frozen=True, eq=False)
class Composite:
    """A scene's textures, ready to be summed.

    Attributes:
        size: (H, W) of the atlas.
        number: (tile rows, tile columns) each tile's index in `base`; -1: the tile is left out.
        base: (tiles, D, TILE_AREA) float32, what is drawn without eigen textures.
        matrix: (D, K) float32 from the planes' channels to the texture's.
        plain: Whether the scene is one plane of one size: its part holds the mean, and nothing is joined.
    """

    size: tuple[int, int]
    number: NDArray[np.int64]
    base: NDArray[np.float32]
    matrix: NDArray[np.float32]
    parts: tuple[Part, ...]
    opacity: NDArray[np.float32]
    plain: bool


def make_composite(scene: Scene, used: NDArray[np.bool_], opacity: NDArray[np.float32] | None = None) -> Composite:
    """Lay out a scene's textures.

    Args:
        used: (tile rows, tile columns) the tiles of the atlas that are ever drawn.
        opacity: (tiles, TILE_AREA) of sheets. Default: zeros.
    """
    fourth = np.zeros((1, TILE_AREA), np.float32) if opacity is None else opacity
    planes, to_rgb, size = scene.appearance.planes, scene.appearance.to_rgb, scene.appearance.atlas
    total = sum(int(plane.mean.shape[2]) for plane in planes)
    matrix = np.eye(total, dtype=np.float32) if to_rgb is None else to_rgb.astype(np.float32)
    groups, places = _groups(scene), np.flatnonzero(used)
    plain = to_rgb is None and len(planes) == 1 and planes[0].mean.shape[:2] == size
    if plain and len(groups) <= 1 and all(_whole(bases, size) for _, bases in groups):
        plane = planes[0]
        tiled = tile(plane.mean, plane.bases, used, total)
        weights = tuple(basis.weights.astype(np.float64) for basis in plane.bases)
        part = Part(slice(total), size, tiled, weights, _numbers(used), None, (0, size[0], 0, size[1]), used.ravel())
        assert tiled.mean is not None
        return Composite(size, part.number, tiled.mean, matrix, (part,), fourth, True)
    base = np.zeros((len(places), len(matrix), TILE_AREA), np.float32)
    for plane, channels in zip(planes, scene.appearance.channel_slices, strict=True):
        add_mean(plane.mean, size, places, np.ascontiguousarray(matrix[:, channels]), base)
    parts = tuple(_part(channels, bases, size, used) for channels, bases in groups)
    return Composite(size, _numbers(used), base, matrix, parts, fourth, False)


def compose_scene(
    composite: Composite,
    view: ViewWeights,
    count: int | None,
    needed: NDArray[np.bool_],
    buffers: Sequence[NDArray[np.float32]],
    layers: NDArray[np.float32],
) -> None:
    """Equation 8 for some tiles.

    Args:
        count: Number of eigen textures of each basis; None: all.
        needed: (tile rows, tile columns) the tiles wanted; those that `composite` lacks are left out.
        buffers: Of `make_buffers`, overwritten.
        layers: (L, tiles, TILE_AREA, 4), written.
    """
    kept = needed & (composite.number >= 0)
    if composite.plain:
        (part,) = composite.parts
        omega = part.omega(view, count) if part.weights else np.zeros(0)
        compose(part.tiled, omega, part.number[kept], composite.opacity, layers)
        return
    for part, image in zip(composite.parts, buffers, strict=True):
        wanted = kept
        if part.upsampler is not None:
            wanted = tiles_read(kept, part.upsampler.rows, part.upsampler.columns, tile_shape(part.size))
        numbers = part.number[wanted & (part.number >= 0)]
        compose_without_mean(part.tiled, part.omega(view, count), numbers, part.size, part.rectangle, image)
    tiles, numbers = np.flatnonzero(kept), composite.number[kept]

    def join(piece: tuple[int, int]) -> None:
        some = tiles[slice(*piece)]
        total = np.zeros((len(some), composite.matrix.shape[1], TILE_AREA), np.float32)
        for part, image in zip(composite.parts, buffers, strict=True):
            _add(part.upsampler, some, part.reached, composite.size, image, part.channels.start, total)
        join_tiles(
            some, total, composite.matrix, composite.base, numbers[slice(*piece)], composite.opacity, layers
        )  # fmt: skip

    parallel_map(join, pieces(len(tiles), TILES_PER_TASK))


def make_buffers(composite: Composite) -> list[NDArray[np.float32]]:
    """Memory for the sums of the parts."""
    if composite.plain:
        return []
    return [make_image(part.size, part.channels.stop - part.channels.start) for part in composite.parts]


def _groups(scene: Scene) -> list[tuple[slice, list[Basis]]]:
    """Channels and bases of what can be summed together: one plane, one grid, one corner."""
    found: list[tuple[slice, list[Basis]]] = []
    for plane, own in zip(scene.appearance.planes, scene.appearance.channel_slices, strict=True):
        kinds: dict[tuple[tuple[int, int], tuple[int, int], tuple[int, ...]], list[Basis]] = {}
        for basis in plane.bases:
            if basis.count:
                kinds.setdefault((basis.size, basis.corner, basis.textures.shape[1:3]), []).append(basis)
        found.extend((own, bases) for bases in kinds.values())
    return found


def _whole(bases: Sequence[Basis], size: tuple[int, int]) -> bool:
    return all(basis.textures.shape[1:3] == size for basis in bases)


def _part(channels: slice, bases: list[Basis], atlas: tuple[int, int], used: NDArray[np.bool_]) -> Part:
    size, (row, column) = bases[0].size, bases[0].corner
    upsampler = None if size == atlas else make_tile_upsampler(atlas, size)
    height, width = bases[0].textures.shape[1:3]
    rectangle = (row, row + height, column, column + width)
    inside = np.zeros(tile_shape(size), np.bool_)
    (top, _), (left, _) = tile_shape((row + 1, 1)), tile_shape((column + 1, 1))
    bottom, right = tile_shape((row + height, column + width))
    inside[top - 1 : bottom, left - 1 : right] = True
    if upsampler is None:
        kept, reached = used & inside, inside
    else:
        kept = inside & tiles_read(used, upsampler.rows, upsampler.columns, tile_shape(size))
        reached = tiles_reading(inside, upsampler.rows, upsampler.columns)
    weights = tuple(basis.weights.astype(np.float64) for basis in bases)
    tiled = tile(None, bases, kept, channels.stop - channels.start)
    return Part(channels, size, tiled, weights, _numbers(kept), upsampler, rectangle, reached.ravel())


def _numbers(kept: NDArray[np.bool_]) -> NDArray[np.int64]:
    number = np.full(kept.shape, -1, np.int64)
    number[kept] = np.arange(np.count_nonzero(kept))
    return number


def add_mean(
    mean: NDArray[np.float32],
    atlas: tuple[int, int],
    places: NDArray[np.int64],
    share: NDArray[np.float32],
    base: NDArray[np.float32],
) -> None:
    """Add a mean at the atlas's size to some tiles.

    Args:
        mean: (h, w, C).
        atlas: (H, W).
        places: (tiles,) the tiles' numbers in the atlas.
        share: (D, C) from its channels to those of the tiles.
        base: (tiles, D, TILE_AREA), added to.
    """
    (*size, depth), every = mean.shape, np.ones(tile_shape(atlas), np.bool_).ravel()
    upsampler = None if (size[0], size[1]) == atlas else make_tile_upsampler(atlas, (size[0], size[1]))
    image = make_image((size[0], size[1]), depth, mean)

    def add(piece: tuple[int, int]) -> None:
        some = places[slice(*piece)]
        total = np.zeros((len(some), depth, TILE_AREA), np.float32)
        _add(upsampler, some, every, atlas, image, 0, total)
        base[slice(*piece)] += np.einsum("dc,tca->tda", share, total)

    parallel_map(add, pieces(len(places), TILES_PER_TASK))


def _add(
    upsampler: TileUpsampler | None,
    tiles: NDArray[np.int64],
    reached: NDArray[np.bool_],
    atlas: tuple[int, int],
    image: NDArray[np.float32],
    channel: int,
    total: NDArray[np.float32],
) -> None:
    """total (n, K, TILE_AREA) += the image, from a channel on, upsampled where it is coarser than the atlas."""
    if upsampler is None:
        add_tiles(tiles, tile_shape(atlas)[1], image, channel, total)
        return
    rows, columns = upsampler.rows, (upsampler.first, upsampler.count, upsampler.matrix)
    enlarge_tiles(tiles, reached, atlas, image, rows.base, rows.weight, *columns, channel, total)
