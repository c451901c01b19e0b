"""Half-edge collapses of a relief, as in Hoppe ("Progressive meshes", 1996), cheapest first by `raster_kernels`.

A vertex collapses onto one beside it: the faces between them vanish, its others go along. What is left are vertices of
the given mesh, whose positions on its lattice are cheap to code.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.geometry.raster_kernels import face_cost
from eigenfield.imaging.graph import face_edges
from eigenfield.runtime.jit import kernel

INSIDE, BORDER, FIXED = 0, 1, 2  # where a vertex is; FIXED: it stays, where borders meet
COLLAPSE_MAX_FACES = 64  # at a vertex: beyond, nothing collapses onto it


class CollapseState(NamedTuple):
    """A mesh in the atlas while it shrinks.

    Attributes:
        places: (n, 2) int64 of the vertices, in steps of the texels.
        depth: (n,) float64.
        faces: (m, 3) int32, -1 first where one is gone.
        head: (n,) int32, the first of a vertex' corners 3 face + k, -1 for none.
        after: (3 m,) int32, the next corner at the same vertex.
        where: (n,) uint8, INSIDE, BORDER or FIXED.
    """

    places: NDArray[np.int64]
    depth: NDArray[np.float64]
    faces: NDArray[np.int32]
    head: NDArray[np.int32]
    after: NDArray[np.int32]
    where: NDArray[np.uint8]


def collapse_state(places: NDArray[np.int64], exact: NDArray[np.float64], faces: NDArray[np.int32]) -> CollapseState:
    """The state before any collapse. Fixed are vertices where borders or two charts meet, which would come apart."""
    n, corners = len(places), faces.reshape(-1)
    order = np.argsort(corners, kind="stable").astype(np.int32)
    last = np.flatnonzero(np.diff(corners[order])) if len(order) else np.zeros(0, np.int64)
    head, after = np.full(n, -1, np.int32), np.full(len(corners), -1, np.int32)
    head[corners[order[np.r_[0, last + 1]]]] = order[np.r_[0, last + 1]]
    along = np.setdiff1d(np.arange(len(order) - 1), last)
    after[order[along]] = order[along + 1]
    ends, edge = face_edges(faces)
    count = np.bincount(edge)[edge]
    borders = np.bincount(ends[count == 1].reshape(-1), minlength=n)
    where = np.where(borders == 0, INSIDE, np.where(borders == 2, BORDER, FIXED)).astype(np.uint8)
    where[ends[count > 2].reshape(-1)] = FIXED
    _, same, many = np.unique(np.rint(exact), axis=0, return_inverse=True, return_counts=True)
    where[many[same.reshape(-1)] > 1] = FIXED
    return CollapseState(places, exact[:, 2].copy(), faces.copy(), head, after, where)


@kernel()
def _has(faces, f, v):
    return faces[f, 0] == v or faces[f, 1] == v or faces[f, 2] == v


@kernel()
def _corners_after(faces, f, u, v):
    """Corners of a face once u has collapsed onto v."""
    a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
    return v if a == u else a, v if b == u else b, v if c == u else c


@kernel()
def _sense(places, a, b, c):
    area = (places[b, 0] - places[a, 0]) * (places[c, 1] - places[a, 1]) - (places[b, 1] - places[a, 1]) * (
        places[c, 0] - places[a, 0]
    )
    return np.sign(area)


@kernel()
def _ring(state, u, members, marks, stamp):
    """The vertices beside u into `members`, marked with `stamp`; how many there are, and how many faces."""
    count, crowd = 0, 0
    corner = state.head[u]
    while corner >= 0:
        f = corner // 3
        if state.faces[f, 0] >= 0:
            crowd += 1
            for k in range(3):
                beside = state.faces[f, k]
                if beside != u and marks[beside] != stamp:
                    marks[beside] = stamp
                    members[count] = beside
                    count += 1
        corner = state.after[corner]
    return count, crowd


@kernel()
def _may_collapse(state, u, v, ring, count, marks, stamps, beside):
    """Whether u may collapse onto v: the mesh stays a manifold (the link condition), borders move along themselves, no
    face turns over."""
    shared = 0
    corner = state.head[u]
    while corner >= 0:
        f = corner // 3
        if state.faces[f, 0] >= 0:
            if _has(state.faces, f, v):
                shared += 1
            else:
                a, b, c = _corners_after(state.faces, f, u, v)
                sense = _sense(state.places, state.faces[f, 0], state.faces[f, 1], state.faces[f, 2])
                if sense == 0 or _sense(state.places, a, b, c) != sense:
                    return False
        corner = state.after[corner]
    if state.where[u] == BORDER and (shared != 1 or state.where[v] == INSIDE):
        return False
    if state.where[u] == INSIDE and shared != 2:
        return False
    stamps[0] += 1
    _, crowd = _ring(state, v, beside, marks, stamps[0])
    if crowd > COLLAPSE_MAX_FACES:
        return False
    both = 0
    for i in range(count):
        both += marks[ring[i]] == stamps[0]
    return both == shared


@kernel()
def _own_cost(cost_map, state, u):
    """Less the cost of the faces at u, as they are."""
    total = 0.0
    corner = state.head[u]
    while corner >= 0:
        f = corner // 3
        if state.faces[f, 0] >= 0:
            a, b, c = state.faces[f, 0], state.faces[f, 1], state.faces[f, 2]
            total -= face_cost(cost_map, state.places, state.depth, a, b, c, 0, False)
        corner = state.after[corner]
    return total


@kernel()
def _inside_change(cost_map, state, u, v, own, most):
    """By how much the cost grows if u, which is no border, collapses onto v: the same texels stay covered.

    own: of `_own_cost`. most: what is no less need not be known further.
    """
    total = own
    corner = state.head[u]
    while corner >= 0 and total < most:
        f = corner // 3
        if state.faces[f, 0] >= 0 and not _has(state.faces, f, v):
            a, b, c = _corners_after(state.faces, f, u, v)
            total += face_cost(cost_map, state.places, state.depth, a, b, c, 0, False)
        corner = state.after[corner]
    return total


@kernel()
def _border_change(cost_map, state, u, v):
    """By how much the cost grows if u, at a border, collapses onto v."""
    total = 0.0
    for turn in range(4):  # faces out, in as they will be; and back again
        corner = state.head[u]
        while corner >= 0:
            f = corner // 3
            if state.faces[f, 0] >= 0:
                if turn == 0 or turn == 3:
                    a, b, c = state.faces[f, 0], state.faces[f, 1], state.faces[f, 2]
                    cost = face_cost(
                        cost_map, state.places, state.depth, a, b, c, 1 if turn == 3 else -1, turn == 0
                    )  # fmt: skip
                    total -= cost if turn == 0 else 0.0
                elif not _has(state.faces, f, v):
                    a, b, c = _corners_after(state.faces, f, u, v)
                    cost = face_cost(
                        cost_map, state.places, state.depth, a, b, c, 1 if turn == 1 else -1, turn == 1
                    )  # fmt: skip
                    total += cost if turn == 1 else 0.0
            corner = state.after[corner]
    return total


@kernel()
def _best_target(cost_map, state, u, limit, ring, beside, marks, stamps):
    """The cheapest collapse of u that costs less than `limit`: its cost, and onto which vertex, -1 for none."""
    least, target = limit, np.int64(-1)
    if state.where[u] == FIXED or state.head[u] < 0:
        return least, target
    stamps[0] += 1
    count, crowd = _ring(state, u, ring, marks, stamps[0])
    if crowd > COLLAPSE_MAX_FACES:
        return least, target
    inside = state.where[u] == INSIDE
    own = _own_cost(cost_map, state, u) if inside else 0.0
    for i in range(count):
        if _may_collapse(state, u, ring[i], ring, count, marks, stamps, beside):
            if inside:
                cost = _inside_change(cost_map, state, u, ring[i], own, least)
            else:
                cost = _border_change(cost_map, state, u, ring[i])
            if cost < least:
                least, target = cost, np.int64(ring[i])
    return least, target


@kernel()
def _collapse_edge(cost_map, state, u, v):
    """Collapse u onto v."""
    first = np.int32(-1)
    for end in (u, v):
        corner = np.int64(state.head[end])
        while corner >= 0:
            f, following = corner // 3, np.int64(state.after[corner])
            if state.faces[f, 0] >= 0:
                if end == u:
                    a, b, c = state.faces[f, 0], state.faces[f, 1], state.faces[f, 2]
                    face_cost(cost_map, state.places, state.depth, a, b, c, -1, False)
                    if _has(state.faces, f, v):
                        state.faces[f, 0] = -1
                    else:
                        state.faces[f, corner % 3] = v
                        a, b, c = state.faces[f, 0], state.faces[f, 1], state.faces[f, 2]
                        face_cost(cost_map, state.places, state.depth, a, b, c, 1, False)
                if state.faces[f, 0] >= 0:
                    state.after[corner] = first
                    first = np.int32(corner)
            corner = following
    state.head[u] = -1
    state.head[v] = first


@kernel()
def collapse(cost_map, state, limit):
    """Collapse vertices, the cheapest first, while one costs less than `limit` (squared error, by a vertex' bytes).

    cost_map: its `cover` is that of the state. Returns (g, 2) int32, each vertex and the one that it collapsed onto, in
    their order, and the (g,) costs. With a lower limit they are the same up to the first that costs as much.
    """
    n = state.places.shape[0]
    marks, stamps, version = np.zeros(n, np.int64), np.zeros(1, np.int64), np.zeros(n, np.int64)
    ring, beside = np.empty(n, np.int64), np.empty(n, np.int64)
    collapses, costs = np.empty((n, 2), np.int32), np.empty(n)
    heap = [(0.0, np.int64(0), np.int64(0), np.int64(0))]
    heap.clear()
    for vertex in range(n):
        cost, target = _best_target(cost_map, state, vertex, limit, ring, beside, marks, stamps)
        if target >= 0:
            heapq.heappush(heap, (cost, np.int64(vertex), target, np.int64(0)))
    gone = 0
    while len(heap) > 0:
        cost, u, v, at = heapq.heappop(heap)
        if version[u] != at:
            continue
        _collapse_edge(cost_map, state, u, v)
        version[u] += 1
        collapses[gone, 0], collapses[gone, 1], costs[gone] = u, v, cost
        gone += 1
        stamps[0] += 1
        count, _ = _ring(state, v, beside, marks, stamps[0])
        again = np.append(beside[:count], v)
        for w in again:
            version[w] += 1
            cost, target = _best_target(cost_map, state, w, limit, ring, beside, marks, stamps)
            if target >= 0:
                heapq.heappush(heap, (cost, np.int64(w), target, version[w]))
    return collapses[:gone], costs[:gone]


@kernel()
def collapsed_faces(faces, collapses):
    """Faces (m, 3) int32 after collapses (g, 2) as of `collapse`; -1 first where one is gone."""
    onto = np.arange(faces.max() + 1 if faces.size else 0)
    for i in range(len(collapses) - 1, -1, -1):
        onto[collapses[i, 0]] = onto[collapses[i, 1]]
    result = np.empty_like(faces)
    for f in range(faces.shape[0]):
        a, b, c = onto[faces[f, 0]], onto[faces[f, 1]], onto[faces[f, 2]]
        gone = a == b or b == c or c == a
        result[f, 0], result[f, 1], result[f, 2] = -1 if gone else a, b, c
    return result
