"""Projecting photographs into an atlas, texel by texel."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

RADIUS_PX = 2.0  # of the filter
MAX_FOOTPRINT_PX = 16.0  # that a texel may average over, each way


@kernel(inline=True)
def _filter(t):
    """The bicubic filter at distance t (Catmull and Rom 1974)."""
    t = abs(t)
    if t < 1.0:
        return (1.5 * t - 2.5) * t * t + 1.0
    if t < 2.0:
        return ((-0.5 * t + 2.5) * t - 4.0) * t + 2.0
    return 0.0


@kernel(inline=True)
def _taps(centre, spread, size, index, weight):
    """Fill index and weight with the taps of the filter stretched to `spread` pixels round `centre` (pixel centres at
    +0.5), clamped to the picture; return their number. Weights sum to 1."""
    first = int(np.floor(centre - 0.5 - RADIUS_PX * spread)) + 1
    last = int(np.ceil(centre - 0.5 + RADIUS_PX * spread)) - 1
    total = 0.0
    count = last - first + 1
    for k in range(count):
        w = _filter((first + k + 0.5 - centre) / spread)
        index[k] = min(max(first + k, 0), size - 1)
        weight[k] = w
        total += w
    for k in range(count):
        weight[k] /= total
    return count


@kernel(inline=True)
def _is_hidden(x, y, q, inverse_depth, bias):
    """Whether inverse depth q at pixel position (x, y) lies behind the farthest of the four neighbouring samples.

    Inverse depth is affine over a plane's picture, so a point of the surface itself is never behind all four. An
    empty sample is infinitely far: beside it the surface's own edge runs, nearer than a pixel."""
    height, width = inverse_depth.shape
    column, row = int(np.floor(x - 0.5)), int(np.floor(y - 0.5))
    farthest = np.inf
    for dr in range(2):
        for dc in range(2):
            sample = inverse_depth[min(max(row + dr, 0), height - 1), min(max(column + dc, 0), width - 1)]
            if sample < farthest:
                farthest = sample
    return q < farthest - bias


@kernel()
def project_texels(
    position, face, normal, along, down, matrix, centre, photograph, mask, inverse_depth, bias, grazing, values, seen
):  # fmt: skip
    """All texels: values (n, C) and seen (n,) out. mask: (0, 0) for none.

    A texel at X projects to (x, y) at depth z = (P X)_3. It is seen if it is in front, inside the photograph, not
    hidden (see `_is_hidden`), |n . v| > grazing, and, with a mask, most of its filter lies where the mask
    counts. Its footprint per axis is the length of the row of d(x, y)/d(column, row); where it exceeds one pixel the
    filter is stretched to it, so that the texel averages what it covers. With a mask, taps are weighted by it.
    """
    height, width, channels = photograph.shape
    most = int(2 * RADIUS_PX * MAX_FOOTPRINT_PX) + 4
    ix, iy = np.empty(most, np.int64), np.empty(most, np.int64)
    wx, wy = np.empty(most), np.empty(most)
    for n in range(position.shape[0]):
        seen[n] = 0
        for c in range(channels):
            values[n, c] = 0
        px, py, pz = np.float64(position[n, 0]), np.float64(position[n, 1]), np.float64(position[n, 2])
        z = matrix[2, 0] * px + matrix[2, 1] * py + matrix[2, 2] * pz + matrix[2, 3]
        if z <= 0:
            continue
        x = (matrix[0, 0] * px + matrix[0, 1] * py + matrix[0, 2] * pz + matrix[0, 3]) / z
        y = (matrix[1, 0] * px + matrix[1, 1] * py + matrix[1, 2] * pz + matrix[1, 3]) / z
        if not (0 <= x <= width and 0 <= y <= height):
            continue
        f = face[n]
        vx, vy, vz = centre[0] - px, centre[1] - py, centre[2] - pz
        cosine = abs(normal[f, 0] * vx + normal[f, 1] * vy + normal[f, 2] * vz)
        if cosine <= grazing * np.sqrt(vx * vx + vy * vy + vz * vz):
            continue
        if _is_hidden(x, y, 1.0 / z, inverse_depth, bias):
            continue
        a, d = along[f], down[f]
        za = matrix[2, 0] * a[0] + matrix[2, 1] * a[1] + matrix[2, 2] * a[2]
        zd = matrix[2, 0] * d[0] + matrix[2, 1] * d[1] + matrix[2, 2] * d[2]
        xa = (matrix[0, 0] * a[0] + matrix[0, 1] * a[1] + matrix[0, 2] * a[2] - x * za) / z
        xd = (matrix[0, 0] * d[0] + matrix[0, 1] * d[1] + matrix[0, 2] * d[2] - x * zd) / z
        ya = (matrix[1, 0] * a[0] + matrix[1, 1] * a[1] + matrix[1, 2] * a[2] - y * za) / z
        yd = (matrix[1, 0] * d[0] + matrix[1, 1] * d[1] + matrix[1, 2] * d[2] - y * zd) / z
        sx = min(max(np.sqrt(xa * xa + xd * xd), 1.0), MAX_FOOTPRINT_PX)
        sy = min(max(np.sqrt(ya * ya + yd * yd), 1.0), MAX_FOOTPRINT_PX)
        nx = _taps(x, sx, width, ix, wx)
        ny = _taps(y, sy, height, iy, wy)
        kept = 1.0
        if mask.size:
            kept = 0.0
            for j in range(ny):
                for i in range(nx):
                    kept += wy[j] * wx[i] * mask[iy[j], ix[i]]
            if kept < 0.5:
                continue
        elif channels == 3:
            r, g, b = 0.0, 0.0, 0.0
            for j in range(ny):
                row = photograph[iy[j]]
                rr, gg, bb = 0.0, 0.0, 0.0
                for i in range(nx):
                    k = ix[i]
                    rr += wx[i] * row[k, 0]
                    gg += wx[i] * row[k, 1]
                    bb += wx[i] * row[k, 2]
                r += wy[j] * rr
                g += wy[j] * gg
                b += wy[j] * bb
            values[n, 0], values[n, 1], values[n, 2] = r, g, b
        if mask.size or channels != 3:
            for j in range(ny):
                for i in range(nx):
                    w = wy[j] * wx[i] * (mask[iy[j], ix[i]] if mask.size else np.float32(1)) / kept
                    for c in range(channels):
                        values[n, c] += np.float32(w * photograph[iy[j], ix[i], c])
        seen[n] = 1
