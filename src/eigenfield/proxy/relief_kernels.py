"""A constrained Delaunay triangulation and its refinement to a height field.

Points are whole numbers of 1/LATTICE pixel, so that the side of a line on which a point lies is exact in int64
(coordinates stay under 2^21, products under 2^44). Corners are in the order of positive area; `across[t, k]` is the triangle over
the edge opposite corner k, -1 at a border; `fixed[t, k]` is not 0 where this edge must stay.

Sources: Lawson's flips ("Software for C1 surface interpolation", 1977); constraints as in Sloan ("A fast algorithm for generating
constrained Delaunay triangulations", 1993); greedy insertion as in Garland and Heckbert ("Fast polygonal approximation
of terrains and height fields", 1995).
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.jit import kernel

LATTICE = 256  # steps a pixel
CIRCLE_SLACK = 1e-9  # of the terms of the in-circle determinant: nearly cocircular quads are left alone


@kernel()
def side(points, a, b, c):
    """Twice the signed area of a, b, c."""
    return (points[b, 0] - points[a, 0]) * (points[c, 1] - points[a, 1]) - (points[b, 1] - points[a, 1]) * (
        points[c, 0] - points[a, 0]
    )


@kernel()
def in_circle(points, a, b, c, d):
    """Is d inside the circle through a, b, c (positive area)?"""
    ax, ay = float(points[a, 0] - points[d, 0]), float(points[a, 1] - points[d, 1])
    bx, by = float(points[b, 0] - points[d, 0]), float(points[b, 1] - points[d, 1])
    cx, cy = float(points[c, 0] - points[d, 0]), float(points[c, 1] - points[d, 1])
    a2, b2, c2 = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    value = a2 * (bx * cy - by * cx) - b2 * (ax * cy - ay * cx) + c2 * (ax * by - ay * bx)
    size = a2 * (abs(bx * cy) + abs(by * cx)) + b2 * (abs(ax * cy) + abs(ay * cx)) + c2 * (abs(ax * by) + abs(ay * bx))
    return value > CIRCLE_SLACK * size


@kernel()
def corner_over(across, u, t):
    """The corner of u opposite the edge that it shares with t."""
    if across[u, 0] == t:
        return 0
    return 1 if across[u, 1] == t else 2


@kernel()
def relink(across, u, old, new):
    if u >= 0:
        across[u, corner_over(across, u, old)] = new


@kernel()
def flip(tri, across, fixed, at, t, k):
    """Give the two triangles at the edge opposite corner k of t the other diagonal: (a, b, c), (d, c, b) become
    (a, b, d), (d, c, a)."""
    u = across[t, k]
    j = corner_over(across, u, t)
    k1, k2, j1, j2 = (k + 1) % 3, (k + 2) % 3, (j + 1) % 3, (j + 2) % 3
    a, b, c, d = tri[t, k], tri[t, k1], tri[t, k2], tri[u, j]
    over_ca, over_ab, over_bd, over_dc = across[t, k1], across[t, k2], across[u, j1], across[u, j2]
    fixed_ca, fixed_ab, fixed_bd, fixed_dc = fixed[t, k1], fixed[t, k2], fixed[u, j1], fixed[u, j2]
    tri[t, 0], tri[t, 1], tri[t, 2] = a, b, d
    across[t, 0], across[t, 1], across[t, 2] = over_bd, u, over_ab
    fixed[t, 0], fixed[t, 1], fixed[t, 2] = fixed_bd, 0, fixed_ab
    tri[u, 0], tri[u, 1], tri[u, 2] = d, c, a
    across[u, 0], across[u, 1], across[u, 2] = over_ca, t, over_dc
    fixed[u, 0], fixed[u, 1], fixed[u, 2] = fixed_ca, 0, fixed_dc
    relink(across, over_bd, u, t)
    relink(across, over_ca, t, u)
    at[a], at[b], at[d], at[c] = t, t, t, u


@kernel()
def legal(points, tri, across, fixed, t, k):
    """Does the edge opposite corner k of t satisfy Delaunay's criterion, or may it not be flipped?"""
    u = across[t, k]
    if u < 0 or fixed[t, k]:
        return True
    a, b, c = tri[t, k], tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
    d = tri[u, corner_over(across, u, t)]
    if not in_circle(points, a, b, c, d):
        return True
    return side(points, a, b, d) <= 0 or side(points, d, c, a) <= 0


@kernel()
def legalise(points, tri, across, fixed, at, changed, stamp, stack, top):
    """Flip until every edge on the stack (rows triangle, corner; the corner is the new point) is legal; stamps what changed."""
    while top > 0:
        top -= 1
        t, k = stack[top]
        if legal(points, tri, across, fixed, t, k):
            continue
        u = across[t, k]
        flip(tri, across, fixed, at, t, k)
        changed[t], changed[u] = stamp, stamp
        stack[top, 0], stack[top, 1] = t, 0
        stack[top + 1, 0], stack[top + 1, 1] = u, 2
        top += 2


