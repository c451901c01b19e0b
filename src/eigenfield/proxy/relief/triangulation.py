"""A constrained Delaunay triangulation.

Points are integers in steps of 1/DELAUNAY_STEPS_PER_PIXEL pixel, so that the side of a line on which a point lies is
exact in int64 (coordinates under 2^21, products under 2^44). Corners are in the order of positive area. `adjacent[t,
k]` is the triangle across the edge opposite corner k, -1 at a border. `constrained[t, k]` is not 0 where this edge must
stay. `incident[p]` is a triangle at point p.

Lawson's flips: "Software for C1 surface interpolation", 1977. Constraints: Sloan, "A fast algorithm for generating
constrained Delaunay triangulations", 1993.

Arguments that several functions share:
    points: (n, 2) int64.
    tri: (m, 3) int64 corners of the triangles.
    adjacent: (m, 3) int64.
    constrained: (m, 3) int64.
    incident: (n,) int64.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

DELAUNAY_STEPS_PER_PIXEL = 256
DELAUNAY_CIRCLE_SLACK = 1e-9  # relative: nearly cocircular quads are not flipped


@kernel()
def twice_signed_area(points, a, b, c):
    """Twice the signed area of a, b, c.

    Args:
        points: (n, 2).
        a, b, c: Indices of points.
    """
    return twice_area_to(points, a, b, points[c, 0], points[c, 1])


@kernel()
def twice_area_to(points, a, b, x, y):
    """Twice the signed area of a, b and a place.

    Args:
        points: (n, 2).
        a, b: Indices of points.
        x, y: The place, in the same steps.
    """
    ax, ay = points[a, 0], points[a, 1]
    return (points[b, 0] - ax) * (y - ay) - (points[b, 1] - ay) * (x - ax)


@kernel()
def _in_circle(points, a, b, c, d):
    """Whether d is inside the circle through a, b, c (positive area)."""
    ax, ay = float(points[a, 0] - points[d, 0]), float(points[a, 1] - points[d, 1])
    bx, by = float(points[b, 0] - points[d, 0]), float(points[b, 1] - points[d, 1])
    cx, cy = float(points[c, 0] - points[d, 0]), float(points[c, 1] - points[d, 1])
    a2, b2, c2 = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    value = a2 * (bx * cy - by * cx) - b2 * (ax * cy - ay * cx) + c2 * (ax * by - ay * bx)
    size = a2 * (abs(bx * cy) + abs(by * cx)) + b2 * (abs(ax * cy) + abs(ay * cx)) + c2 * (abs(ax * by) + abs(ay * bx))
    return value > DELAUNAY_CIRCLE_SLACK * size


@kernel()
def _opposite_corner(adjacent, u, t):
    """The corner of triangle u opposite the edge that it shares with t."""
    if adjacent[u, 0] == t:
        return 0
    return 1 if adjacent[u, 1] == t else 2


@kernel()
def _relink(adjacent, u, old, new):
    """Replace a neighbour of triangle u; -1 is none."""
    if u >= 0:
        adjacent[u, _opposite_corner(adjacent, u, old)] = new


@kernel()
def flip(tri, adjacent, constrained, incident, t, k):
    """Flip the edge opposite corner k of t: (a, b, c), (d, c, b) become (a, b, d), (d, c, a).

    Args:
        tri, adjacent, constrained, incident: See the module.
        t: Triangle.
        k: Corner.
    """
    u = adjacent[t, k]
    j = _opposite_corner(adjacent, u, t)
    k1, k2, j1, j2 = (k + 1) % 3, (k + 2) % 3, (j + 1) % 3, (j + 2) % 3
    a, b, c, d = tri[t, k], tri[t, k1], tri[t, k2], tri[u, j]
    over_ca, over_ab, over_bd, over_dc = adjacent[t, k1], adjacent[t, k2], adjacent[u, j1], adjacent[u, j2]
    fixed_ca, fixed_ab = constrained[t, k1], constrained[t, k2]
    fixed_bd, fixed_dc = constrained[u, j1], constrained[u, j2]
    tri[t, 0], tri[t, 1], tri[t, 2] = a, b, d
    adjacent[t, 0], adjacent[t, 1], adjacent[t, 2] = over_bd, u, over_ab
    constrained[t, 0], constrained[t, 1], constrained[t, 2] = fixed_bd, 0, fixed_ab
    tri[u, 0], tri[u, 1], tri[u, 2] = d, c, a
    adjacent[u, 0], adjacent[u, 1], adjacent[u, 2] = over_ca, t, over_dc
    constrained[u, 0], constrained[u, 1], constrained[u, 2] = fixed_ca, 0, fixed_dc
    _relink(adjacent, over_bd, u, t)
    _relink(adjacent, over_ca, t, u)
    incident[a], incident[b], incident[d], incident[c] = t, t, t, u


@kernel()
def _is_legal(points, tri, adjacent, constrained, t, k):
    """Whether the edge opposite corner k of triangle t satisfies Delaunay's criterion or may not be flipped."""
    u = adjacent[t, k]
    if u < 0 or constrained[t, k]:
        return True
    a, b, c = tri[t, k], tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
    d = tri[u, _opposite_corner(adjacent, u, t)]
    if not _in_circle(points, a, b, c, d):
        return True
    return twice_signed_area(points, a, b, d) <= 0 or twice_signed_area(points, d, c, a) <= 0


