"""Inner loops of reliefs: pixels of triangles, errors against the depth map, insertion, contours, and packing.

Greedy insertion: Garland and Heckbert, "Fast polygonal approximation of terrains and height fields", 1995.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.proxy.relief.triangulation import (
    DELAUNAY_STEPS_PER_PIXEL,
    insert_point,
    twice_area_to,
    twice_signed_area,
)
from eigenfield.runtime.jit import kernel


@kernel()
def _column_range(points, a, b, c, y):
    """First and last column of row y whose pixel centre is in the triangle a, b, c; borders count."""
    low, high = -(1 << 40), 1 << 40
    Y = y * DELAUNAY_STEPS_PER_PIXEL
    for p, q in ((a, b), (b, c), (c, a)):
        dx, dy = points[q, 0] - points[p, 0], points[q, 1] - points[p, 1]
        # dx (Y - py) - dy (X - px) >= 0
        value = dx * (Y - points[p, 1]) + dy * points[p, 0]
        if dy > 0:
            high = min(high, value // (dy * DELAUNAY_STEPS_PER_PIXEL))
        elif dy < 0:
            low = max(low, -(value // (-dy * DELAUNAY_STEPS_PER_PIXEL)))
        elif value < 0:
            return 1, 0
    return low, high


@kernel()
def _row_range(points, a, b, c):
    """First and last row of pixel centres that the triangle a, b, c reaches."""
    low = min(points[a, 1], points[b, 1], points[c, 1])
    high = max(points[a, 1], points[b, 1], points[c, 1])
    return -(-low // DELAUNAY_STEPS_PER_PIXEL), high // DELAUNAY_STEPS_PER_PIXEL


@kernel()
def label_pixels(points, tri, count, owner):
    """The triangle that contains each pixel centre.

    Args:
        points: (n, 2) in steps of DELAUNAY_STEPS_PER_PIXEL.
        tri: (m, 3) corners; rows with -1 are skipped.
        count: Number of triangles.
        owner: (h, w) int32 triangles, written; -1 where there is none.
    """
    owner[:] = -1
    for t in range(count):
        a, b, c = tri[t]
        if a < 0:
            continue
        first, last = _row_range(points, a, b, c)
        for y in range(max(first, 0), min(last, owner.shape[0] - 1) + 1):
            low, high = _column_range(points, a, b, c, y)
            for x in range(max(low, 0), min(high, owner.shape[1] - 1) + 1):
                owner[y, x] = t


@kernel()
def depth_error(d, valid, at_cut, y, x, z):
    """Difference of z from the depth map at a pixel, and the depth there.

    Beside a cut the nearest depth of the 3 x 3 pixels around counts, because the contour may have passed on the other
    side of this pixel. Without a valid pixel the difference is -1.

    Args:
        d: (h, w) labels.
        valid: (h, w) where there is surface.
        at_cut: (h, w) pixels beside a cut.
        y, x: The pixel.
        z: Label.
    """
    best, value = -1.0, 0.0
    reach = 1 if at_cut[y, x] else 0
    for j in range(max(0, y - reach), min(d.shape[0], y + reach + 1)):
        for i in range(max(0, x - reach), min(d.shape[1], x + reach + 1)):
            if valid[j, i]:
                error = abs(z - d[j, i])
                if best < 0 or error < best:
                    best, value = error, d[j, i]
    return best, value


@kernel()
def _worst_pixel(points, height, tri, t, d, valid, at_cut, worst, place, value):
    """The valid pixel of triangle t at which the mesh is farthest from the depth map.

    Args:
        points: (n, 2) in steps of DELAUNAY_STEPS_PER_PIXEL.
        height: (n,) labels of the points.
        tri: (m, 3) corners.
        t: The triangle.
        d: (h, w) labels.
        valid: (h, w) where there is surface.
        at_cut: (h, w) pixels beside a cut.
        worst: (m,) largest error, written at t.
        place: (m, 2) row and column, written at t; -1 if there is none.
        value: (m,) depth, written at t.
    """
    worst[t], place[t, 0] = 0.0, -1
    a, b, c = tri[t]
    if a < 0:
        return
    area = float(twice_signed_area(points, a, b, c))
    first, last = _row_range(points, a, b, c)
    for y in range(max(first, 0), min(last, d.shape[0] - 1) + 1):
        low, high = _column_range(points, a, b, c, y)
        for x in range(max(low, 0), min(high, d.shape[1] - 1) + 1):
            if not valid[y, x]:
                continue
            X, Y = x * DELAUNAY_STEPS_PER_PIXEL, y * DELAUNAY_STEPS_PER_PIXEL
            wa, wb = float(twice_area_to(points, b, c, X, Y)) / area, float(twice_area_to(points, c, a, X, Y)) / area
            z = wa * height[a] + wb * height[b] + (1 - wa - wb) * height[c]
            error, found = depth_error(d, valid, at_cut, y, x, z)
            if error > worst[t] and not _is_corner(points, a, b, c, X, Y):
                worst[t], place[t, 0], place[t, 1], value[t] = error, y, x, found


@kernel()
def _is_corner(points, a, b, c, X, Y):
    """Whether the place X, Y, in the steps of the points, is a corner of the triangle a, b, c."""
    corner = False
    for p in (a, b, c):
        corner |= points[p, 0] == X and points[p, 1] == Y
    return corner


@kernel()
def refine_greedily(
    points, height, tri, adjacent, constrained, incident, vertices, count, d, valid, at_cut, tolerance, limit
):
    """Insert the worst pixels of the triangles, largest errors first, until all errors are within a tolerance.

    Each pass takes all triangles within a factor of two of the worst that no earlier insertion of the pass has changed.

    Args:
        points, height, tri, adjacent, constrained, incident: As in `triangulation` and `_worst_pixel`, with room for
            limit + 2 rows.
        vertices: Number of points in use.
        count: Number of triangles in use.
        d: (h, w) labels.
        valid: (h, w) where there is surface.
        at_cut: (h, w) pixels beside a cut.
        tolerance: Labels.
        limit: Most triangles.

    Returns:
        The numbers of points and triangles in use, and the largest remaining error.
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
                _worst_pixel(points, height, tri, t, d, valid, at_cut, worst, place, value)
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
            points[vertices, 0] = place[t, 1] * DELAUNAY_STEPS_PER_PIXEL
            points[vertices, 1] = place[t, 0] * DELAUNAY_STEPS_PER_PIXEL
            height[vertices] = value[t]
            insert_point(points, vertices, t, tri, adjacent, constrained, incident, count, changed, stamp, stack)
            vertices += 1
            count += 2