@kernel()
def split(points, p, t, tri, across, fixed, at, count, changed, stamp, stack):
    """Insert point p in triangle t (inside it or on an edge): new triangles go to rows count and count + 1.

    On an edge between two triangles the flat third is flipped away; on a border (or fixed) edge it is dropped and its row left
    with corner -1.
    """
    a, b, c = tri[t, 0], tri[t, 1], tri[t, 2]
    over_a, over_b, over_c = across[t, 0], across[t, 1], across[t, 2]
    fixed_a, fixed_b, fixed_c = fixed[t, 0], fixed[t, 1], fixed[t, 2]
    t1, t2 = count, count + 1
    tri[t, 2] = p
    tri[t1, 0], tri[t1, 1], tri[t1, 2] = b, c, p
    tri[t2, 0], tri[t2, 1], tri[t2, 2] = c, a, p
    across[t, 0], across[t, 1], across[t, 2] = t1, t2, over_c
    across[t1, 0], across[t1, 1], across[t1, 2] = t2, t, over_a
    across[t2, 0], across[t2, 1], across[t2, 2] = t, t1, over_b
    fixed[t, 0], fixed[t, 1], fixed[t, 2] = 0, 0, fixed_c
    fixed[t1, 0], fixed[t1, 1], fixed[t1, 2] = 0, 0, fixed_a
    fixed[t2, 0], fixed[t2, 1], fixed[t2, 2] = 0, 0, fixed_b
    relink(across, over_a, t, t1)
    relink(across, over_b, t, t2)
    at[a], at[b], at[c], at[p] = t, t, t1, t
    top = 0
    for s in (t, t1, t2):
        changed[s] = stamp
    for s in (t, t1, t2):
        if side(points, tri[s, 0], tri[s, 1], tri[s, 2]) > 0:
            stack[top, 0], stack[top, 1] = s, 2
            top += 1
            continue
        u = across[s, 2]
        if u >= 0 and not fixed[s, 2]:
            flip(tri, across, fixed, at, s, 2)
            changed[u] = stamp
            stack[top, 0], stack[top, 1] = s, 0
            stack[top + 1, 0], stack[top + 1, 1] = u, 2
            top += 2
        else:
            drop(tri, across, at, s)
    legalise(points, tri, across, fixed, at, changed, stamp, stack, top)


@kernel()
def drop(tri, across, at, t):
    """Take triangle t away: its edges become borders."""
    for k in range(3):
        u = across[t, k]
        if u >= 0:
            across[u, corner_over(across, u, t)] = -1
    for k in range(3):
        for j in (1, 2):
            u = across[t, (k + j) % 3]
            if at[tri[t, k]] == t and u >= 0:
                at[tri[t, k]] = u
    for k in range(3):
        tri[t, k], across[t, k] = -1, -1


@kernel()
def triangulate(points, tri, across, fixed, at, alias):
    """Delaunay triangulation of points (n, 2), whose first four are a rectangle round all others, in order of positive area.

    tri, across, fixed: (2 n, 3) out; at (n,): a triangle at each point; alias (n,): the point itself, or the earlier one at the
    same place. Returns the number of triangles.
    """
    tri[0, 0], tri[0, 1], tri[0, 2] = 0, 1, 2
    tri[1, 0], tri[1, 1], tri[1, 2] = 0, 2, 3
    across[:2] = -1
    across[0, 1], across[1, 2] = 1, 0
    at[0], at[1], at[2], at[3] = 0, 0, 0, 1
    for i in range(4):
        alias[i] = i
    changed = np.zeros(tri.shape[0], np.int64)
    stack = np.empty((tri.shape[0] + 8, 2), np.int64)
    count, t = 2, 0
    for p in range(4, points.shape[0]):
        moved = True
        while moved:  # visibility walk
            moved = False
            for k in range(3):
                if side(points, tri[t, (k + 1) % 3], tri[t, (k + 2) % 3], p) < 0:
                    t = across[t, k]
                    moved = True
                    break
        alias[p] = p
        for k in range(3):
            q = tri[t, k]
            if points[q, 0] == points[p, 0] and points[q, 1] == points[p, 1]:
                alias[p] = q
        if alias[p] == p:
            split(points, p, t, tri, across, fixed, at, count, changed, 1, stack)
            count += 2
            t = at[p]
    return count


@kernel()
def find_edge(tri, across, at, a, b):
    """(triangle, corner opposite) of the edge between a and b, from one of its sides. The edge must be there, and not both
    ends on the border."""
    for p, q in ((a, b), (b, a)):
        t = at[p]
        while t >= 0:
            k = 0 if tri[t, 0] == p else 1 if tri[t, 1] == p else 2
            if tri[t, (k + 1) % 3] == q:
                return t, (k + 2) % 3
            t = across[t, (k + 1) % 3]
            if t == at[p]:
                break
    return -1, -1


@kernel()
def towards(points, tri, across, at, a, b):
    """(triangle at a, point) on the way from a to b: the next point exactly on the way, or -1 if the way leaves the triangle through
    the edge opposite a."""
    t = at[a]
    while True:
        k = 0 if tri[t, 0] == a else 1 if tri[t, 1] == a else 2
        first, second = tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
        if first == b:
            return t, b
        on = side(points, a, b, first)
        if on == 0:
            ahead = (points[b, 0] - points[a, 0]) * (points[first, 0] - points[a, 0]) + (
                points[b, 1] - points[a, 1]
            ) * (points[first, 1] - points[a, 1])
            if ahead > 0:
                return t, first
        if on < 0 and side(points, a, b, second) > 0:
            return t, -1
        t = across[t, (k + 1) % 3]


