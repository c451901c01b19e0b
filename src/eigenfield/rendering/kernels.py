"""Kernels of the renderer: composing a texture (equation 8), finding what a view needs of it, and shading."""

from __future__ import annotations

import numpy as np

from eigenfield.jit import kernel

TILE = 16  # texels along a side of a tile
AREA = TILE * TILE


@kernel()
def shading_planes(edges, faces, texels, first, last, planes):  # type: ignore[no-untyped-def]
    """Triangles [first, last): texel coordinates over the picture as ratios of linear functions.

    edges (m, 3, 3): b_i(x, y), see `eigenfield.raster`; texels (n, 2): texel coordinates of the vertices.
    planes (m, 3, 3) out: rows p, q, s with column = p(x, y) / s(x, y), row = q / s, 1 / depth = s.
    """
    for f in range(first, last):
        for k in range(3):
            p, q, s = 0.0, 0.0, 0.0
            for i in range(3):
                value = edges[f, i, k]
                p += value * texels[faces[f, i], 0]
                q += value * texels[faces[f, i], 1]
                s += value
            planes[f, 0, k] = p
            planes[f, 1, k] = q
            planes[f, 2, k] = s


@kernel()
def mark_tiles(face, first, last, reach, seen, needed):  # type: ignore[no-untyped-def]
    """Mark in `needed` (tile rows, tile columns) the tiles that rows [first, last) of `face` sample.

    reach (m, 4): the tiles [top, bottom] x [left, right] that a triangle's filter touches. seen (m,) keeps each
    triangle from being looked at twice. Threads share both: they only ever write ones.
    """
    before = -1
    for row in range(first, last):
        for column in range(face.shape[1]):
            f = face[row, column]
            if f == before or f < 0:
                continue
            before = f
            if seen[f]:
                continue
            seen[f] = 1
            for y in range(reach[f, 0], reach[f, 1] + 1):
                for x in range(reach[f, 2], reach[f, 3] + 1):
                    needed[y, x] = 1


@kernel(fastmath=True)
def add_four(total, a, b, c, d, wa, wb, wc, wd):  # type: ignore[no-untyped-def]
    """total += wa a + wb b + wc c + wd d over one tile: four at a time, so that the total is seldom loaded."""
    for i in range(AREA):
        total[i] += (wa * np.float32(a[i]) + wb * np.float32(b[i])) + (wc * np.float32(c[i]) + wd * np.float32(d[i]))


@kernel(fastmath=True)
def compose_tiles(tiles, places, mean, codes, chosen, coefficients, offset, at, texture):  # type: ignore[no-untyped-def]
    """Equation 8 on some tiles: texture[..., at + k] = mean + offset[k] + sum_j coefficients[j, k] codes[j].

    tiles (n,): which of the stored tiles; places (tiles, 2): their row and column in the atlas.
    mean (tiles, C, AREA) float32; codes (tiles, C, N, AREA): tile-major, so that one tile's components lie together
    and are summed while the total stays in the first cache. chosen (M,): the components j to sum, in order.
    """
    channels = codes.shape[1]
    total = np.empty((channels, AREA), np.float32)
    height, width = texture.shape[0], texture.shape[1]
    count = chosen.shape[0]
    for t in tiles:
        for k in range(channels):
            sums = total[k]
            for i in range(AREA):
                sums[i] = mean[t, k, i] + offset[k]
            part = codes[t, k]
            j = 0
            while j + 4 <= count:
                j0, j1, j2, j3 = chosen[j], chosen[j + 1], chosen[j + 2], chosen[j + 3]
                add_four(
                    sums, part[j0], part[j1], part[j2], part[j3],
                    coefficients[j0, k], coefficients[j1, k], coefficients[j2, k], coefficients[j3, k],
                )  # fmt: skip
                j += 4
            while j < count:
                codes_j, weight = part[chosen[j]], coefficients[chosen[j], k]
                for i in range(AREA):
                    sums[i] += weight * np.float32(codes_j[i])
                j += 1
        top, left = places[t, 0] * TILE, places[t, 1] * TILE
        columns = min(TILE, width - left)
        for row in range(min(TILE, height - top)):
            for column in range(columns):
                for k in range(channels):
                    texture[top + row, left + column, at + k] = total[k, row * TILE + column]


@kernel(fastmath=True)
def add_bilinear(texture, x, y, total):  # type: ignore[no-untyped-def]
    """total (C,) += texture (H, W, >= C) at column x, row y (texel centres at whole numbers), clamped."""
    bottom, right = texture.shape[0] - 1, texture.shape[1] - 1
    x, y = min(max(x, np.float32(0)), np.float32(right)), min(max(y, np.float32(0)), np.float32(bottom))
    c0, r0 = int(x), int(y)
    c1, r1 = min(c0 + 1, right), min(r0 + 1, bottom)
    fx, fy = x - np.float32(c0), y - np.float32(r0)
    w11 = fx * fy
    w01, w10 = fx - w11, fy - w11
    w00 = np.float32(1) - fx - w10
    for k in range(total.shape[0]):
        total[k] += (w00 * texture[r0, c0, k] + w01 * texture[r0, c1, k]) + (
            w10 * texture[r1, c0, k] + w11 * texture[r1, c1, k]
        )


