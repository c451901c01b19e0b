"""Inner loops of PatchMatch stereo: costs of slanted patches, and the exchange of planes between neighbouring points.

A hypothesis of a point is a plane in labels: d at the point, and its slopes gx and gy a pixel. It is a plane in the
world too, because labels are affine in inverse depth.
"""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel
from eigenfield.stereo.taps import FASTMATH_ORDERED

PATCH_RADIUS_TAPS, PATCH_SPACING_PIXELS = 2, 2  # a patch has (2 radius + 1)^2 taps
PATCH_TAPS = (2 * PATCH_RADIUS_TAPS + 1) ** 2
PATCH_COLOUR_SIGMA_LEVELS = np.float32(30.0)  # difference of grey at which the weight of a tap falls by e
PATCH_NOISE_VARIANCE = np.float32(4.0)  # grey levels squared: what varies less has no say
PATCH_UNSEEN_COST = np.float32(1.0)  # where too few views look, that of patches that do not correlate
PATCH_DISTANCES_PIXELS = ((1, 3, 5), (9, 15, 23))  # odd: the two colours of the chequerboard alternate
_ONE, _ZERO, _HALF = np.float32(1), np.float32(0), np.float32(0.5)


@kernel(fastmath=FASTMATH_ORDERED)
def _reference_patch(reference, y, x, taps, patch):
    """The patch around a point: per tap its weight and weight times difference from the mean; returns the variance.

    taps: (2, T) offsets. patch: (2, T), written.
    """
    height, width = reference.shape
    f = np.float32
    centre = reference[y, x]
    total, mean = _ZERO, _ZERO
    for s in range(PATCH_TAPS):
        j = min(max(y + np.int32(taps[1, s]), 0), height - 1)
        i = min(max(x + np.int32(taps[0, s]), 0), width - 1)
        value = reference[j, i]
        w = np.exp(-abs(value - centre) / PATCH_COLOUR_SIGMA_LEVELS)
        patch[0, s] = w
        patch[1, s] = value
        total += w
        mean += w * value
    mean /= total
    variance = _ZERO
    for s in range(PATCH_TAPS):
        w = patch[0, s] / total
        e = patch[1, s] - mean
        patch[0, s] = w
        patch[1, s] = w * e
        variance += w * e * e
    return f(variance)


@kernel(fastmath=FASTMATH_ORDERED)
def _patch_cost(matrix, picture, size, line, x, y, d, gx, gy, taps, patch, variance, floats, ints):
    """1 - the weighted normalised cross-correlation with one view; negative where the view does not show the point.

    size: (2,) height and width of its photograph, in rows of `line` pixels.
    """
    f = np.float32
    height, width = size[0], size[1]
    z = matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2] * d + matrix[2, 3]
    if not z > f(1e-6):
        return -_ONE
    p = matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2] * d + matrix[0, 3]
    q = matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2] * d + matrix[1, 3]
    right, bottom = f(width - 1), f(height - 1)
    inverse = _ONE / z
    if not (p >= _ZERO and q >= _ZERO and p * inverse <= right and q * inverse <= bottom):
        return -_ONE
    px, py, pz = matrix[0, 0] + gx * matrix[0, 2], matrix[1, 0] + gx * matrix[1, 2], matrix[2, 0] + gx * matrix[2, 2]
    qx, qy, qz = matrix[0, 1] + gy * matrix[0, 2], matrix[1, 1] + gy * matrix[1, 2], matrix[2, 1] + gy * matrix[2, 2]
    last_x, last_y = right - f(0.004), bottom - f(0.004)
    wide = np.int32(line)
    least = f(0.5) * z
    for s in range(PATCH_TAPS):
        u, v = taps[0, s], taps[1, s]
        inverse = _ONE / max(z + u * pz + v * qz, least)
        a = min(max((p + u * px + v * qx) * inverse, _ZERO), last_x)
        b = min(max((q + u * py + v * qy) * inverse, _ZERO), last_y)
        column, row = np.int32(a), np.int32(b)
        floats[0, s] = a - f(column)
        floats[1, s] = b - f(row)
        ints[s] = np.uint32(row * wide + column)
    for s in range(PATCH_TAPS):
        at = ints[s]
        fx, fy = floats[0, s], floats[1, s]
        top = picture[at] + fx * (picture[at + np.uint32(1)] - picture[at])
        below = at + np.uint32(wide)
        under = picture[below] + fx * (picture[below + np.uint32(1)] - picture[below])
        floats[2, s] = top + fy * (under - top)
    mean, square, product = _ZERO, _ZERO, _ZERO
    for s in range(PATCH_TAPS):
        t = floats[2, s]
        mean += patch[0, s] * t
        square += patch[0, s] * t * t
        product += patch[1, s] * t
    other = max(square - mean * mean, _ZERO)
    return max(_ONE - product / np.sqrt((variance + PATCH_NOISE_VARIANCE) * (other + PATCH_NOISE_VARIANCE)), _ZERO)