@kernel()
def _legalise(points, tri, adjacent, constrained, incident, changed, stamp, stack, top):
    """Flip until every edge on the stack is legal; `changed` (m,) is set to `stamp` for triangles that change.

    The first `top` rows of the stack are (triangle, corner), the corner being the new point.
    """
    while top > 0:
        top -= 1
        t, k = stack[top]
        if _is_legal(points, tri, adjacent, constrained, t, k):
            continue
        u = adjacent[t, k]
        flip(tri, adjacent, constrained, incident, t, k)
        changed[t], changed[u] = stamp, stamp
        stack[top, 0], stack[top, 1] = t, 0
        stack[top + 1, 0], stack[top + 1, 1] = u, 2
        top += 2


@kernel()
def insert_point(points, p, t, tri, adjacent, constrained, incident, count, changed, stamp, stack):
    """Insert a point inside a triangle or on an edge: new triangles take rows count and count + 1.

    On an edge between two triangles the degenerate third is flipped away. On a border or constrained edge it is
    dropped, and its row has corners -1.

    Args:
        points, tri, adjacent, constrained, incident: See the module.
        p: The point.
        t: The triangle that contains it.
        count: Number of triangles.
        changed: (m,) set to `stamp` for triangles that change.
        stamp: A mark.
        stack: Scratch, as in `_legalise`.
    """
    a, b, c = tri[t, 0], tri[t, 1], tri[t, 2]
    over_a, over_b, over_c = adjacent[t, 0], adjacent[t, 1], adjacent[t, 2]
    fixed_a, fixed_b, fixed_c = constrained[t, 0], constrained[t, 1], constrained[t, 2]
    t1, t2 = count, count + 1
    tri[t, 2] = p
    tri[t1, 0], tri[t1, 1], tri[t1, 2] = b, c, p
    tri[t2, 0], tri[t2, 1], tri[t2, 2] = c, a, p
    adjacent[t, 0], adjacent[t, 1], adjacent[t, 2] = t1, t2, over_c
    adjacent[t1, 0], adjacent[t1, 1], adjacent[t1, 2] = t2, t, over_a
    adjacent[t2, 0], adjacent[t2, 1], adjacent[t2, 2] = t, t1, over_b
    constrained[t, 0], constrained[t, 1], constrained[t, 2] = 0, 0, fixed_c
    constrained[t1, 0], constrained[t1, 1], constrained[t1, 2] = 0, 0, fixed_a
    constrained[t2, 0], constrained[t2, 1], constrained[t2, 2] = 0, 0, fixed_b
    _relink(adjacent, over_a, t, t1)
    _relink(adjacent, over_b, t, t2)
    incident[a], incident[b], incident[c], incident[p] = t, t, t1, t
    top = 0
    for s in (t, t1, t2):
        changed[s] = stamp
    for s in (t, t1, t2):
        if twice_signed_area(points, tri[s, 0], tri[s, 1], tri[s, 2]) > 0:
            stack[top, 0], stack[top, 1] = s, 2
            top += 1
            continue
        u = adjacent[s, 2]
        if u >= 0 and not constrained[s, 2]:
            flip(tri, adjacent, constrained, incident, s, 2)
            changed[u] = stamp
            stack[top, 0], stack[top, 1] = s, 0
            stack[top + 1, 0], stack[top + 1, 1] = u, 2
            top += 2
        else:
            _drop_triangle(tri, adjacent, incident, s)
    _legalise(points, tri, adjacent, constrained, incident, changed, stamp, stack, top)