@kernel(fastmath=True)
def cubic_weights(f):  # type: ignore[no-untyped-def]
    """Catmull and Rom's cubic (a = -1/2) at distances 1 + f, f, 1 - f, 2 - f."""
    half = np.float32(0.5)
    f2 = f * f
    f3 = f2 * f
    return (
        half * (-f3 + np.float32(2) * f2 - f),
        half * (np.float32(3) * f3 - np.float32(5) * f2 + np.float32(2)),
        half * (np.float32(-3) * f3 + np.float32(4) * f2 + f),
        half * (f3 - f2),
    )


@kernel(fastmath=True)
def add_bicubic(texture, x, y, total):  # type: ignore[no-untyped-def]
    """As `add_bilinear` with the 4 x 4 Catmull-Rom filter."""
    bottom, right = texture.shape[0] - 1, texture.shape[1] - 1
    x, y = min(max(x, np.float32(0)), np.float32(right)), min(max(y, np.float32(0)), np.float32(bottom))
    c1, r1 = int(x), int(y)
    u0, u1, u2, u3 = cubic_weights(x - np.float32(c1))
    v0, v1, v2, v3 = cubic_weights(y - np.float32(r1))
    c0, c2, c3 = max(c1 - 1, 0), min(c1 + 1, right), min(c1 + 2, right)
    r0, r2, r3 = max(r1 - 1, 0), min(r1 + 1, bottom), min(r1 + 2, bottom)
    for k in range(total.shape[0]):
        line0 = u0 * texture[r0, c0, k] + u1 * texture[r0, c1, k] + u2 * texture[r0, c2, k] + u3 * texture[r0, c3, k]
        line1 = u0 * texture[r1, c0, k] + u1 * texture[r1, c1, k] + u2 * texture[r1, c2, k] + u3 * texture[r1, c3, k]
        line2 = u0 * texture[r2, c0, k] + u1 * texture[r2, c1, k] + u2 * texture[r2, c2, k] + u3 * texture[r2, c3, k]
        line3 = u0 * texture[r3, c0, k] + u1 * texture[r3, c1, k] + u2 * texture[r3, c2, k] + u3 * texture[r3, c3, k]
        total[k] += v0 * line0 + v1 * line1 + v2 * line2 + v3 * line3


@kernel(fastmath=True)
def shade_rows(face, planes, texture, bicubic, samples, background, first, last, picture, coverage):  # type: ignore[no-untyped-def]
    """Rows [first, last) of picture (H, W, C), uint8 or float32, and coverage (H, W), from face (H k, W k).

    Each pixel is the mean of its k x k samples; uncovered ones count as `background` (C,). A uint8 picture gets
    values of 0..1 times 255, rounded half to even and clipped.
    """
    channels = picture.shape[2]
    total = np.empty(channels, np.float32)
    share = np.float32(1.0 / (samples * samples))
    for row in range(first, last):
        for column in range(picture.shape[1]):
            total[:] = 0
            hits = 0
            for sy in range(samples):
                for sx in range(samples):
                    j, i = row * samples + sy, column * samples + sx
                    f = face[j, i]
                    if f < 0:
                        continue
                    x, y = i + 0.5, j + 0.5
                    p = planes[f]
                    inverse = np.float32(1) / np.float32(p[2, 0] * x + (p[2, 1] * y + p[2, 2]))
                    u = np.float32(p[0, 0] * x + (p[0, 1] * y + p[0, 2])) * inverse
                    v = np.float32(p[1, 0] * x + (p[1, 1] * y + p[1, 2])) * inverse
                    if bicubic:
                        add_bicubic(texture, u, v, total)
                    else:
                        add_bilinear(texture, u, v, total)
                    hits += 1
            missing = np.float32(samples * samples - hits)
            coverage[row, column] = share * np.float32(hits)
            for k in range(channels):
                store(picture, row, column, k, (total[k] + missing * background[k]) * share)


@kernel(inline=True)
def store(picture, row, column, k, value):  # type: ignore[no-untyped-def]
    """A value of 0..1 into a picture: as it is, or as 8 bit."""
    if picture.itemsize == 1:
        picture[row, column, k] = np.uint8(np.rint(min(max(value * np.float32(255), np.float32(0)), np.float32(255))))
    else:
        picture[row, column, k] = value