@kernel(fastmath=FASTMATH_ORDERED)
def _plane_cost(views, x, y, d, gx, gy, taps, patch, variance, costs, floats, ints):
    """The mean cost over the better half of the views that show a point, at least two.

    With maps of the views' inverse depths, a view that has another depth there costs up to `geometric` more.
    """
    matrices, pictures, sizes, line, depths, offset, scale, tolerance, geometric = views
    f = np.float32
    count = 0
    for v in range(matrices.shape[0]):
        matrix = matrices[v]
        c = _patch_cost(matrix, pictures[v], sizes[v], line, x, y, d, gx, gy, taps, patch, variance, floats, ints)
        if c < _ZERO:
            continue
        if depths.shape[1] > 0:
            z = matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2] * d + matrix[2, 3]
            i = np.int32((matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2] * d + matrix[0, 3]) / z + _HALF)
            j = np.int32((matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2] * d + matrix[1, 3]) / z + _HALF)
            w = depths[v, j * line + i]
            apart = abs(w * z / max(offset + scale * d, f(1e-20)) - _ONE)
            c += geometric * min(apart / tolerance, _ONE)
        k = count  # insertion: there are few
        while k > 0 and costs[k - 1] > c:
            costs[k] = costs[k - 1]
            k -= 1
        costs[k] = c
        count += 1
    if count < 2:
        return PATCH_UNSEEN_COST
    used = max((count + 1) // 2, 2)
    total = _ZERO
    for k in range(used):
        total += costs[k]
    return total / f(used)


@kernel()
def _random(state):
    """The next of a series of pseudo-random uint32 (xorshift)."""
    state ^= np.uint32(state << np.uint32(13))
    state ^= np.uint32(state >> np.uint32(17))
    state ^= np.uint32(state << np.uint32(5))
    return np.uint32(state)


@kernel()
def _spread(state):
    """-1..1 of a pseudo-random number."""
    return np.float32(state >> np.uint32(8)) * np.float32(2.0 / 16777216.0) - _ONE


@kernel(fastmath=FASTMATH_ORDERED)
def plane_costs(first, last, reference, views, taps, planes, cost):
    """Costs of the present planes, for rows [first, last).

    Args:
        first, last: Range of rows.
        reference: (h, w) grey levels.
        views: Of `_plane_cost`.
        taps: (2, T) offsets of a patch.
        planes: (h, w, 3) of d, gx, gy.
        cost: (h, w), written.
    """
    patch, floats = np.zeros((2, PATCH_TAPS), np.float32), np.zeros((3, PATCH_TAPS), np.float32)
    ints, costs = np.zeros(PATCH_TAPS, np.uint32), np.zeros(views[0].shape[0] + 1, np.float32)
    f = np.float32
    for y in range(first, last):
        for x in range(reference.shape[1]):
            variance = _reference_patch(reference, y, x, taps, patch)
            d, gx, gy = planes[y, x, 0], planes[y, x, 1], planes[y, x, 2]
            cost[y, x] = _plane_cost(views, f(x), f(y), d, gx, gy, taps, patch, variance, costs, floats, ints)


@kernel(fastmath=FASTMATH_ORDERED)
def exchange_planes(first, last, colour, reference, views, taps, high, steepest, reach, margin, more, planes, cost):
    """Each point of one colour of the chequerboard tries planes of points of the other, and changes of its own.

    A point takes the best plane of each of eight places, the near and the far ones up, down, left and right; the plane
    through its neighbours' labels; and three random changes of its own.

    Args:
        first, last: Range of rows.
        colour: 0 or 1.
        reference: (h, w) grey levels.
        views: Of `_plane_cost`.
        taps: (2, T) offsets of a patch.
        high: Highest label; the lowest is 0.
        steepest: Largest slope, labels a pixel.
        reach: Largest change of d.
        margin: By which a plane must be better to replace the present one.
        more: (N, h, w) further labels to try; those below 0 are not. Compiled arithmetic here knows no NaN.
        planes: (h, w, 3), changed.
        cost: (h, w), changed.
    """
    height, width = reference.shape
    patch, floats = np.zeros((2, PATCH_TAPS), np.float32), np.zeros((3, PATCH_TAPS), np.float32)
    ints, costs = np.zeros(PATCH_TAPS, np.uint32), np.zeros(views[0].shape[0] + 1, np.float32)
    f = np.float32
    tried = np.zeros((13 + more.shape[0], 3), np.float32)
    for y in range(first, last):
        for x in range((y + colour) % 2, width, 2):
            variance = _reference_patch(reference, y, x, taps, patch)
            count = 0
            for place in range(8):
                dx = (1 if place % 4 == 0 else 0) - (1 if place % 4 == 1 else 0)
                dy = (1 if place % 4 == 2 else 0) - (1 if place % 4 == 3 else 0)
                least, i, j = f(1e9), -1, -1
                for step in PATCH_DISTANCES_PIXELS[1] if place >= 4 else PATCH_DISTANCES_PIXELS[0]:
                    a, b = x + dx * step, y + dy * step
                    if 0 <= a < width and 0 <= b < height and cost[b, a] < least:
                        least, i, j = cost[b, a], a, b
                if i >= 0:
                    gx, gy = planes[j, i, 1], planes[j, i, 2]
                    tried[count, 0] = planes[j, i, 0] + gx * f(x - i) + gy * f(y - j)
                    tried[count, 1] = gx
                    tried[count, 2] = gy
                    count += 1
            best = cost[y, x]
            d, sx, sy = planes[y, x, 0], planes[y, x, 1], planes[y, x, 2]
            for k in range(more.shape[0]):
                tried[count, 0] = more[k, y, x]
                tried[count, 1] = sx
                tried[count, 2] = sy
                count += 1
            for k in range(count):
                c, gx, gy = tried[k, 0], tried[k, 1], tried[k, 2]
                if not (_ZERO <= c <= high):
                    continue
                e = _plane_cost(views, f(x), f(y), c, gx, gy, taps, patch, variance, costs, floats, ints)
                if e < best - margin:
                    best, d, sx, sy = e, c, gx, gy
            state = np.uint32((y * width + x) * 2654435761 + 1)
            state = _random(_random(state | np.uint32(1)))
            for k in range(4):
                c, gx, gy = d, sx, sy
                if k == 0:
                    if not (0 < x < width - 1 and 0 < y < height - 1):
                        continue
                    gx = _HALF * (planes[y, x + 1, 0] - planes[y, x - 1, 0])
                    gy = _HALF * (planes[y + 1, x, 0] - planes[y - 1, x, 0])
                if k == 1 or k == 3:
                    state = _random(state)
                    c += reach * _spread(state)
                if k == 2 or k == 3:
                    state = _random(state)
                    gx += f(0.25) * reach * _spread(state)
                    state = _random(state)
                    gy += f(0.25) * reach * _spread(state)
                if not (_ZERO <= c <= high and abs(gx) <= steepest and abs(gy) <= steepest):
                    continue
                e = _plane_cost(views, f(x), f(y), c, gx, gy, taps, patch, variance, costs, floats, ints)
                if e < best - margin:
                    best, d, sx, sy = e, c, gx, gy
            cost[y, x] = best
            planes[y, x, 0], planes[y, x, 1], planes[y, x, 2] = d, sx, sy
