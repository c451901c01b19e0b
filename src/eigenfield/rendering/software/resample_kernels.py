"""Kernels that upsample what is summed at a coarser density, and join the channels of planes.

What is summed lies row by row, a channel after the other, as `tiles.make_image` makes it.

Along rows a tile's 16 texels are one vector, and its taps a matrix that is mostly zeros. For 704 texels made 1280, that
is 13 rows of products in place of four gathered taps a texel. One thread takes 1.5 ms for 1280 x 1280 texels so, and
25 ms with gathered taps. Both give the same bits, since products are added in the same order.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.rendering.software.kernels import LAYER_CHANNELS, TILE_AREA, TILE_TEXELS, add_four, write_texels
from eigenfield.rendering.software.simd import add_row_of_product
from eigenfield.runtime.jit import kernel

IMAGE_BORDER_TEXELS = 2  # that repeat an image's edge: taps need not be clamped


@kernel()
def mark_read(needed, top, bottom, left, right, found):
    """The coarse tiles that fine ones read.

    Args:
        needed: (tile rows, tile columns) bool, the fine tiles.
        top, bottom: (tile rows,) first and last row of coarse tiles that each row of fine ones reads.
        left, right: (tile columns,) likewise for columns.
        found: (coarse tile rows, coarse tile columns) bool, set.
    """
    for row in range(needed.shape[0]):
        for column in range(needed.shape[1]):
            if needed[row, column]:
                found[top[row] : bottom[row] + 1, left[column] : right[column] + 1] = True


@kernel(fastmath=True)
def compose_image(tiles, places, codes, groups, coefficients, offset, tile_columns, rectangle, image):
    """Equation 8 without the mean on some tiles of an image.

    Args:
        tile_columns: Width of the image, in tiles.
        rectangle: (4,) [top, bottom) x [left, right) outside of which the image is zero.
        image: (C, H, W), written.
    """
    total = np.empty(TILE_AREA, np.float32)
    for t in tiles:
        row, column = places[t] // tile_columns * TILE_TEXELS, places[t] % tile_columns * TILE_TEXELS
        top, bottom = max(rectangle[0] - row, 0), min(rectangle[1] - row, TILE_TEXELS)
        left, right = max(rectangle[2] - column, 0), min(rectangle[3] - column, TILE_TEXELS)
        for k in range(codes.shape[1]):
            total[:] = offset[k]
            for g in groups:
                j = 4 * g
                add_four(
                    total, codes[t, k, g],
                    coefficients[j, k], coefficients[j + 1, k], coefficients[j + 2, k], coefficients[j + 3, k],
                )  # fmt: skip
            for y in range(TILE_TEXELS):
                out = image[k, IMAGE_BORDER_TEXELS + row + y, IMAGE_BORDER_TEXELS + column :]
                inside = top <= y < bottom
                for x in range(TILE_TEXELS):
                    out[x] = total[y * TILE_TEXELS + x] if inside and left <= x < right else np.float32(0)


@kernel()
def enlarge_tiles(tiles, reached, size, image, row_base, row_weight, first, count, matrix, channel, total):
    """Add some tiles of an upsampled image, filtered first along rows, then down columns.

    Args:
        tiles: (n,) numbers of the fine tiles.
        reached: (fine tiles,) bool, those where the image is not zero.
        size: (rows, columns) of the fine atlas.
        image: (C, H, W) the coarse image.
        row_base, row_weight: (rows,) and (rows, 4), of `Taps`.
        first, count, matrix: Of `TileUpsampler`.
        channel: First of the channels of `total`.
        total: (n, at least channel + C, TILE_AREA), added to.
    """
    height, tile_columns = size[0], first.shape[0]
    texels, weights, flat, out = image.reshape(-1), row_weight.reshape(-1), matrix.reshape(-1), total.reshape(-1)
    line, plane, most = image.shape[2], image.shape[1] * image.shape[2], matrix.shape[1] * TILE_TEXELS
    deepest = 1
    for top in range(0, height, TILE_TEXELS):
        deepest = max(deepest, row_base[min(top + TILE_TEXELS, height) - 1] + 4 - row_base[top])
    lines = np.empty(deepest * TILE_TEXELS, np.float32)
    for n in range(tiles.shape[0]):
        if not reached[tiles[n]]:
            continue
        top, column = tiles[n] // tile_columns * TILE_TEXELS, tiles[n] % tile_columns
        bottom = min(top + TILE_TEXELS, height)
        above, below = row_base[top], row_base[bottom - 1] + 4
        for k in range(image.shape[0]):
            start = k * plane + IMAGE_BORDER_TEXELS * (line + 1) + first[column]
            lines[: (below - above) * TILE_TEXELS] = 0
            for row in range(above, below):
                to = (row - above) * TILE_TEXELS
                add_row_of_product(texels, start + row * line, count[column], flat, column * most, lines, to)
            place = (n * total.shape[1] + channel + k) * TILE_AREA
            for y in range(top, bottom):
                at = (row_base[y] - above) * TILE_TEXELS
                add_row_of_product(weights, 4 * y, 4, lines, at, out, place + (y - top) * TILE_TEXELS)


@kernel(fastmath=True)
def add_tiles(tiles, tile_columns, image, channel, total):
    """Add some tiles of an image of the same size.

    Args:
        tiles: (n,) their numbers.
        image: (C, H, W).
        channel: First of the channels of `total`.
        total: (n, at least channel + C, TILE_AREA), added to.
    """
    for n in range(tiles.shape[0]):
        top = tiles[n] // tile_columns * TILE_TEXELS + IMAGE_BORDER_TEXELS
        left = tiles[n] % tile_columns * TILE_TEXELS + IMAGE_BORDER_TEXELS
        for k in range(image.shape[0]):
            for y in range(TILE_TEXELS):
                line, out = image[k, top + y, left:], total[n, channel + k, y * TILE_TEXELS :]
                for x in range(TILE_TEXELS):
                    out[x] += line[x]


@kernel(fastmath=True)
def join_tiles(tiles, total, matrix, base, numbers, opacity, layers):
    """Join the channels of planes: layers = base + matrix times total.

    Args:
        tiles: (n,) numbers in the atlas.
        total: (n, K, TILE_AREA) sums of the planes.
        matrix: (D, K).
        base: (stored tiles, D, TILE_AREA).
        numbers: (n,) which of the stored tiles.
        layers: (L, tiles of the atlas, TILE_AREA, 4), written.
    """
    values = np.zeros((LAYER_CHANNELS, TILE_AREA), np.float32)
    for n in range(tiles.shape[0]):
        for first in range(0, base.shape[1], LAYER_CHANNELS):
            for k in range(first, min(first + LAYER_CHANNELS, base.shape[1])):
                value, start = values[k - first], base[numbers[n], k]
                for i in range(TILE_AREA):
                    value[i] = start[i]
                for j in range(total.shape[1]):
                    factor, more = matrix[k, j], total[n, j]
                    if factor != 0:
                        for i in range(TILE_AREA):
                            value[i] += factor * more[i]
            write_texels(values, opacity[tiles[n] % opacity.shape[0]], layers[first // LAYER_CHANNELS, tiles[n]])