@kernel()
def _drop_triangle(tri, adjacent, incident, t):
    """Remove triangle t: its edges become borders."""
    for k in range(3):
        u = adjacent[t, k]
        if u >= 0:
            adjacent[u, _opposite_corner(adjacent, u, t)] = -1
    for k in range(3):
        for j in (1, 2):
            u = adjacent[t, (k + j) % 3]
            if incident[tri[t, k]] == t and u >= 0:
                incident[tri[t, k]] = u
    for k in range(3):
        tri[t, k], adjacent[t, k] = -1, -1


@kernel()
def delaunay_triangulate(points, tri, adjacent, constrained, incident, alias):
    """Delaunay triangulation of points, the first four of which are a rectangle around all others.

    Args:
        points: (n, 2); the rectangle in the order of positive area.
        tri, adjacent, constrained: (2 n, 3), written.
        incident: (n,), written.
        alias: (n,) the point itself, or an earlier one at the same place, written.

    Returns:
        The number of triangles.
    """
    tri[0, 0], tri[0, 1], tri[0, 2] = 0, 1, 2
    tri[1, 0], tri[1, 1], tri[1, 2] = 0, 2, 3
    adjacent[:2] = -1
    adjacent[0, 1], adjacent[1, 2] = 1, 0
    incident[0], incident[1], incident[2], incident[3] = 0, 0, 0, 1
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
                if twice_signed_area(points, tri[t, (k + 1) % 3], tri[t, (k + 2) % 3], p) < 0:
                    t = adjacent[t, k]
                    moved = True
                    break
        alias[p] = p
        for k in range(3):
            q = tri[t, k]
            if points[q, 0] == points[p, 0] and points[q, 1] == points[p, 1]:
                alias[p] = q
        if alias[p] == p:
            insert_point(points, p, t, tri, adjacent, constrained, incident, count, changed, 1, stack)
            count += 2
            t = incident[p]
    return count


@kernel()
def _find_edge(tri, adjacent, incident, a, b):
    """The (triangle, opposite corner) of the edge between a and b, from one of its sides.

    The edge must exist, and not both ends may lie on the border.
    """
    for p, q in ((a, b), (b, a)):
        t = incident[p]
        while t >= 0:
            k = 0 if tri[t, 0] == p else 1 if tri[t, 1] == p else 2
            if tri[t, (k + 1) % 3] == q:
                return t, (k + 2) % 3
            t = adjacent[t, (k + 1) % 3]
            if t == incident[p]:
                break
    return -1, -1


@kernel()
def _first_crossing(points, tri, adjacent, incident, a, b):
    """The triangle at a through which the segment to b leaves, and the next point exactly on the segment.

    The point is -1 if the segment crosses the edge opposite a.
    """
    t = incident[a]
    while True:
        k = 0 if tri[t, 0] == a else 1 if tri[t, 1] == a else 2
        first, second = tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
        if first == b:
            return t, b
        on = twice_signed_area(points, a, b, first)
        if on == 0:
            ahead_x = (points[b, 0] - points[a, 0]) * (points[first, 0] - points[a, 0])
            if ahead_x + (points[b, 1] - points[a, 1]) * (points[first, 1] - points[a, 1]) > 0:
                return t, first
        if on < 0 and twice_signed_area(points, a, b, second) > 0:
            return t, -1
        t = adjacent[t, (k + 1) % 3]


