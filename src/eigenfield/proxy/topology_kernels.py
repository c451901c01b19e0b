"""The triangulation of a hole, and the winding of neighbours."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel


@kernel()
def _twice_area(a, b, c):
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    return np.sqrt(x * x + y * y + z * z)


@kernel()
def triangulate_least_area(loop):
    """The triangulation of a closed polygon with the least area.

    Dynamic programming over runs of the loop (Barequet and Sharir, "Filling gaps in the boundary of a polyhedron",
    1995): W[i, k] = min over i < j < k of W[i, j] + W[j, k] + area(i, j, k), in O(n^3).

    Args:
        loop: (n, 3) float64.

    Returns:
        (n - 2, 3) int64.
    """
    n = loop.shape[0]
    weight = np.zeros((n, n))
    split = np.zeros((n, n), np.int64)
    for length in range(2, n):
        for i in range(n - length):
            k = i + length
            best = np.inf
            for j in range(i + 1, k):
                w = weight[i, j] + weight[j, k] + _twice_area(loop[i], loop[j], loop[k])
                if w < best:
                    best = w
                    split[i, k] = j
            weight[i, k] = best
    triangles = np.empty((max(n - 2, 0), 3), np.int64)
    stack = np.empty((n + 1, 2), np.int64)
    stack[0, 0], stack[0, 1] = 0, n - 1
    height, count = 1, 0
    while height > 0:
        height -= 1
        i, k = stack[height, 0], stack[height, 1]
        if k - i < 2:
            continue
        j = split[i, k]
        triangles[count, 0], triangles[count, 1], triangles[count, 2] = i, j, k
        count += 1
        stack[height, 0], stack[height, 1] = i, j
        stack[height + 1, 0], stack[height + 1, 1] = j, k
        height += 2
    return triangles[:count]


@kernel()
def wind_alike(first, neighbour, against):
    """Which faces to turn so that neighbours are wound alike, breadth first; of each patch the fewer.

    Args:
        first: (m + 1,) where each face's neighbours begin.
        neighbour: Faces.
        against: Whether the neighbour is wound the other way.

    Returns:
        (m,) bool. In a patch with one side only, as a Möbius strip, some neighbours stay different.
    """
    count = first.size - 1
    turned, seen = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
    queue = np.empty(count, np.int64)
    for root in range(count):
        if seen[root]:
            continue
        seen[root] = True
        queue[0] = root
        done, found, many = 0, 1, 0
        while done < found:
            face = queue[done]
            done += 1
            many += turned[face]
            for k in range(first[face], first[face + 1]):
                other = neighbour[k]
                if not seen[other]:
                    seen[other] = True
                    turned[other] = turned[face] != against[k]
                    queue[found] = other
                    found += 1
        if 2 * many > found:
            for k in range(found):
                turned[queue[k]] = not turned[queue[k]]
    return turned
