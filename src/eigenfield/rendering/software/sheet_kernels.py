"""Kernel that draws sheets: parts of a surface one over the other, each as opaque as its texture says."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.imaging.texels import TEXEL_LANES
from eigenfield.rendering.software.kernels import (
    LAYER_CHANNELS,
    PREFETCH_SAMPLES,
    TILE_AREA,
    TILE_TEXELS,
    draw_texels,
    locate,
    store_layer,
)
from eigenfield.rendering.software.simd import add_texel, blend_texels, fetch_early
from eigenfield.runtime.jit import kernel

OPACITY_LANE = 3  # of a texel's four numbers
RUN_SAMPLES = 16  # of a line that are looked at or passed over together
LEAST_TRANSMITTANCE = np.float32(1 / 4096)  # where less of what is behind shows through, nothing does


@kernel(fastmath=True)
def shows_any(near, through, first, last):
    """Whether any of the samples [first, last) of a line shows a sheet and is not hidden.

    Args:
        near: (n,) 1 / depth; 0: the sheet is not there.
        through: (n,) what sheets in front let through, 0..1.
    """
    most = np.float32(0)
    for i in range(first, last):
        most = max(most, near[i] * through[i])
    return most > 0


@kernel()
def find_run(near, through, first, last):
    """The next samples of a line that have to be looked at, as [start, end); empty at the end of the line."""
    start = first
    while start < last and not shows_any(near, through, start, min(start + RUN_SAMPLES, last)):
        start += RUN_SAMPLES
    end = start
    while end < last and shows_any(near, through, end, min(end + RUN_SAMPLES, last)):
        end += RUN_SAMPLES
    return min(start, last), min(end, last)


@kernel(fastmath=True, inline=True)
def blend_line(taps, texture, layer, near, rows, columns, down, across, through, parts, sums):
    """Composite one layer of a sheet's samples under what is in front of them; returns how many hide what is behind.

    Args:
        taps: 2 or 4.
        texture: Flat.
        layer: Number of the layer; the first finds how much of each sample is seen.
        near: (n,) 1 / depth; 0: the sheet is not there.
        rows, columns: (taps, n) addresses of the taps (`locate`).
        down, across: (taps, n) their weights.
        through: (n,) what sheets in front let through, 0..1, changed by the first layer.
        parts: (n,) how much of each sample is seen, written by the first layer.
        sums: (n * TEXEL_LANES,) what the sheets show, added to.
    """
    ahead, opaque = np.uintp(PREFETCH_SAMPLES), 0
    for sample in range(near.shape[0]):
        i = np.uintp(sample)
        fetch_early(texture, rows[taps - 1, i + ahead] + columns[0, i + ahead])
        if layer == 0:
            parts[i] = 0
            if not ((near[i] > 0) & (through[i] > 0)):
                continue
        elif parts[i] == 0:
            continue
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
        if layer == 0:
            opacity, light = min(max(texel[OPACITY_LANE], np.float32(0)), np.float32(1)), through[i]
            rest = light * (np.float32(1) - opacity)
            hidden = rest < LEAST_TRANSMITTANCE
            through[i] = np.float32(0) if hidden else rest
            parts[i] = light if hidden else light * opacity
            opaque += hidden
        add_texel(sums, np.int64(sample) * TEXEL_LANES, parts[i], texel)
    return opaque


@kernel(fastmath=True)
def add_samples(values, samples, factor, line):
    """Add the sum of each pixel's samples, times a factor.

    Args:
        values: (pixels * samples,).
        samples: Of a row that belong to one pixel.
        line: (pixels,), added to.
    """
    if samples == 1:
        for pixel in range(line.shape[0]):
            line[pixel] += factor * values[pixel]
    else:
        for pixel in range(line.shape[0]):
            for i in range(pixel * samples, pixel * samples + samples):
                line[pixel] += factor * values[i]


@kernel(fastmath=True)
def add_background(through, samples, background, sums, line):
    """Add each pixel's samples, with the background behind them.

    Args:
        through: (pixels * samples,) what the sheets let through.
        samples: Of a row that belong to one pixel.
        background: (LAYER_CHANNELS,).
        sums: (pixels * samples, TEXEL_LANES) what the sheets show.
        line: (pixels * LAYER_CHANNELS,), added to.
    """
    red, green, blue = background[0], background[1], background[2]
    if samples == 1:
        for i in range(through.shape[0]):
            line[LAYER_CHANNELS * i] += sums[i, 0] + red * through[i]
            line[LAYER_CHANNELS * i + 1] += sums[i, 1] + green * through[i]
            line[LAYER_CHANNELS * i + 2] += sums[i, 2] + blue * through[i]
    else:
        for i in range(through.shape[0]):
            place = LAYER_CHANNELS * (i // samples)
            line[place] += sums[i, 0] + red * through[i]
            line[place + 1] += sums[i, 1] + green * through[i]
            line[place + 2] += sums[i, 2] + blue * through[i]


@kernel(fastmath=True)
def draw_sheet(
    faces, texels, edges, bounds, listing, first, last, slack, middles, seen, layers, size, bicubic, room, through,
    waiting, sums,
):  # fmt: skip
    """Draw a sheet under those in front of it, in rows [first, last) of samples.

    Args:
        faces, texels, edges, bounds, listing, first, last, slack: As of `draw_texels`, with the sheet's triangles.
        middles: `inverse_depth`, `column_of` and `row_of` of `draw_texels`, overwritten in these rows.
        layers: (L, tiles, TILE_AREA, 4) the texture; `OPACITY_LANE` of the first is the opacity.
        size: (H, W) of the texture, in texels.
        bicubic: Whether the filter has 4 x 4 taps, not 2 x 2.
        room: Memory of a line: `parts`, `rows`, `columns`, `down` and `across` of `blend_line`.
        through: (last - first, n) what sheets in front let through, 0..1, changed.
        waiting: (last - first,) how many samples of each line let something through, changed.
        sums: (L, last - first, n, TEXEL_LANES) what these show, added to.
    """
    top, bottom, left, right = last, first, through.shape[1], 0
    for f in listing:
        top, bottom = min(top, max(first, bounds[f, 0])), max(bottom, min(last, bounds[f, 1]))
        left, right = min(left, bounds[f, 2]), max(right, bounds[f, 3])
    while top < bottom and waiting[top - first] == 0:
        top += 1
    while top < bottom and waiting[bottom - 1 - first] == 0:
        bottom -= 1
    if top >= bottom:
        return
    near, column_of, row_of = middles
    near[top:bottom, left:right] = 0
    draw_texels(faces, texels, edges, bounds, listing, top, bottom, slack, near, column_of, row_of, seen)
    height, width = size
    tile_row = -(-width // TILE_TEXELS) * TILE_AREA * 4
    parts, rows, columns, down, across = room
    for line in range(top, bottom):
        start = left
        while start < right:
            start, end = find_run(near[line], through[line - first], start, right)
            run = slice(start, end)
            inverse, u, v = near[line, run], column_of[line, run], row_of[line, run]
            light, values = through[line - first, run], slice(start * TEXEL_LANES, end * TEXEL_LANES)
            if bicubic:
                locate(4, inverse, u, width, TILE_AREA * 4, 4, columns, across)
                locate(4, inverse, v, height, tile_row, TILE_TEXELS * 4, rows, down)
            else:
                locate(2, inverse, u, width, TILE_AREA * 4, 4, columns, across)
                locate(2, inverse, v, height, tile_row, TILE_TEXELS * 4, rows, down)
            for layer in range(layers.shape[0]):
                texture, total = layers[layer].reshape(-1), sums[layer, line - first].reshape(-1)[values]
                if bicubic:
                    opaque = blend_line(4, texture, layer, inverse, rows, columns, down, across, light, parts, total)
                else:
                    opaque = blend_line(2, texture, layer, inverse, rows, columns, down, across, light, parts, total)
                waiting[line - first] -= opaque
            start = end


@kernel(fastmath=True)
def draw_sheets(
    faces, texels, edges, bounds, listing, starts, first, last, slack, middles, seen, layers, size, bicubic, samples,
    background, picture, coverage,
):  # fmt: skip
    """Rows [first, last) of a picture of sheets: each pixel is the mean of its k x k samples.

    A sample is composited front to back: T = 1; for each sheet T A of its colour is added, and T *= 1 - A, where A is
    its opacity there, clipped to 0..1. Sheets behind what is opaque are not filtered.

    Args:
        faces, texels, edges, bounds, listing, slack, middles, seen: As of `draw_sheet`, with the triangles of all.
        starts: (sheets + 1,) first triangle of each sheet, back to front, and their number.
        samples: k.
        background: (L, LAYER_CHANNELS) what is behind all sheets.
        picture: (H, W, C) float32, written.
        coverage: (H, W), written.
    """
    pixels, depth = picture.shape[1], layers.shape[0]
    lines, n = (last - first) * samples, pixels * samples
    through, waiting = np.ones((lines, n), np.float32), np.full(lines, n)
    sums = np.zeros((depth, lines, n, TEXEL_LANES), np.float32)
    rows, columns = np.zeros((4, n + PREFETCH_SAMPLES), np.int32), np.zeros((4, n + PREFETCH_SAMPLES), np.int32)
    down, across = np.empty((4, n), np.float32), np.empty((4, n), np.float32)
    room = np.empty(n, np.float32), rows, columns, down, across
    ends = np.searchsorted(listing, starts)
    for sheet in range(len(starts) - 2, -1, -1):
        some = listing[ends[sheet] : ends[sheet + 1]]
        draw_sheet(
            faces, texels, edges, bounds, some, first * samples, last * samples, slack, middles, seen, layers, size,
            bicubic, room, through, waiting, sums,
        )  # fmt: skip
    line = np.empty(pixels * LAYER_CHANNELS, np.float32)
    share = np.float32(1) / np.float32(samples * samples)
    for row in range(first, last):
        sources = range((row - first) * samples, (row - first + 1) * samples)
        covered = coverage[row]
        covered[:] = 1
        for source in sources:
            add_samples(through[source], samples, -share, covered)
        for layer in range(depth):
            line[:] = 0
            for source in sources:
                add_background(through[source], samples, background[layer], sums[layer, source], line)
            store_layer(line, layer, share, picture[row])
