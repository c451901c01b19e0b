"""A relief's vertices taken away one by one, each time the one that is worth least: half-edge collapses, as in Hoppe
("Progressive meshes", 1996), by what the pictures lose (`raster_kernels`).

A vertex falls onto one beside it: the faces between them vanish, its others go along. What is left are vertices of the
given mesh, which stand where it is cheap to say.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.geometry.raster_kernels import face_cost
from eigenfield.runtime.jit import kernel

INSIDE, BORDER, KEPT = 0, 1, 2  # where a vertex is; KEPT: it stays, where borders meet
CROWD = 64  # faces at a vertex beyond which nothing falls


class Sheet(NamedTuple):
    """A mesh in the atlas while it shrinks.

    places: (n, 2) int64. depth: (n,) float64. faces: (m, 3) int32, -1 first where one is gone. head: (n,) int32, the
    first of a vertex' corners 3 face + k, -1 for none; after: (3 m,) int32, the next. where: (n,) uint8.
    """

    places: NDArray[np.int64]
    depth: NDArray[np.float64]
    faces: NDArray[np.int32]
    head: NDArray[np.int32]
    after: NDArray[np.int32]
    where: NDArray[np.uint8]


@kernel()
def _has(faces, f, v):
    return faces[f, 0] == v or faces[f, 1] == v or faces[f, 2] == v


@kernel()
def _moved(faces, f, u, v):
    """Corners of a face once u has fallen onto v."""
    a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
    return v if a == u else a, v if b == u else b, v if c == u else c


@kernel()
def _sense(places, a, b, c):
    area = (places[b, 0] - places[a, 0]) * (places[c, 1] - places[a, 1]) - (places[b, 1] - places[a, 1]) * (
        places[c, 0] - places[a, 0]
    )
    return np.sign(area)


@kernel()
def _ring(sheet, u, members, marks, stamp):
    """The vertices beside u into `members`, marked with `stamp`; how many there are, and how many faces."""
    count, crowd = 0, 0
    corner = sheet.head[u]
    while corner >= 0:
        f = corner // 3
        if sheet.faces[f, 0] >= 0:
            crowd += 1
            for k in range(3):
                beside = sheet.faces[f, k]
                if beside != u and marks[beside] != stamp:
                    marks[beside] = stamp
                    members[count] = beside
                    count += 1
        corner = sheet.after[corner]
    return count, crowd


@kernel()
def _may_fall(sheet, u, v, ring, count, marks, stamps, beside):
    """Whether u may fall onto v: the mesh stays a sheet (the link condition), borders move along themselves, no face
    turns over."""
    shared = 0
    corner = sheet.head[u]
    while corner >= 0:
        f = corner // 3
        if sheet.faces[f, 0] >= 0:
            if _has(sheet.faces, f, v):
                shared += 1
            else:
                a, b, c = _moved(sheet.faces, f, u, v)
                sense = _sense(sheet.places, sheet.faces[f, 0], sheet.faces[f, 1], sheet.faces[f, 2])
                if sense == 0 or _sense(sheet.places, a, b, c) != sense:
                    return False
        corner = sheet.after[corner]
    if sheet.where[u] == BORDER and (shared != 1 or sheet.where[v] == INSIDE):
        return False
    if sheet.where[u] == INSIDE and shared != 2:
        return False
    stamps[0] += 1
    _, crowd = _ring(sheet, v, beside, marks, stamps[0])
    if crowd > CROWD:
        return False
    both = 0
    for i in range(count):
        both += marks[ring[i]] == stamps[0]
    return both == shared


@kernel()
def _change(ground, sheet, u, v):
    """By how much the cost grows if u falls onto v."""
    border = sheet.where[u] != INSIDE  # else the same texels stay covered
    add = 1 if border else 0
    total = 0.0
    for turn in range(4 if border else 2):  # faces out, in as they will be; and back again
        corner = sheet.head[u]
        while corner >= 0:
            f = corner // 3
            if sheet.faces[f, 0] >= 0:
                if turn == 0 or turn == 3:
                    a, b, c = sheet.faces[f, 0], sheet.faces[f, 1], sheet.faces[f, 2]
                    cost = face_cost(
                        ground, sheet.places, sheet.depth, a, b, c, add if turn == 3 else -add, border and turn == 0
                    )
                    total -= cost if turn == 0 else 0.0
                elif not _has(sheet.faces, f, v):
                    a, b, c = _moved(sheet.faces, f, u, v)
                    cost = face_cost(
                        ground, sheet.places, sheet.depth, a, b, c, add if turn == 1 else -add, border and turn == 1
                    )
                    total += cost if turn == 1 else 0.0
            corner = sheet.after[corner]
    return total


@kernel()
def _best(ground, sheet, u, ring, beside, marks, stamps):
    """The cheapest fall of u: what it costs, and onto which vertex, -1 for none."""
    least, target = np.inf, np.int64(-1)
    if sheet.where[u] == KEPT or sheet.head[u] < 0:
        return least, target
    stamps[0] += 1
    count, crowd = _ring(sheet, u, ring, marks, stamps[0])
    if crowd > CROWD:
        return least, target
    for i in range(count):
        if _may_fall(sheet, u, ring[i], ring, count, marks, stamps, beside):
            cost = _change(ground, sheet, u, ring[i])
            if cost < least:
                least, target = cost, np.int64(ring[i])
    return least, target


@kernel()
def _fall(ground, sheet, u, v):
    """Let u fall onto v."""
    first = np.int32(-1)
    for end in (u, v):
        corner = np.int64(sheet.head[end])
        while corner >= 0:
            f, following = corner // 3, np.int64(sheet.after[corner])
            if sheet.faces[f, 0] >= 0:
                if end == u:
                    a, b, c = sheet.faces[f, 0], sheet.faces[f, 1], sheet.faces[f, 2]
                    face_cost(ground, sheet.places, sheet.depth, a, b, c, -1, False)
                    if _has(sheet.faces, f, v):
                        sheet.faces[f, 0] = -1
                    else:
                        sheet.faces[f, corner % 3] = v
                        a, b, c = sheet.faces[f, 0], sheet.faces[f, 1], sheet.faces[f, 2]
                        face_cost(ground, sheet.places, sheet.depth, a, b, c, 1, False)
                if sheet.faces[f, 0] >= 0:
                    sheet.after[corner] = first
                    first = np.int32(corner)
            corner = following
    sheet.head[u] = -1
    sheet.head[v] = first


@kernel()
def collapse(ground, sheet, worth):
    """Take vertices away, the most rewarding first, while what the pictures lose is less than `worth`, squared error,
    of a vertex' bytes. `ground.cover` is that of the sheet. Returns who fell onto whom (g, 2) int32 in their order, and
    what each cost (g,): for less worth, the same up to the first that costs as much."""
    n = sheet.places.shape[0]
    marks, stamps, version = np.zeros(n, np.int64), np.zeros(1, np.int64), np.zeros(n, np.int64)
    ring, beside = np.empty(n, np.int64), np.empty(n, np.int64)
    falls, costs = np.empty((n, 2), np.int32), np.empty(n)
    heap = [(0.0, np.int64(0), np.int64(0), np.int64(0))]
    heap.clear()
    for vertex in range(n):
        cost, target = _best(ground, sheet, vertex, ring, beside, marks, stamps)
        if cost < worth:
            heapq.heappush(heap, (cost, np.int64(vertex), target, np.int64(0)))
    gone = 0
    while len(heap) > 0:
        cost, u, v, at = heapq.heappop(heap)
        if version[u] != at:
            continue
        _fall(ground, sheet, u, v)
        version[u] += 1
        falls[gone, 0], falls[gone, 1], costs[gone] = u, v, cost
        gone += 1
        stamps[0] += 1
        count, _ = _ring(sheet, v, beside, marks, stamps[0])
        again = np.append(beside[:count], v)
        for w in again:
            version[w] += 1
            cost, target = _best(ground, sheet, w, ring, beside, marks, stamps)
            if cost < worth:
                heapq.heappush(heap, (cost, np.int64(w), target, version[w]))
    return falls[:gone], costs[:gone]


@kernel()
def fallen(faces, falls):
    """Faces (m, 3) int32 once vertices have fallen, falls (g, 2) as of `collapse`; -1 first where one is gone."""
    onto = np.arange(faces.max() + 1 if faces.size else 0)
    for i in range(len(falls) - 1, -1, -1):
        onto[falls[i, 0]] = onto[falls[i, 1]]
    result = np.empty_like(faces)
    for f in range(faces.shape[0]):
        a, b, c = onto[faces[f, 0]], onto[faces[f, 1]], onto[faces[f, 2]]
        gone = a == b or b == c or c == a
        result[f, 0], result[f, 1], result[f, 2] = -1 if gone else a, b, c
    return result
