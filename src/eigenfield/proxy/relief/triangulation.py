"""A constrained Delaunay triangulation.

Points are whole numbers of 1/LATTICE pixel, so that the side of a line on which a point lies is exact in int64
(coordinates under 2^21, products under 2^44). Corners are in the order of positive area; `across[t, k]` is the
triangle over the edge opposite corner k, -1 at a border; `fixed[t, k]` is not 0 where this edge must stay.

Sources: Lawson's flips ("Software for C1 surface interpolation", 1977); constraints as in Sloan ("A fast algorithm
for generating constrained Delaunay triangulations", 1993).
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

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
    """Flip until every edge on the stack (rows triangle, corner; the corner is the new point) is legal; stamps what
    changed."""
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

    On an edge between two triangles the flat third is flipped away; on a border (or fixed) edge it is dropped and its
    row left with corner -1.
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
    """Delaunay triangulation of points (n, 2), whose first four are a rectangle round all others, in order of
    positive area.

    tri, across, fixed: (2 n, 3) out; at (n,): a triangle at each point; alias (n,): the point itself, or the earlier
    one at the same place. Returns the number of triangles.
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
    """(triangle, corner opposite) of the edge between a and b, from one of its sides. The edge must be there, and not
    both ends on the border."""
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
    """(triangle at a, point) on the way from a to b: the next point exactly on the way, or -1 if the way leaves the
    triangle through the edge opposite a."""
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
    """Edges (rows: two points) between a and b: (their number, the point where the way ends); if one is fixed, (-1,
    its mark)."""
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
    """Make every segment (rows: two points) a fixed edge, or a chain of them through points on its way, marked with 1
    + the line (s,) that it belongs to.

    clash (lines,) bool, out: lines with a segment that crosses another where there is no point; the later segment is
    left out.
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
