"""A triangulated sheet against its depth map: pixels of triangles, errors, insertion; contours and packing on the
raster.

Greedy insertion as in Garland and Heckbert ("Fast polygonal approximation of terrains and height fields", 1995).
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.proxy.relief.triangulation import LATTICE, side, split
from eigenfield.runtime.jit import kernel


@kernel()
def row_run(points, a, b, c, y):
    """First and last whole pixel of row y whose centre is in the triangle a, b, c; borders count."""
    low, high = -(1 << 40), 1 << 40
    Y = y * LATTICE
    for p, q in ((a, b), (b, c), (c, a)):
        dx, dy = points[q, 0] - points[p, 0], points[q, 1] - points[p, 1]
        # dx (Y - py) - dy (X - px) >= 0
        value = dx * (Y - points[p, 1]) + dy * points[p, 0]
        if dy > 0:
            high = min(high, value // (dy * LATTICE))
        elif dy < 0:
            low = max(low, -(value // (-dy * LATTICE)))
        elif value < 0:
            return 1, 0
    return low, high


@kernel()
def rows_of(points, a, b, c):
    """First and last whole row of pixels that the triangle a, b, c reaches."""
    low = min(points[a, 1], points[b, 1], points[c, 1])
    high = max(points[a, 1], points[b, 1], points[c, 1])
    return -(-low // LATTICE), high // LATTICE


@kernel()
def label_pixels(points, tri, count, owner):
    """owner (h, w) int32, out: the triangle on whose ground each pixel centre lies; -1 where there is none."""
    owner[:] = -1
    for t in range(count):
        a, b, c = tri[t]
        if a < 0:
            continue
        first, last = rows_of(points, a, b, c)
        for y in range(max(first, 0), min(last, owner.shape[0] - 1) + 1):
            low, high = row_run(points, a, b, c, y)
            for x in range(max(low, 0), min(high, owner.shape[1] - 1) + 1):
                owner[y, x] = t


@kernel()
def misfit(d, valid, mixed, y, x, z):
    """(how far z is from the depth map at a pixel, the value there); beside a cut any pixel of the 3 x 3 around will
    do, for the contour may have passed on the other side of this one. Infinity comes back as -1."""
    best, value = -1.0, 0.0
    reach = 1 if mixed[y, x] else 0
    for j in range(max(0, y - reach), min(d.shape[0], y + reach + 1)):
        for i in range(max(0, x - reach), min(d.shape[1], x + reach + 1)):
            if valid[j, i]:
                error = abs(z - d[j, i])
                if best < 0 or error < best:
                    best, value = error, d[j, i]
    return best, value


@kernel()
def worst_pixel(points, height, tri, t, d, valid, mixed, worst, place, value):
    """The valid pixel of triangle t where the mesh is farthest from the depth map: error, (row, column), depth."""
    worst[t], place[t, 0] = 0.0, -1
    a, b, c = tri[t]
    if a < 0:
        return
    area = float(side(points, a, b, c))
    first, last = rows_of(points, a, b, c)
    for y in range(max(first, 0), min(last, d.shape[0] - 1) + 1):
        low, high = row_run(points, a, b, c, y)
        for x in range(max(low, 0), min(high, d.shape[1] - 1) + 1):
            if not valid[y, x]:
                continue
            X, Y = x * LATTICE, y * LATTICE
            wa = (
                float(
                    (points[c, 0] - points[b, 0]) * (Y - points[b, 1])
                    - (points[c, 1] - points[b, 1]) * (X - points[b, 0])
                )
                / area
            )
            wb = (
                float(
                    (points[a, 0] - points[c, 0]) * (Y - points[c, 1])
                    - (points[a, 1] - points[c, 1]) * (X - points[c, 0])
                )
                / area
            )
            z = wa * height[a] + wb * height[b] + (1 - wa - wb) * height[c]
            error, found = misfit(d, valid, mixed, y, x, z)
            if error > worst[t] and not is_corner(points, a, b, c, X, Y):
                worst[t], place[t, 0], place[t, 1], value[t] = error, y, x, found


@kernel()
def is_corner(points, a, b, c, X, Y):
    corner = False
    for p in (a, b, c):
        corner |= points[p, 0] == X and points[p, 1] == Y
    return corner


@kernel()
def refine(points, height, tri, across, fixed, at, vertices, count, d, valid, mixed, tolerance, limit):
    """Insert the worst pixels of the triangles, largest errors first, until all are within `tolerance` or there are
    `limit` triangles. points, height, tri, ... have room for limit + 2 rows. Returns (points, triangles) in use and
    the largest error left.

    Each pass takes all triangles within a factor of two of the worst that no earlier insertion of the pass has touched.
    """
    rows = tri.shape[0]
    worst, value = np.zeros(rows), np.zeros(rows)
    place = np.full((rows, 2), -1, np.int64)
    changed = np.ones(rows, np.int64)
    stack = np.empty((rows + 8, 2), np.int64)
    stamp = 1
    while True:
        for t in range(count):
            if changed[t] == stamp:
                worst_pixel(points, height, tri, t, d, valid, mixed, worst, place, value)
        top = worst[:count].max() if count else 0.0
        if top <= tolerance or count + 2 > limit:
            return vertices, count, top
        chosen = np.flatnonzero(worst[:count] > max(tolerance, top / 2))
        chosen = chosen[np.argsort(-worst[chosen], kind="mergesort")]
        stamp += 1
        for t in chosen:  # type: ignore[assignment]
            if changed[t] == stamp:
                continue
            if count + 2 > limit or vertices >= points.shape[0]:
                break
            points[vertices, 0], points[vertices, 1] = place[t, 1] * LATTICE, place[t, 0] * LATTICE
            height[vertices] = value[t]
            split(points, vertices, t, tri, across, fixed, at, count, changed, stamp, stack)
            vertices += 1
            count += 2


@kernel()
def line_through(sums, first, last):
    """The line nearest to points [first, last] of a chain with prefix sums (n + 1, 5) of x, y, x x, x y, y y: a point
    on it, its normal, and the sum of squared distances (the smaller eigenvalue of the scatter matrix)."""
    n = last - first + 1
    x = (sums[last + 1, 0] - sums[first, 0]) / n
    y = (sums[last + 1, 1] - sums[first, 1]) / n
    xx = sums[last + 1, 2] - sums[first, 2] - n * x * x
    xy = sums[last + 1, 3] - sums[first, 3] - n * x * y
    yy = sums[last + 1, 4] - sums[first, 4] - n * y * y
    turn = 0.5 * np.arctan2(2 * xy, xx - yy)
    rest = 0.5 * (xx + yy) - np.hypot(0.5 * (xx - yy), xy)
    return x, y, -np.sin(turn), np.cos(turn), max(rest, 0.0)


@kernel()
def is_straight(chain, sums, first, last, tolerance):
    x, y, nx, ny, _ = line_through(sums, first, last)
    farthest = 0.0
    for i in range(first, last + 1):
        farthest = max(farthest, abs((chain[i, 0] - x) * nx + (chain[i, 1] - y) * ny))
    return farthest <= tolerance


@kernel()
def split_chain(chain, tolerance, window, kept):
    """kept (n,) bool, out: the ends of runs of chain (n, 2) that lie within `tolerance` of a line each. A run is
    taken as long as it goes; then each joint moves, within `window` points, to where the two runs fit their lines
    best."""
    n = chain.shape[0]
    sums = np.zeros((n + 1, 5))
    for i in range(n):
        x, y = chain[i, 0] - chain[0, 0], chain[i, 1] - chain[0, 1]
        for k, term in enumerate((x, y, x * x, x * y, y * y)):
            sums[i + 1, k] = sums[i, k] + term
    local = chain - chain[0]
    knots = np.zeros(n, np.int64)
    count, first = 1, 0
    while first < n - 1:
        good, bad, step = first + 1, n, 2
        while first + step < n and is_straight(local, sums, first, first + step, tolerance):
            good, step = first + step, 2 * step
        if good < n - 1:
            bad = min(first + step, n)
            if bad == n and is_straight(local, sums, first, n - 1, tolerance):
                good = n - 1
        while bad - good > 1 and good < n - 1:
            middle = (good + bad) // 2
            if is_straight(local, sums, first, middle, tolerance):
                good = middle
            else:
                bad = middle
        knots[count] = good
        count += 1
        first = good
    for k in range(1, count - 1):
        before, after = knots[k - 1], knots[k + 1]
        best, place = np.inf, knots[k]
        for i in range(max(before + 1, knots[k] - window), min(after - 1, knots[k] + window) + 1):
            error = line_through(sums, before, i)[4] + line_through(sums, i, after)[4]
            if error < best:
                best, place = error, i
        knots[k] = place
    for k in range(count):
        kept[knots[k]] = True


@kernel()
def wedge_moments(points, tri, d, valid, mixed, reach, clear, near):
    """Moments sum w (1, x, y, x x, x y, y y, d, x d, y d) of the valid pixels within `reach` of a vertex that lie in
    the wedge of one of its triangles, x and y from the vertex, w = 1 / (1 + x x + y y): near (n, 9) over all, clear
    (n, 9) over those away from cuts.
    """
    for t in range(tri.shape[0]):
        for k in range(3):
            p, q, r = tri[t, k], tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
            middle_x, middle_y = points[p, 0] / LATTICE, points[p, 1] / LATTICE
            for row in range(max(0, int(middle_y) - reach), min(d.shape[0], int(middle_y) + reach + 2)):
                for column in range(max(0, int(middle_x) - reach), min(d.shape[1], int(middle_x) + reach + 2)):
                    if not valid[row, column]:
                        continue
                    X, Y = column * LATTICE - points[p, 0], row * LATTICE - points[p, 1]
                    if (points[q, 0] - points[p, 0]) * Y < (points[q, 1] - points[p, 1]) * X:
                        continue
                    if (points[r, 0] - points[p, 0]) * Y > (points[r, 1] - points[p, 1]) * X:
                        continue
                    x, y, z = column - middle_x, row - middle_y, d[row, column]
                    w = 1 / (1 + x * x + y * y)
                    add_moments(near, p, w, x, y, z)
                    if not mixed[row, column]:
                        add_moments(clear, p, w, x, y, z)


@kernel()
def add_moments(sums, p, w, x, y, z):
    sums[p, 0] += w
    sums[p, 1] += w * x
    sums[p, 2] += w * y
    sums[p, 3] += w * x * x
    sums[p, 4] += w * x * y
    sums[p, 5] += w * y * y
    sums[p, 6] += w * z
    sums[p, 7] += w * x * z
    sums[p, 8] += w * y * z


@kernel()
def first_fit(taken, mask, place):
    """Put mask (h, w) into taken (H, W) at the first place, by rows, where nothing of it is taken; place (2,) out:
    row, column. False if it fits nowhere."""
    for row in range(taken.shape[0] - mask.shape[0] + 1):
        for column in range(taken.shape[1] - mask.shape[1] + 1):
            free = True
            for y in range(mask.shape[0]):
                for x in range(mask.shape[1]):
                    if mask[y, x] and taken[row + y, column + x]:
                        free = False
                        break
                if not free:
                    break
            if free:
                for y in range(mask.shape[0]):
                    for x in range(mask.shape[1]):
                        taken[row + y, column + x] |= mask[y, x]
                place[0], place[1] = row, column
                return True
    return False
