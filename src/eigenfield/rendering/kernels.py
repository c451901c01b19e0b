"""Kernels of the renderer: where samples land in the atlas, composing a texture (equation 8), filtering.

A texture is kept tile by tile and three channels to a layer, (layers, tile rows * tile columns, AREA, 4) float32: a
tile is one page, written in one go, and a texel's address is the sum of a part for its row and one for its column.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.jit import kernel
from eigenfield.raster import run_ends, run_of
from eigenfield.rendering.simd import RUN, blend_texels, draw_lanes, fetch_early

TILE = 16  # texels along a side of a tile
AREA = TILE * TILE
LANES = 16  # texels whose codes of four components lie together
AHEAD = 32  # samples before it is needed that a texel is asked for
DEPTH = 3  # channels of a layer; the fourth number of a texel is padding


@kernel()
def draw_texels(
    faces, texels, edges, bounds, listing, first, last, slack, offsets, above, inverse_depth, column_of, row_of, seen
):  # fmt: skip
    """As `eigenfield.raster.draw_band`, keeping where in the atlas each sample lands instead of its triangle.

    texels (n, 2): texel coordinates of the vertices. offsets (s, 2): where the samples of a pixel are, right of and
    below its centre. inverse_depth, column_of, row_of (s, rows, at least W + RUN) float32 out, from row `above` of the
    picture on: 1 / depth, and texel coordinates over depth, which are linear functions of the pixel; RUN columns are
    room for vectors. seen (m,): set to 1 for triangles that were nearest for a while; threads share it, and only ever
    write ones.
    """
    inverse_depth[:, first - above : last - above] = 0
    e = np.empty((3, 3))
    for f in listing:
        u0, u1, u2 = texels[faces[f, 0], 0], texels[faces[f, 1], 0], texels[faces[f, 2], 0]
        v0, v1, v2 = texels[faces[f, 0], 1], texels[faces[f, 1], 1], texels[faces[f, 2], 1]
        drawn = False
        for s in range(offsets.shape[0]):
            for i in range(3):  # seen from the sample: as if the triangle had moved
                e[i, 0], e[i, 1] = edges[f, i, 0], edges[f, i, 1]
                e[i, 2] = edges[f, i, 2] + e[i, 0] * offsets[s, 0] + e[i, 1] * offsets[s, 1]
            a, b, c, q = run_ends(e, slack)
            ux, vx = u0 * e[0, 0] + u1 * e[1, 0] + u2 * e[2, 0], v0 * e[0, 0] + v1 * e[1, 0] + v2 * e[2, 0]
            uy, vy = u0 * e[0, 1] + u1 * e[1, 1] + u2 * e[2, 1], v0 * e[0, 1] + v1 * e[1, 1] + v2 * e[2, 1]
            uc, vc = u0 * e[0, 2] + u1 * e[1, 2] + u2 * e[2, 2], v0 * e[0, 2] + v1 * e[1, 2] + v2 * e[2, 2]
            q_step, u_step, v_step = np.float32(q[0]), np.float32(ux), np.float32(vx)
            for row in range(max(first, bounds[f, 0]), min(last, bounds[f, 1])):
                y = row + 0.5
                left, right = run_of(a, b, c, y, bounds[f, 2], bounds[f, 3])
                x = left + 0.5
                q_start = np.float32(q[0] * x + (q[1] * y + q[2]))
                u_start, v_start = np.float32(ux * x + (uy * y + uc)), np.float32(vx * x + (vy * y + vc))
                into = row - above
                nearest, columns, rows = inverse_depth[s, into], column_of[s, into], row_of[s, into]
                for step in range(0, right - left, RUN):
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
    """needed (tile rows, tile columns) = 1 for the tiles [top, bottom] x [left, right] (reach, (m, 4)) of the
    triangles in seen (m,); 0 elsewhere."""
    needed[:] = 0
    for f in range(seen.shape[0]):
        if seen[f]:
            for row in range(reach[f, 0], reach[f, 1] + 1):
                for column in range(reach[f, 2], reach[f, 3] + 1):
                    needed[row, column] = 1


@kernel(fastmath=True)
def add_four(total, codes, a, b, c, d):
    """total (AREA,) += a, b, c, d times four components, which codes (AREA / LANES, 4, LANES) holds side by side.

    Four at a time, so that the total is seldom loaded, and laid out so that memory is read strictly in order.
    """
    for block in range(AREA // LANES):
        part = codes[block]
        for i in range(LANES):
            total[block * LANES + i] += (a * np.float32(part[0, i]) + b * np.float32(part[1, i])) + (
                c * np.float32(part[2, i]) + d * np.float32(part[3, i])
            )


@kernel(fastmath=True)
def compose_tiles(tiles, places, mean, codes, groups, coefficients, offset, layers):
    """Equation 8 on some tiles: mean + offset + sum of coefficients times codes.

    tiles (n,): which of the stored tiles; places (tiles,): their number in the atlas.
    mean (tiles, C, AREA) float32; codes (tiles, C, G, AREA / LANES, 4, LANES): components in groups of four, one
    tile's together, so that its total stays in the first cache. groups (g,): those to sum; coefficients
    (4 G, C), offset (C,) float32. layers (L, tiles of the atlas, AREA, 4) out.
    """
    channels = codes.shape[1]
    totals = np.zeros((DEPTH, AREA), np.float32)
    red, green, blue = totals[0], totals[1], totals[2]
    for t in tiles:
        for first in range(0, channels, DEPTH):
            for k in range(first, min(first + DEPTH, channels)):
                total, start, add = totals[k - first], mean[t, k], offset[k]
                for i in range(AREA):
                    total[i] = start[i] + add
                for g in groups:
                    j = 4 * g
                    add_four(
                        total, codes[t, k, g],
                        coefficients[j, k], coefficients[j + 1, k], coefficients[j + 2, k], coefficients[j + 3, k],
                    )  # fmt: skip
            out = layers[first // DEPTH, places[t]]
            for i in range(AREA):
                out[i, 0] = red[i]
                out[i, 1] = green[i]
                out[i, 2] = blue[i]
                out[i, 3] = np.float32(0)


@kernel(fastmath=True)
def filter_weights(kind, f):
    """Weights of the taps at distances 1 + f, f, 1 - f, 2 - f: the triangle, or Catmull and Rom's cubic (a = -1/2)."""
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
    """Texel coordinates over depth (n,), and 1 / depth, along one axis into the addresses and weights (taps, n) of
    the filter's taps, clamped to the atlas, `size` texels long.

    per_tile, per_texel: how far apart neighbours lie in the flat texture.
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
def sample_line(taps, texture, near, rows, columns, down, across, ends, background, line):
    """Add the mean of each pixel's filtered samples to line (pixels * DEPTH,); background where uncovered.

    texture: flat. rows, columns, down, across (taps, n): addresses and weights of the taps; see `locate`. ends
    (pixels,): a pixel's samples are those before its entry, from the entry before on. Texels as vectors save 30 % of
    the time of 4 x 4 taps, and cost 15 % with 2 x 2.
    """
    one, two, ahead = np.uintp(1), np.uintp(2), np.uintp(AHEAD)
    first = 0
    for pixel in range(ends.shape[0]):
        red, green, blue = np.float32(0), np.float32(0), np.float32(0)
        for sample in range(first, ends[pixel]):
            i = np.uintp(sample)
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
        share = np.float32(1) / np.float32(ends[pixel] - first)
        first = ends[pixel]
        place = np.uintp(pixel * DEPTH)
        line[place] += share * red
        line[place + one] += share * green
        line[place + two] += share * blue


@kernel(fastmath=True)
def store_line(line, scale, eight_bit, out):
    """line times scale into out, both flat: as it is, or rounded half to even and clipped to 8 bit."""
    if eight_bit:
        for i in range(line.shape[0]):
            out[i] = np.int32(np.rint(min(max(line[i] * scale, np.float32(0)), np.float32(255))))
    else:
        for i in range(line.shape[0]):
            out[i] = line[i] * scale


@kernel(fastmath=True)
def cover_line(near, ends, sources, coverage):
    """coverage (pixels,): the share of samples near (sources, n) that show surface. ends: see `sample_line`."""
    first = 0
    for pixel in range(ends.shape[0]):
        hits = 0
        for source in range(sources):
            for sample in range(first, ends[pixel]):
                hits += near[source, sample] > 0
        coverage[pixel] = np.float32(hits) / np.float32((ends[pixel] - first) * sources)
        first = ends[pixel]


@kernel(inline=True)
def apart(a, b, c, d, limit):
    """Whether any two of four numbers differ by more. As comparisons, which become vectors, unlike min and max."""
    one = (abs(a - b) > limit) | (abs(a - c) > limit) | (abs(a - d) > limit)
    return one | (abs(b - c) > limit) | (abs(b - d) > limit) | (abs(c - d) > limit)


@kernel()
def part_samples(near, column, row, line, limit, parted):
    """parted (n,) uint8: whether what the four samples of a pixel show lies apart in the atlas, by more than `limit`
    texels along a side, or some show something and some nothing; near, column, row (4, lines, at least n): 1 / depth
    and texel coordinates over depth."""
    n0, n1, n2, n3 = near[0, line], near[1, line], near[2, line], near[3, line]
    x0, x1, x2, x3 = column[0, line], column[1, line], column[2, line], column[3, line]
    y0, y1, y2, y3 = row[0, line], row[1, line], row[2, line], row[3, line]
    zero, one = np.float32(0), np.float32(1)
    for i in range(parted.shape[0]):
        all_show = (n0[i] > zero) & (n1[i] > zero) & (n2[i] > zero) & (n3[i] > zero)
        some_show = (n0[i] > zero) | (n1[i] > zero) | (n2[i] > zero) | (n3[i] > zero)
        a, b, c, d = one / n0[i], one / n1[i], one / n2[i], one / n3[i]
        across = apart(x0[i] * a, x1[i] * b, x2[i] * c, x3[i] * d, limit)
        down = apart(y0[i] * a, y1[i] * b, y2[i] * c, y3[i] * d, limit)
        parted[i] = (all_show & (across | down)) | (some_show & ~all_show)


@kernel()
def gather_samples(near, column, row, limit, first, last, near_out, column_out, row_out, ends):
    """Of rows [first, last) of a picture the samples that are looked at, pixel by pixel: all of a parted pixel's, else
    what they show on average, which is what the middle of the pixel shows.

    near, column, row (4, rows, at least W), limit: see `part_samples`. *_out (H, 4 W at least), ends (H, W): see
    `shade_rows`.
    """
    parted, share = np.empty(ends.shape[1], np.uint8), np.float32(0.25)
    for line in range(first, last):
        here = line - first
        part_samples(near, column, row, here, limit, parted)
        q_out, u_out, v_out = near_out[line], column_out[line], row_out[line]
        at = 0
        for i in range(ends.shape[1]):
            if parted[i]:
                for s in range(4):
                    q_out[at], u_out[at], v_out[at] = near[s, here, i], column[s, here, i], row[s, here, i]
                    at += 1
            else:
                q_out[at] = share * ((near[0, here, i] + near[1, here, i]) + (near[2, here, i] + near[3, here, i]))
                u_out[at] = share * (
                    (column[0, here, i] + column[1, here, i]) + (column[2, here, i] + column[3, here, i])
                )
                v_out[at] = share * ((row[0, here, i] + row[1, here, i]) + (row[2, here, i] + row[3, here, i]))
                at += 1
            ends[line, i] = at


@kernel(fastmath=True)
def shade_rows(
    inverse_depth, column_of, row_of, ends, layers, width, height, bicubic, samples, background, eight_bit, first,
    last, picture, coverage,
):  # fmt: skip
    """Rows [first, last) of picture (H, W, C), uint8 or float32, and coverage (H, W), from samples (H k, n), k being
    `samples`.

    layers (L, tiles, AREA, 4): a texture of `height` x `width`. Each pixel is the mean of its samples in k rows: those
    before its entry of ends (H, W), from the entry before on. Uncovered ones count as `background` (L, DEPTH).
    eight_bit: times 255, rounded half to even and clipped.
    """
    pixels, channels = picture.shape[1], picture.shape[2]
    most = inverse_depth.shape[1]
    tile_row = -(-width // TILE) * AREA * 4
    rows, columns = np.zeros((4, most + AHEAD), np.int32), np.zeros((4, most + AHEAD), np.int32)
    down, across = np.empty((4, most), np.float32), np.empty((4, most), np.float32)
    line = np.empty(pixels * DEPTH, np.float32)
    scale = np.float32((255.0 if eight_bit else 1.0) / samples)
    for row in range(first, last):
        upto, count = ends[row], ends[row, pixels - 1]
        cover_line(inverse_depth[row * samples : row * samples + samples], upto, samples, coverage[row])
        for layer in range(layers.shape[0]):
            texture, behind = layers[layer].reshape(-1), background[layer]
            line[:] = 0
            for source in range(row * samples, row * samples + samples):
                near, u, v = inverse_depth[source, :count], column_of[source, :count], row_of[source, :count]
                if bicubic:
                    locate(4, near, u, width, AREA * 4, 4, columns, across)
                    locate(4, near, v, height, tile_row, TILE * 4, rows, down)
                    sample_line(4, texture, near, rows, columns, down, across, upto, behind, line)
                else:
                    locate(2, near, u, width, AREA * 4, 4, columns, across)
                    locate(2, near, v, height, tile_row, TILE * 4, rows, down)
                    sample_line(2, texture, near, rows, columns, down, across, upto, behind, line)
            if channels == DEPTH:
                store_line(line, scale, eight_bit, picture[row].reshape(-1))
            else:
                for k in range(layer * DEPTH, min(layer * DEPTH + DEPTH, channels)):
                    store_line(line[k - layer * DEPTH :: DEPTH], scale, eight_bit, picture[row, :, k])
