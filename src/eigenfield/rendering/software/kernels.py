"""Kernels of the renderer: where samples land in the atlas, composing a texture (equation 8), filtering.

A texture lies tile by tile and three channels to a layer, (layers, tile rows * tile columns, TILE_AREA, 4) float32. A
tile is one page of memory, and a texel's address is the sum of a part for its row and one for its column.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.imaging.raster import edge_spans, row_span
from eigenfield.rendering.software.simd import LANE_PX, blend_texels, draw_lanes, fetch_early
from eigenfield.runtime.jit import kernel

TILE_TEXELS = 16  # texels along a side of a tile
TILE_AREA = TILE_TEXELS * TILE_TEXELS
CODE_LANES = 16  # texels whose codes of four components lie together
PREFETCH_SAMPLES = 32  # by which a texel is fetched before it is needed
LAYER_CHANNELS = 3  # channels of a layer; the fourth number of a texel is its opacity, 0 in opaque scenes


@kernel()
def draw_texels(
    faces, texels, edges, bounds, listing, first, last, slack, inverse_depth, column_of, row_of, seen
):  # fmt: skip
    """As `imaging.raster.draw_band`, but for where in the atlas each pixel lands instead of its triangle.

    1 / depth, and texel coordinates over depth, are linear functions of the pixel. Pixels are not cleared before.

    Args:
        faces: (m, 3).
        texels: (n, 2) texel coordinates of the vertices.
        inverse_depth: (H, W + LANE_PX) float32 1 / depth, 0 where nothing is drawn yet, written; the last columns are
            room for vectors.
        column_of, row_of: Likewise texel coordinates over depth, written.
        seen: (m,) set to 1 for triangles that were nearest for a while; threads share it and only ever write ones.
    """
    for f in listing:
        e = edges[f]
        a, b, c, q = edge_spans(e, slack)
        u0, u1, u2 = texels[faces[f, 0], 0], texels[faces[f, 1], 0], texels[faces[f, 2], 0]
        v0, v1, v2 = texels[faces[f, 0], 1], texels[faces[f, 1], 1], texels[faces[f, 2], 1]
        ux, vx = u0 * e[0, 0] + u1 * e[1, 0] + u2 * e[2, 0], v0 * e[0, 0] + v1 * e[1, 0] + v2 * e[2, 0]
        uy, vy = u0 * e[0, 1] + u1 * e[1, 1] + u2 * e[2, 1], v0 * e[0, 1] + v1 * e[1, 1] + v2 * e[2, 1]
        uc, vc = u0 * e[0, 2] + u1 * e[1, 2] + u2 * e[2, 2], v0 * e[0, 2] + v1 * e[1, 2] + v2 * e[2, 2]
        q_step, u_step, v_step = np.float32(q[0]), np.float32(ux), np.float32(vx)
        drawn = False
        for row in range(max(first, bounds[f, 0]), min(last, bounds[f, 1])):
            y = row + 0.5
            left, right = row_span(a, b, c, y, bounds[f, 2], bounds[f, 3])
            x = left + 0.5
            q_start = np.float32(q[0] * x + (q[1] * y + q[2]))
            u_start, v_start = np.float32(ux * x + (uy * y + uc)), np.float32(vx * x + (vy * y + vc))
            nearest, columns, rows = inverse_depth[row], column_of[row], row_of[row]
            for step in range(0, right - left, LANE_PX):
                along = np.float32(np.int32(step))
                drawn |= draw_lanes(
                    nearest, columns, rows, left + step, np.int32(right - left - step),
                    q_start + along * q_step, q_step,
                    u_start + along * u_step, u_step,
                    v_start + along * v_step, v_step,
                )  # fmt: skip
        if drawn:
            seen[f] = 1


@kernel()
def mark_tiles(seen, reach, needed):
    """The tiles that triangles read.

    Args:
        seen: (m,) the triangles in view.
        reach: (m, 4) the tiles [top, bottom] x [left, right] of each triangle.
        needed: (tile rows, tile columns) 1 for these tiles, 0 elsewhere, written.
    """
    needed[:] = 0
    for f in range(seen.shape[0]):
        if seen[f]:
            for row in range(reach[f, 0], reach[f, 1] + 1):
                for column in range(reach[f, 2], reach[f, 3] + 1):
                    needed[row, column] = 1


@kernel(fastmath=True)
def add_four(total, codes, a, b, c, d):
    """Add four weighted components: total += a, b, c, d times the four in codes.

    Four at a time, so that the total is seldom loaded, and laid out so that memory is read strictly in order.

    Args:
        total: (TILE_AREA,) float32.
        codes: (TILE_AREA / CODE_LANES, 4, CODE_LANES).
        a, b, c, d: float32.
    """
    for block in range(TILE_AREA // CODE_LANES):
        part = codes[block]
        for i in range(CODE_LANES):
            total[block * CODE_LANES + i] += (a * np.float32(part[0, i]) + b * np.float32(part[1, i])) + (
                c * np.float32(part[2, i]) + d * np.float32(part[3, i])
            )


@kernel(fastmath=True)
def write_texels(values, fourth, out):
    """Write a tile of a layer.

    Args:
        values: (LAYER_CHANNELS, TILE_AREA) float32.
        fourth: (TILE_AREA,).
        out: (TILE_AREA, 4), written.
    """
    red, green, blue = values[0], values[1], values[2]
    for i in range(TILE_AREA):
        out[i, 0] = red[i]
        out[i, 1] = green[i]
        out[i, 2] = blue[i]
        out[i, 3] = fourth[i]


@kernel(fastmath=True)
def compose_tiles(tiles, places, mean, codes, groups, coefficients, offset, opacity, layers):
    """Equation 8 on some tiles: mean + offset + sum of coefficients times codes.

    A tile's components lie together, so that its total stays in the first cache.

    Args:
        tiles: (n,) which of the stored tiles.
        places: (tiles,) number in the atlas of each stored tile.
        mean: (tiles, C, TILE_AREA) float32.
        codes: (tiles, C, G, TILE_AREA / CODE_LANES, 4, CODE_LANES) components in groups of four.
        groups: (g,) the groups that are summed.
        coefficients: (4 G, C) float32.
        offset: (C,) float32.
        opacity: (tiles of the atlas, TILE_AREA) float32 fourth numbers of the texels; or (1, TILE_AREA) for all tiles.
        layers: (L, tiles of the atlas, TILE_AREA, 4), written.
    """
    channels = codes.shape[1]
    totals = np.zeros((LAYER_CHANNELS, TILE_AREA), np.float32)
    for t in tiles:
        for first in range(0, channels, LAYER_CHANNELS):
            for k in range(first, min(first + LAYER_CHANNELS, channels)):
                total, start, add = totals[k - first], mean[t, k], offset[k]
                for i in range(TILE_AREA):
                    total[i] = start[i] + add
                for g in groups:
                    j = 4 * g
                    add_four(
                        total, codes[t, k, g],
                        coefficients[j, k], coefficients[j + 1, k], coefficients[j + 2, k], coefficients[j + 3, k],
                    )  # fmt: skip
            fourth = opacity[places[t] % opacity.shape[0]]
            write_texels(totals, fourth, layers[first // LAYER_CHANNELS, places[t]])


@kernel(fastmath=True)
def filter_weights(kind, f):
    """Weights of the taps at distances 1 + f, f, 1 - f, 2 - f: bilinear, or Catmull-Rom (a = -1/2).

    Args:
        kind: Number of taps: 2 or 4.
        f: float32 in 0..1.
    """
    if kind == 2:
        return np.float32(0), np.float32(1) - f, f, np.float32(0)
    half, f2 = np.float32(0.5), f * f
    f3 = f2 * f
    return (
        half * (np.float32(2) * f2 - f3 - f),
        half * (np.float32(3) * f3 - np.float32(5) * f2 + np.float32(2)),
        half * (np.float32(4) * f2 - np.float32(3) * f3 + f),
        half * (f3 - f2),
    )


@kernel(fastmath=True, inline=True)
def locate(taps, near, place, size, per_tile, per_texel, address, weight):
    """Addresses and weights of the filter's taps along one axis, clamped to the atlas.

    Args:
        taps: 2 or 4.
        near: (n,) 1 / depth.
        place: (n,) texel coordinates over depth.
        size: Of the atlas, in texels.
        per_tile, per_texel: Distance of neighbouring tiles, and texels, in the flat texture.
        address: (taps, n), written.
        weight: (taps, n), written.
    """
    last, end = np.int32(size - 1), np.float32(size - 1)
    tile, texel = np.int32(per_tile), np.int32(per_texel)
    lead = np.int32(taps // 2 - 1)
    for i in range(place.shape[0]):
        inverse = near[i] if near[i] > 0 else np.float32(1)
        x = min(max(place[i] / inverse, np.float32(0)), end)
        whole = np.int32(x)
        w = filter_weights(taps, x - np.float32(whole))
        for tap in range(taps):
            at = min(max(whole + np.int32(tap) - lead, np.int32(0)), last)
            address[tap, i] = (at >> np.int32(4)) * tile + (at & np.int32(15)) * texel
            weight[tap, i] = w[tap + 1 - lead]


@kernel(fastmath=True, inline=True)
def sample_line(taps, texture, near, rows, columns, down, across, per_pixel, background, line):
    """Add the mean of each pixel's filtered samples to a line.

    Texels as vectors save 30 % of the time of 4 x 4 taps, and cost 15 % with 2 x 2.

    Args:
        taps: 2 or 4.
        texture: Flat.
        near: (pixels * per_pixel,) 1 / depth of the samples; 0: the background.
        rows, columns: (taps, n) addresses of the taps (`locate`).
        down, across: (taps, n) their weights.
        per_pixel: Samples of a row that belong to one pixel.
        background: (LAYER_CHANNELS,) where nothing is covered.
        line: (pixels * LAYER_CHANNELS,), added to.
    """
    one, two, ahead, count = np.uintp(1), np.uintp(2), np.uintp(PREFETCH_SAMPLES), np.uintp(per_pixel)
    share = np.float32(1) / np.float32(per_pixel)
    for pixel in range(near.shape[0] // per_pixel):
        red, green, blue = np.float32(0), np.float32(0), np.float32(0)
        for sample in range(per_pixel):
            i = np.uintp(pixel) * count + np.uintp(sample)
            fetch_early(texture, rows[taps - 1, i + ahead] + columns[0, i + ahead])
            if near[i] > 0:
                if taps == 2:
                    for v in range(2):
                        r, g, b = np.float32(0), np.float32(0), np.float32(0)
                        for u in range(2):
                            at, weight = np.uintp(rows[v, i] + columns[u, i]), across[u, i]
                            r += weight * texture[at]
                            g += weight * texture[at + one]
                            b += weight * texture[at + two]
                        weight = down[v, i]
                        red += weight * r
                        green += weight * g
                        blue += weight * b
                else:
                    texel = blend_texels(
                        texture,
                        (rows[0, i], rows[1, i], rows[2, i], rows[3, i]),
                        (columns[0, i], columns[1, i], columns[2, i], columns[3, i]),
                        (down[0, i], down[1, i], down[2, i], down[3, i]),
                        (across[0, i], across[1, i], across[2, i], across[3, i]),
                    )
                    red += texel[0]
                    green += texel[1]
                    blue += texel[2]
            else:
                red += background[0]
                green += background[1]
                blue += background[2]
        place = np.uintp(pixel * LAYER_CHANNELS)
        line[place] += share * red
        line[place + one] += share * green
        line[place + two] += share * blue


@kernel(fastmath=True)
def store_line(line, scale, out):
    """Write a line, times a factor."""
    for i in range(line.shape[0]):
        out[i] = line[i] * scale


@kernel(fastmath=True)
def store_layer(line, layer, scale, out):
    """Write a line's channels of one layer, times a factor.

    Args:
        line: (pixels * LAYER_CHANNELS,).
        out: (pixels, C), written.
    """
    first, channels = layer * LAYER_CHANNELS, out.shape[1]
    if channels == LAYER_CHANNELS:
        store_line(line, scale, out.reshape(-1))
    else:
        for k in range(first, min(first + LAYER_CHANNELS, channels)):
            store_line(line[k - first :: LAYER_CHANNELS], scale, out[:, k])


@kernel(fastmath=True)
def cover_line(near, per_pixel, coverage):
    """The part of each pixel's samples that show the surface.

    Args:
        near: (rows, pixels * per_pixel) 1 / depth of the samples.
        per_pixel: Samples of a row that belong to one pixel.
        coverage: (pixels,), written.
    """
    if near.shape[0] * per_pixel == 1:
        for pixel in range(coverage.shape[0]):
            coverage[pixel] = np.float32(1) if near[0, pixel] > 0 else np.float32(0)
        return
    for pixel in range(coverage.shape[0]):
        hits = 0
        for row in range(near.shape[0]):
            for sample in range(pixel * per_pixel, pixel * per_pixel + per_pixel):
                hits += near[row, sample] > 0
        coverage[pixel] = np.float32(hits) / np.float32(near.shape[0] * per_pixel)


@kernel(fastmath=True)
def shade_line(near, u, v, per_pixel, texture, width, height, bicubic, background, room, line):
    """As `sample_line`, from texel coordinates.

    Args:
        near: (n,) 1 / depth of the samples.
        u, v: (n,) texel coordinates over depth.
        width, height: Of the atlas, in texels.
        bicubic: Whether the filter has 4 x 4 taps, not 2 x 2.
        room: Memory for `rows`, `columns`, `down` and `across` of `sample_line`.
    """
    rows, columns, down, across = room
    tile_row = -(-width // TILE_TEXELS) * TILE_AREA * 4
    if bicubic:
        locate(4, near, u, width, TILE_AREA * 4, 4, columns, across)
        locate(4, near, v, height, tile_row, TILE_TEXELS * 4, rows, down)
        sample_line(4, texture, near, rows, columns, down, across, per_pixel, background, line)
    else:
        locate(2, near, u, width, TILE_AREA * 4, 4, columns, across)
        locate(2, near, v, height, tile_row, TILE_TEXELS * 4, rows, down)
        sample_line(2, texture, near, rows, columns, down, across, per_pixel, background, line)


@kernel(fastmath=True)
def shade_rows(
    inverse_depth, column_of, row_of, spans, multisampled, subsamples, layers, width, height, bicubic, samples,
    background, first, last, picture, coverage,
):  # fmt: skip
    """Rows [first, last) of a picture: each pixel is the mean of its k x k samples, a multi-sampled one of its four.

    Args:
        inverse_depth, column_of, row_of: (H k, at least W k), of `draw_texels`.
        spans, multisampled, subsamples: Of `keep_multisampled`.
        layers: (L, tiles, TILE_AREA, 4) the texture.
        width, height: Of the texture, in texels.
        bicubic: Whether the filter has 4 x 4 taps, not 2 x 2.
        samples: k.
        background: (L, LAYER_CHANNELS) for samples that show nothing.
        picture: (H, W, C) float32, written.
        coverage: (H, W), written.
    """
    pixels = picture.shape[1]
    most = pixels * samples
    for row in range(first, last):
        most = max(most, 4 * (spans[row, 1] - spans[row, 0]))
    rows, columns = np.zeros((4, most + PREFETCH_SAMPLES), np.int32), np.zeros((4, most + PREFETCH_SAMPLES), np.int32)
    down, across = np.empty((4, most), np.float32), np.empty((4, most), np.float32)
    room = rows, columns, down, across
    line, edges = np.empty(pixels * LAYER_CHANNELS, np.float32), np.empty(pixels * LAYER_CHANNELS, np.float32)
    scale = np.float32(1.0 / samples)
    for row in range(first, last):
        sources = range(row * samples, row * samples + samples)
        one, end = spans[row]
        four, covered = slice(4 * one, 4 * end), coverage[row]
        cover_line(inverse_depth[row * samples : row * samples + samples], samples, covered)
        for at in range(one, end):
            cover_line(subsamples[:1, 4 * at : 4 * at + 4], 4, covered[multisampled[at] : multisampled[at] + 1])
        for layer in range(layers.shape[0]):
            texture, behind = layers[layer].reshape(-1), background[layer]
            line[:] = 0
            for source in sources:
                drawn = slice(pixels * samples)
                near, u, v = inverse_depth[source, drawn], column_of[source, drawn], row_of[source, drawn]
                shade_line(near, u, v, samples, texture, width, height, bicubic, behind, room, line)
            if one < end:
                edges[: LAYER_CHANNELS * (end - one)] = 0
                near, u, v = subsamples[0, four], subsamples[1, four], subsamples[2, four]
                shade_line(near, u, v, 4, texture, width, height, bicubic, behind, room, edges)
                for at in range(end - one):
                    for k in range(LAYER_CHANNELS):
                        line[multisampled[one + at] * LAYER_CHANNELS + k] = edges[at * LAYER_CHANNELS + k]
            store_layer(line, layer, scale, picture[row])