@kernel()
def _crossed_edges(points, tri, adjacent, constrained, incident, a, b, edges):
    """The number of edges that the segment from a towards b crosses, and the point on it at which that ends.

    The edges are written to `edges`, rows of two points. If one of them is constrained, the result is (-1, its mark).
    """
    t, target = _first_crossing(points, tri, adjacent, incident, a, b)
    if target >= 0:
        return 0, target
    k = 0 if tri[t, 0] == a else 1 if tri[t, 1] == a else 2
    count = 0
    while True:
        if constrained[t, k]:
            return -1, constrained[t, k]
        right, left = tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
        edges[count, 0], edges[count, 1] = right, left
        count += 1
        u = adjacent[t, k]
        j = _opposite_corner(adjacent, u, t)
        apex = tri[u, j]
        on = twice_signed_area(points, a, b, apex)
        if on == 0:
            return count, apex
        t = u
        k = (j + 2) % 3 if on < 0 else (j + 1) % 3  # leave between apex and left, or between right and apex


@kernel()
def insert_segments(points, tri, adjacent, constrained, incident, segments, line, alias, clash):
    """Make every segment a constrained edge, or a chain of them through points on it.

    Args:
        points, tri, adjacent, constrained, incident: See the module.
        segments: (s, 2) points.
        line: (s,) index of the line to which each segment belongs; its edges are marked with 1 + that.
        alias: Of `delaunay_triangulate`.
        clash: (lines,) bool, set for lines with a segment that crosses another where there is no point. The later
            segment is left out.
    """
    edges = np.empty((tri.shape[0] * 3, 2), np.int64)
    for s in range(segments.shape[0]):
        a, b = alias[segments[s, 0]], alias[segments[s, 1]]
        while a != b:
            count, target = _crossed_edges(points, tri, adjacent, constrained, incident, a, b, edges)
            if count < 0:
                clash[line[s]] = clash[target - 1] = True
                break
            head = 0
            while count > 0:
                p, q = edges[head, 0], edges[head, 1]
                head = (head + 1) % edges.shape[0]
                count -= 1
                t, k = _find_edge(tri, adjacent, incident, p, q)
                p, q = tri[t, (k + 1) % 3], tri[t, (k + 2) % 3]
                u = adjacent[t, k]
                c, d = tri[t, k], tri[u, _opposite_corner(adjacent, u, t)]
                # whether the quad is not convex yet
                again = twice_signed_area(points, c, p, d) <= 0 or twice_signed_area(points, d, q, c) <= 0
                if not again:
                    flip(tri, adjacent, constrained, incident, t, k)
                    over = twice_signed_area(points, a, target, c) > 0 > twice_signed_area(points, a, target, d)
                    under = twice_signed_area(points, a, target, c) < 0 < twice_signed_area(points, a, target, d)
                    again = over or under
                    p, q = c, d
                if again:
                    tail = (head + count) % edges.shape[0]
                    edges[tail, 0], edges[tail, 1] = p, q
                    count += 1
            t, k = _find_edge(tri, adjacent, incident, a, target)
            constrained[t, k] = 1 + line[s]
            u = adjacent[t, k]
            constrained[u, _opposite_corner(adjacent, u, t)] = 1 + line[s]
            a = target


@kernel()
def restore_delaunay(points, tri, adjacent, constrained, incident, count):
    """Flip until every edge that is not constrained is legal.

    Args:
        points, tri, adjacent, constrained, incident: See the module.
        count: Number of triangles.
    """
    again = True
    while again:
        again = False
        for t in range(count):
            for k in range(3):
                if not _is_legal(points, tri, adjacent, constrained, t, k):
                    flip(tri, adjacent, constrained, incident, t, k)
                    again = True