@kernel()
def crossings(points, tri, across, fixed, at, a, b, edges):
    """Edges (rows: two points) between a and b: (their number, the point where the way ends); if one is fixed, (-1, its mark)."""
    t, target = towards(points, tri, across, at, a, b)
    if target >= 0:
        return 0, target
    k = 0 if tri[t, 0] == a else 1 if tri[t, 1] == a else 2
    count = 0
    while True:
        if fixed[t, k]:
            return -1, fixed[t, k]
        right, left = tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
        edges[count, 0], edges[count, 1] = right, left
        count += 1
        u = across[t, k]
        j = corner_over(across, u, t)
        apex = tri[u, j]
        on = side(points, a, b, apex)
        if on == 0:
            return count, apex
        t = u
        k = (j + 2) % 3 if on < 0 else (j + 1) % 3  # out between apex and left, or between right and apex


@kernel()
def constrain(points, tri, across, fixed, at, segments, line, alias, clash):
    """Make every segment (rows: two points) a fixed edge, or a chain of them through points on its way, marked with 1 + the line
    (s,) that it belongs to.

    clash (lines,) bool, out: lines with a segment that crosses another where there is no point; the later segment is left out.
    """
    edges = np.empty((tri.shape[0] * 3, 2), np.int64)
    for s in range(segments.shape[0]):
        a, b = alias[segments[s, 0]], alias[segments[s, 1]]
        while a != b:
            count, target = crossings(points, tri, across, fixed, at, a, b, edges)
            if count < 0:
                clash[line[s]] = clash[target - 1] = True
                break
            head = 0
            while count > 0:
                p, q = edges[head, 0], edges[head, 1]
                head = (head + 1) % edges.shape[0]
                count -= 1
                t, k = find_edge(tri, across, at, p, q)
                p, q = tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
                u = across[t, k]
                c, d = tri[t, k], tri[u, corner_over(across, u, t)]
                again = side(points, c, p, d) <= 0 or side(points, d, q, c) <= 0  # no convex quad yet
                if not again:
                    flip(tri, across, fixed, at, t, k)
                    over = side(points, a, target, c) > 0 > side(points, a, target, d)
                    under = side(points, a, target, c) < 0 < side(points, a, target, d)
                    again = over or under
                    p, q = c, d
                if again:
                    tail = (head + count) % edges.shape[0]
                    edges[tail, 0], edges[tail, 1] = p, q
                    count += 1
            t, k = find_edge(tri, across, at, a, target)
            fixed[t, k] = 1 + line[s]
            u = across[t, k]
            fixed[u, corner_over(across, u, t)] = 1 + line[s]
            a = target


@kernel()
def restore(points, tri, across, fixed, at, count):
    """Flip until every edge that is not fixed is legal."""
    again = True
    while again:
        again = False
        for t in range(count):
            for k in range(3):
                if not legal(points, tri, across, fixed, t, k):
                    flip(tri, across, fixed, at, t, k)
                    again = True


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
    """(how far z is from the depth map at a pixel, the value there); beside a cut any pixel of the 3 x 3 around will do, for the
    contour may have passed on the other side of this one. Infinity comes back as -1."""
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
    for p in (a, b, c):
        if points[p, 0] == X and points[p, 1] == Y:
            return True
    return False


@kernel()
def refine(points, height, tri, across, fixed, at, vertices, count, d, valid, mixed, tolerance, limit):
    """Insert the worst pixels of the triangles, largest errors first, until all are within `tolerance` or there are `limit`
    triangles. points, height, tri, ... have room for limit + 2 rows. Returns (points, triangles) in use and the largest error left.

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
        for t in chosen:
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
    """The line nearest to points [first, last] of a chain with prefix sums (n + 1, 5) of x, y, x x, x y, y y: a point on it, its
    normal, and the sum of squared distances (the smaller eigenvalue of the scatter matrix)."""
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
    for i in range(first, last + 1):
        if abs((chain[i, 0] - x) * nx + (chain[i, 1] - y) * ny) > tolerance:
            return False
    return True


@kernel()
def split_chain(chain, tolerance, window, kept):
    """kept (n,) bool, out: the ends of runs of chain (n, 2) that lie within `tolerance` of a line each. A run is taken as long as
    it goes; then each joint moves, within `window` points, to where the two runs fit their lines best."""
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
    """Moments sum w (1, x, y, x x, x y, y y, d, x d, y d) of the valid pixels within `reach` of a vertex that lie in the wedge of one
    of its triangles, x and y from the vertex, w = 1 / (1 + x x + y y): near (n, 9) over all, clear (n, 9) over those away from cuts.
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
    """Put mask (h, w) into taken (H, W) at the first place, by rows, where nothing of it is taken; place (2,) out: row, column. False
    if it fits nowhere."""
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
