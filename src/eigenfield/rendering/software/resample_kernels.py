"""Kernels that make coarse tiles finer and join the channels of planes."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.rendering.software.kernels import AREA, DEPTH, TILE
from eigenfield.runtime.jit import kernel


@kernel(fastmath=True)
def enlarge_tiles(tiles, tile_columns, coarse, coarse_columns, row_at, row_weight, column_at, column_weight, total):
    """Add to total (n, C, AREA) the fine tiles (n,), numbers in an atlas `tile_columns` wide, of the coarse texture in
    coarse (L, tiles, AREA, 4), `coarse_columns` tiles wide: first along rows, then down columns.

    row_at, row_weight (H, 4), column_at, column_weight (W, 4): see `eigenfield.rendering.resample.Taps`.
    """
    height, width, channels = row_at.shape[0], column_at.shape[0], total.shape[1]
    most = 1
    for row in range(0, height, TILE):
        most = max(most, row_at[min(row + TILE, height) - 1, 3] - row_at[row, 0] + 1)
    lines = np.zeros((most, DEPTH, TILE), np.float32)
    for n in range(tiles.shape[0]):
        top, left = tiles[n] // tile_columns * TILE, tiles[n] % tile_columns * TILE
        bottom, right = min(top + TILE, height), min(left + TILE, width)
        first, last = row_at[top, 0], row_at[bottom - 1, 3]
        for layer in range(coarse.shape[0]):
            texture = coarse[layer]
            deep = min(DEPTH, channels - layer * DEPTH)
            for row in range(first, last + 1):
                base, inner = (row // TILE) * coarse_columns, row % TILE * TILE
                line = lines[row - first]
                for x in range(left, right):
                    for k in range(deep):
                        line[k, x - left] = np.float32(0)
                    for tap in range(4):
                        at, weight = column_at[x, tap], column_weight[x, tap]
                        texel = texture[base + at // TILE, inner + at % TILE]
                        for k in range(deep):
                            line[k, x - left] += weight * texel[k]
            for y in range(top, bottom):
                for k in range(deep):
                    out = total[n, layer * DEPTH + k, (y - top) * TILE : (y - top) * TILE + TILE]
                    for tap in range(4):
                        across, weight = lines[row_at[y, tap] - first, k], row_weight[y, tap]
                        for x in range(TILE):
                            out[x] += weight * across[x]


@kernel(fastmath=True)
def add_tiles(tiles, layers, total):
    """Add to total (n, C, AREA) the tiles (n,) of a texture of the same size in layers (L, tiles, AREA, 4)."""
    for n in range(tiles.shape[0]):
        for k in range(total.shape[1]):
            texture = layers[k // DEPTH, tiles[n]]
            for i in range(AREA):
                total[n, k, i] += texture[i, k % DEPTH]


@kernel(fastmath=True)
def join_tiles(tiles, total, matrix, base, numbers, layers):
    """layers (L, tiles of the atlas, AREA, 4) = base + matrix (D, K) times total (n, K, AREA) for tiles (n,).

    base (stored tiles, D, AREA); numbers (n,): which of them.
    """
    channels = base.shape[1]
    for n in range(tiles.shape[0]):
        for k in range(channels):
            out, start = layers[k // DEPTH, tiles[n]], base[numbers[n], k]
            for i in range(AREA):
                out[i, k % DEPTH] = start[i]
            for j in range(total.shape[1]):
                factor, value = matrix[k, j], total[n, j]
                if factor != 0:
                    for i in range(AREA):
                        out[i, k % DEPTH] += factor * value[i]


@kernel()
def clear_outside(places, tile_columns, top, bottom, left, right, layers):
    """Zero in layers (L, tiles, AREA, 4) the texels of tiles `places` outside rows [top, bottom), columns [left,
    right)."""
    for t in places:
        row, column = t // tile_columns * TILE, t % tile_columns * TILE
        if row >= top and row + TILE <= bottom and column >= left and column + TILE <= right:
            continue
        for i in range(AREA):
            y, x = row + i // TILE, column + i % TILE
            if y < top or y >= bottom or x < left or x >= right:
                for layer in range(layers.shape[0]):
                    layers[layer, t, i] = np.float32(0)
