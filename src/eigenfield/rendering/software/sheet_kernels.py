"""Kernel that draws sheets: parts of a surface one over the other, each as opaque as its texture says."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.rendering.software.kernels import (
    LAYER_CHANNELS,
    PREFETCH_SAMPLES,
    TILE_AREA,
    TILE_TEXELS,
    draw_texels,
    locate,
    store_layer,
)
from eigenfield.rendering.software.simd import blend_texels, fetch_early
from eigenfield.runtime.jit import kernel

OPACITY_LANE = 3  # of the first layer: the number of a texel that holds its opacity
LEAST_TRANSMITTANCE = np.float32(1 / 4096)  # where less of what is behind shows through, nothing does


@kernel()
def find_samples(near, column, row, first, last, through, places, nears, columns, rows):
    """List the samples of a line that show a sheet and are not hidden; returns how many these are.

    Args:
        near, column, row: (n,) of `draw_texels`.
        first, last: Range of samples.
        through: (n,) what sheets in front let through, 0..1.
        places: (n,) the samples found, written.
        nears, columns, rows: (n,) their numbers of `near`, `column` and `row`, written.
    """
    found = 0
    for i in range(first, last):
        places[found], nears[found], columns[found], rows[found] = i, near[i], column[i], row[i]
        found += (near[i] > 0) & (through[i] > 0)
    return found


@kernel(fastmath=True, inline=True)
def blend_line(taps, texture, layer, count, places, rows, columns, down, across, through, parts, sums):
    """Composite one layer of a sheet's samples under what is in front of them.

    Args:
        taps: 2 or 4.
        texture: Flat.
        layer: Number of the layer; the first finds how much of each sample is seen.
        count: Number of samples.
        places: Of `find_samples`.
        rows, columns: (taps, n) addresses of the taps (`locate`).
        down, across: (taps, n) their weights.
        through: Of `find_samples`, changed by the first layer.
        parts: (n,) how much of each sample is seen, written by the first layer.
        sums: (n, LAYER_CHANNELS) what the sheets show, added to.
    """
    ahead = np.uintp(PREFETCH_SAMPLES)
    for sample in range(count):
        i = np.uintp(sample)
        fetch_early(texture, rows[taps - 1, i + ahead] + columns[0, i + ahead])
        if taps == 2:
            texel = blend_texels(
                texture,
                (rows[0, i], rows[1, i]),
                (columns[0, i], columns[1, i]),
                (down[0, i], down[1, i]),
                (across[0, i], across[1, i]),
            )
        else:
            texel = blend_texels(
                texture,
                (rows[0, i], rows[1, i], rows[2, i], rows[3, i]),
                (columns[0, i], columns[1, i], columns[2, i], columns[3, i]),
                (down[0, i], down[1, i], down[2, i], down[3, i]),
                (across[0, i], across[1, i], across[2, i], across[3, i]),
            )
        place = np.uintp(places[i])
        if layer == 0:
            opacity, light = min(max(texel[OPACITY_LANE], np.float32(0)), np.float32(1)), through[place]
            rest = light * (np.float32(1) - opacity)
            hidden = rest < LEAST_TRANSMITTANCE
            through[place] = np.float32(0) if hidden else rest
            parts[i] = light if hidden else light * opacity
        part = parts[i]
        sums[place, 0] += part * texel[0]
        sums[place, 1] += part * texel[1]
        sums[place, 2] += part * texel[2]


@kernel(fastmath=True)
def draw_sheet(
    faces, texels, edges, bounds, listing, first, last, slack, middles, seen, layers, size, bicubic, room, through, sums
):  # fmt: skip
    """Draw a sheet under those in front of it, in rows [first, last) of samples.

    Args:
        faces, texels, edges, bounds, listing, first, last, slack: As of `draw_texels`, with the sheet's triangles.
        middles: `inverse_depth`, `column_of` and `row_of` of `draw_texels`, overwritten in these rows.
        seen: As of `draw_texels`.
        layers: (L, tiles, TILE_AREA, 4) the texture; the first layer's `OPACITY_LANE` is the opacity.
        size: (H, W) of the texture, in texels.
        bicubic: Whether the filter has 4 x 4 taps, not 2 x 2.
        room: Memory of a line: `places`, the other results of `find_samples`, `parts`, `rows`, `columns`, `down` and
            `across` of `blend_line`.
        through: (last - first, n) what sheets in front let through, 0..1, changed.
        sums: (L, last - first, n, LAYER_CHANNELS) what these show, added to.
    """
    top, bottom, left, right = last, first, through.shape[1], 0
    for f in listing:
        top, bottom = min(top, max(first, bounds[f, 0])), max(bottom, min(last, bounds[f, 1]))
        left, right = min(left, bounds[f, 2]), max(right, bounds[f, 3])
    if top >= bottom:
        return
    near, column_of, row_of = middles
    draw_texels(faces, texels, edges, bounds, listing, top, bottom, slack, near, column_of, row_of, seen)
    height, width = size
    tile_row = -(-width // TILE_TEXELS) * TILE_AREA * 4
    places, found, parts, rows, columns, down, across = room
    for line in range(top, bottom):
        light = through[line - first]
        count = find_samples(
            near[line], column_of[line], row_of[line], left, right, light, places, found[0], found[1], found[2]
        )
        if count == 0:
            continue
        inverse, u, v = found[0, :count], found[1, :count], found[2, :count]
        if bicubic:
            locate(4, inverse, u, width, TILE_AREA * 4, 4, columns, across)
            locate(4, inverse, v, height, tile_row, TILE_TEXELS * 4, rows, down)
        else:
            locate(2, inverse, u, width, TILE_AREA * 4, 4, columns, across)
            locate(2, inverse, v, height, tile_row, TILE_TEXELS * 4, rows, down)
        for layer in range(layers.shape[0]):
            texture, total = layers[layer].reshape(-1), sums[layer, line - first]
            if bicubic:
                blend_line(4, texture, layer, count, places, rows, columns, down, across, light, parts, total)
            else:
                blend_line(2, texture, layer, count, places, rows, columns, down, across, light, parts, total)


@kernel(fastmath=True)
def draw_sheets(
    faces, texels, edges, bounds, listing, starts, first, last, slack, middles, seen, layers, size, bicubic, samples,
    background, eight_bit, picture, coverage,
):  # fmt: skip
    """Rows [first, last) of a picture of sheets: each pixel is the mean of its k x k samples.

    A sample is composited front to back: T = 1; for each sheet T A of its colour is added, and T *= 1 - A, where A is
    its opacity there, clipped to 0..1. Sheets behind what is opaque are not filtered.

    Args:
        faces, texels, edges, bounds, listing, slack, middles, seen: As of `draw_sheet`, with the triangles of all.
        starts: (sheets + 1,) first triangle of each sheet, back to front, and their number.
        first, last: Range of rows of pixels.
        layers, size, bicubic: As of `draw_sheet`.
        samples: k.
        background: (L, LAYER_CHANNELS) what is behind all sheets.
        eight_bit: Whether values are multiplied by 255, rounded half to even and clipped.
        picture: (H, W, C) uint8 or float32, written.
        coverage: (H, W), written.
    """
    pixels, depth = picture.shape[1], layers.shape[0]
    lines, n = (last - first) * samples, pixels * samples
    through = np.ones((lines, n), np.float32)
    sums = np.zeros((depth, lines, n, LAYER_CHANNELS), np.float32)
    rows, columns = np.zeros((4, n + PREFETCH_SAMPLES), np.int32), np.zeros((4, n + PREFETCH_SAMPLES), np.int32)
    down, across = np.empty((4, n), np.float32), np.empty((4, n), np.float32)
    places, found = np.empty(n, np.int32), np.empty((3, n), np.float32)
    room = places, found, np.empty(n, np.float32), rows, columns, down, across
    ends = np.searchsorted(listing, starts)
    for sheet in range(len(starts) - 2, -1, -1):
        some = listing[ends[sheet] : ends[sheet + 1]]
        draw_sheet(
            faces, texels, edges, bounds, some, first * samples, last * samples, slack, middles, seen, layers, size,
            bicubic, room, through, sums,
        )  # fmt: skip
    line = np.empty(pixels * LAYER_CHANNELS, np.float32)
    share = np.float32(1) / np.float32(samples * samples)
    scale = share * np.float32(255 if eight_bit else 1)
    for row in range(first, last):
        sources = range((row - first) * samples, (row - first + 1) * samples)
        for pixel in range(pixels):
            light = np.float32(0)
            for source in sources:
                for i in range(pixel * samples, pixel * samples + samples):
                    light += through[source, i]
            coverage[row, pixel] = np.float32(1) - share * light
        for layer in range(depth):
            for pixel in range(pixels):
                for k in range(LAYER_CHANNELS):
                    total = np.float32(0)
                    for source in sources:
                        for i in range(pixel * samples, pixel * samples + samples):
                            total += sums[layer, source, i, k] + through[source, i] * background[layer, k]
                    line[pixel * LAYER_CHANNELS + k] = total
            store_layer(line, layer, scale, eight_bit, picture[row])
