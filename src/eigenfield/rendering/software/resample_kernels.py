"""Kernels that upsample coarse tiles and join the channels of planes."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.rendering.software.kernels import LAYER_CHANNELS, TILE_AREA, TILE_TEXELS
from eigenfield.runtime.jit import kernel


@kernel(fastmath=True)
def enlarge_tiles(tiles, tile_columns, coarse, coarse_columns, row_at, row_weight, column_at, column_weight, total):
    """Add some tiles of an upsampled texture, filtered first along rows, then down columns.

    Args:
        tiles: (n,) numbers of the fine tiles.
        tile_columns: Width of the fine atlas, in tiles.
        coarse: (L, tiles, TILE_AREA, 4) the coarse texture.
        coarse_columns: Width of the coarse atlas, in tiles.
        row_at, row_weight: (H, 4), of `Taps`.
        column_at, column_weight: (W, 4), of `Taps`.
        total: (n, C, TILE_AREA), added to.
    """
    height, width, channels = row_at.shape[0], column_at.shape[0], total.shape[1]
    most = 1
    for row in range(0, height, TILE_TEXELS):
        most = max(most, row_at[min(row + TILE_TEXELS, height) - 1, 3] - row_at[row, 0] + 1)
    lines = np.zeros((most, LAYER_CHANNELS, TILE_TEXELS), np.float32)
    for n in range(tiles.shape[0]):
        top, left = tiles[n] // tile_columns * TILE_TEXELS, tiles[n] % tile_columns * TILE_TEXELS
        bottom, right = min(top + TILE_TEXELS, height), min(left + TILE_TEXELS, width)
        first, last = row_at[top, 0], row_at[bottom - 1, 3]
        for layer in range(coarse.shape[0]):
            texture = coarse[layer]
            deep = min(LAYER_CHANNELS, channels - layer * LAYER_CHANNELS)
            for row in range(first, last + 1):
                base, inner = (row // TILE_TEXELS) * coarse_columns, row % TILE_TEXELS * TILE_TEXELS
                line = lines[row - first]
                for x in range(left, right):
                    for k in range(deep):
                        line[k, x - left] = np.float32(0)
                    for tap in range(4):
                        at, weight = column_at[x, tap], column_weight[x, tap]
                        texel = texture[base + at // TILE_TEXELS, inner + at % TILE_TEXELS]
                        for k in range(deep):
                            line[k, x - left] += weight * texel[k]
            for y in range(top, bottom):
                for k in range(deep):
                    out = total[
                        n, layer * LAYER_CHANNELS + k, (y - top) * TILE_TEXELS : (y - top) * TILE_TEXELS + TILE_TEXELS
                    ]
                    for tap in range(4):
                        across, weight = lines[row_at[y, tap] - first, k], row_weight[y, tap]
                        for x in range(TILE_TEXELS):
                            out[x] += weight * across[x]


@kernel(fastmath=True)
def add_tiles(tiles, layers, total):
    """Add some tiles of a texture of the same size.

    Args:
        tiles: (n,) their numbers.
        layers: (L, tiles, TILE_AREA, 4).
        total: (n, C, TILE_AREA), added to.
    """
    for n in range(tiles.shape[0]):
        for k in range(total.shape[1]):
            texture = layers[k // LAYER_CHANNELS, tiles[n]]
            for i in range(TILE_AREA):
                total[n, k, i] += texture[i, k % LAYER_CHANNELS]


@kernel(fastmath=True)
def join_tiles(tiles, total, matrix, base, numbers, layers):
    """Join the channels of planes: layers = base + matrix times total.

    Args:
        tiles: (n,) numbers in the atlas.
        total: (n, K, TILE_AREA) sums of the planes.
        matrix: (D, K).
        base: (stored tiles, D, TILE_AREA).
        numbers: (n,) which of the stored tiles.
        layers: (L, tiles of the atlas, TILE_AREA, 4), written.
    """
    channels = base.shape[1]
    for n in range(tiles.shape[0]):
        for k in range(channels):
            out, start = layers[k // LAYER_CHANNELS, tiles[n]], base[numbers[n], k]
            for i in range(TILE_AREA):
                out[i, k % LAYER_CHANNELS] = start[i]
            for j in range(total.shape[1]):
                factor, value = matrix[k, j], total[n, j]
                if factor != 0:
                    for i in range(TILE_AREA):
                        out[i, k % LAYER_CHANNELS] += factor * value[i]


@kernel()
def clear_outside(places, tile_columns, top, bottom, left, right, layers):
    """Zero the texels outside of a rectangle.

    Args:
        places: (n,) numbers of the tiles.
        tile_columns: Width of the atlas, in tiles.
        top, bottom: Range of rows that stay.
        left, right: Range of columns that stay.
        layers: (L, tiles, TILE_AREA, 4), changed.
    """
    for t in places:
        row, column = t // tile_columns * TILE_TEXELS, t % tile_columns * TILE_TEXELS
        if row >= top and row + TILE_TEXELS <= bottom and column >= left and column + TILE_TEXELS <= right:
            continue
        for i in range(TILE_AREA):
            y, x = row + i // TILE_TEXELS, column + i % TILE_TEXELS
            if y < top or y >= bottom or x < left or x >= right:
                for layer in range(layers.shape[0]):
                    layers[layer, t, i] = np.float32(0)