@kernel()
def _fit_line(sums, first, last):
    """A line through points [first, last] of a chain by least squares: a point, its normal, and the sum of squares.

    The sum of squared distances is the smaller eigenvalue of the scatter matrix. `sums` (n + 1, 5) are prefix sums of
    x, y, x x, x y, y y.
    """
    n = last - first + 1
    x = (sums[last + 1, 0] - sums[first, 0]) / n
    y = (sums[last + 1, 1] - sums[first, 1]) / n
    xx = sums[last + 1, 2] - sums[first, 2] - n * x * x
    xy = sums[last + 1, 3] - sums[first, 3] - n * x * y
    yy = sums[last + 1, 4] - sums[first, 4] - n * y * y
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    rest = 0.5 * (xx + yy) - np.hypot(0.5 * (xx - yy), xy)
    return x, y, -np.sin(angle), np.cos(angle), max(rest, 0.0)


@kernel()
def _is_straight(chain, sums, first, last, tolerance):
    """Whether points [first, last] of a chain (n, 2) lie within a tolerance of their line, pixels."""
    x, y, nx, ny, _ = _fit_line(sums, first, last)
    farthest = 0.0
    for i in range(first, last + 1):
        farthest = max(farthest, abs((chain[i, 0] - x) * nx + (chain[i, 1] - y) * ny))
    return farthest <= tolerance


@kernel()
def split_chain(chain, tolerance, window, kept):
    """Split a chain into runs that lie within a tolerance of a line each.

    A run is extended as far as possible. Then each joint moves, within a window, to where the two runs fit their lines
    best.

    Args:
        chain: (n, 2).
        tolerance: Pixels.
        window: Points.
        kept: (n,) bool, set at the ends of runs.
    """
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
        while first + step < n and _is_straight(local, sums, first, first + step, tolerance):
            good, step = first + step, 2 * step
        if good < n - 1:
            bad = min(first + step, n)
            if bad == n and _is_straight(local, sums, first, n - 1, tolerance):
                good = n - 1
        while bad - good > 1 and good < n - 1:
            middle = (good + bad) // 2
            if _is_straight(local, sums, first, middle, tolerance):
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
            error = _fit_line(sums, before, i)[4] + _fit_line(sums, i, after)[4]
            if error < best:
                best, place = error, i
        knots[k] = place
    for k in range(count):
        kept[knots[k]] = True


@kernel()
def wedge_moments(points, tri, d, valid, at_cut, reach, clear, near):
    """Moments of the valid pixels near each vertex that lie in the wedge of one of its triangles.

    They are sum w (1, x, y, x x, x y, y y, d, x d, y d), x and y from the vertex, w = 1 / (1 + x x + y y).

    Args:
        points: (n, 2) in steps of DELAUNAY_STEPS_PER_PIXEL.
        tri: (m, 3) corners.
        d: (h, w) labels.
        valid: (h, w) where there is surface.
        at_cut: (h, w) pixels beside a cut.
        reach: Pixels.
        clear: (n, 9) over pixels away from cuts, added to.
        near: (n, 9) over all pixels, added to.
    """
    for t in range(tri.shape[0]):
        for k in range(3):
            p, q, r = tri[t, k], tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
            middle_x, middle_y = points[p, 0] / DELAUNAY_STEPS_PER_PIXEL, points[p, 1] / DELAUNAY_STEPS_PER_PIXEL
            for row in range(max(0, int(middle_y) - reach), min(d.shape[0], int(middle_y) + reach + 2)):
                for column in range(max(0, int(middle_x) - reach), min(d.shape[1], int(middle_x) + reach + 2)):
                    if not valid[row, column]:
                        continue
                    X, Y = column * DELAUNAY_STEPS_PER_PIXEL, row * DELAUNAY_STEPS_PER_PIXEL
                    if twice_area_to(points, p, q, X, Y) < 0 or twice_area_to(points, p, r, X, Y) > 0:
                        continue
                    x, y, z = column - middle_x, row - middle_y, d[row, column]
                    w = 1 / (1 + x * x + y * y)
                    _add_moments(near, p, w, x, y, z)
                    if not at_cut[row, column]:
                        _add_moments(clear, p, w, x, y, z)


@kernel()
def _add_moments(sums, p, w, x, y, z):
    """Add one pixel of weight w and label z, at x, y from vertex p, to the moments (n, 9) of the vertex."""
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
def place_first_fit(taken, mask, place):
    """Put a mask at the first place, by rows, where nothing of it is taken.

    Args:
        taken: (H, W) bool, updated.
        mask: (h, w) bool.
        place: (2,) row and column, written.

    Returns:
        False if it fits nowhere.
    """
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
