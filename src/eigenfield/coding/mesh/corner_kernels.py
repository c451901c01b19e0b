"""Which of the vertices at a place each face's corner is, and the charts that vertices form.

A place of the surface has several vertices where the texture is cut. A face's corner most often is the vertex that a
neighbour across an edge has there.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.entropy.range_kernels import binary_digits, code_flag, code_raw
from eigenfield.coding.mesh.face_kernels import FACES
from eigenfield.runtime.jit import kernel

CORNER_MAX_FACES = 32  # at a place, that are searched
CHART_MAX_SEARCH = 256  # latest charts that are searched for the same map
CORNER_MAX_CHOICES = 4  # vertices of which each has a flag
UNKNOWN, AGREES, CUT, NONE = 0, 1, 2, 3  # what is known of the edge to a neighbour
ASKED = FACES
NEW = ASKED + CORNER_MAX_CHOICES * 16 + CORNER_MAX_CHOICES * 3 + 16
CHART = NEW + CORNER_MAX_CHOICES + 1
CORNERS = CHART + 4  # all contexts so far
M_ASKED, M_NEW, M_CHART = 9, 10, 11
PLAIN, MAPPED, MIRRORED = 0, 1, 2  # charts: texture coordinates coded; by an affine map; coded, and turned over


class Vertices(NamedTuple):
    """Vertices and charts as far as they are known.

    Attributes:
        faces: (m, 3) int32 vertices of the built faces' corners.
        place: (v,) int32.
        chart: (v,) int32.
        latest: (n,) int32, the vertex that came last at a place, or -1.
        older: (v,) int32, the vertex before it at the same place, or -1.
        kinds: (charts,) int8.
        maps: (charts, 6) int64, the bits of float32 numbers; or of those the first four, and the codes of two offsets.
        counts: (3,) int64 vertices and charts so far, and the number of the last chart with a map, plus 1.
    """

    faces: NDArray[np.int32]
    place: NDArray[np.int32]
    chart: NDArray[np.int32]
    latest: NDArray[np.int32]
    older: NDArray[np.int32]
    kinds: NDArray[np.int8]
    maps: NDArray[np.int64]
    counts: NDArray[np.int64]


class Corners(NamedTuple):
    """The vertices to be coded; of size 0 in decoding.

    Attributes:
        faces: (m, 3) int32, in the source's numbers.
        label: (v,) int32, the chart of a vertex, likewise.
        place: (v,) int32, in the bytes' numbers.
        kinds: (charts,) int8.
        maps: (charts, 6) int64.
        number: (v,) int32, a vertex's in the bytes or -1.
        order: (v,) int32, the inverse of `number`.
    """

    faces: NDArray[np.int32]
    label: NDArray[np.int32]
    place: NDArray[np.int32]
    kinds: NDArray[np.int8]
    maps: NDArray[np.int64]
    number: NDArray[np.int32]
    order: NDArray[np.int32]


def no_corners() -> Any:
    """For a decoder."""
    i = np.zeros(0, np.int32)
    return Corners(i.reshape(0, 3), i, i, np.zeros(0, np.int8), np.zeros((0, 6), np.int64), i, i)


def new_vertices(vertices: int, places: int, faces: int) -> Any:
    """None yet of so many."""
    charts = min(faces, vertices // 3)  # a chart begins with a face of three new vertices
    return Vertices(
        np.zeros((faces, 3), np.int32), np.zeros(vertices, np.int32), np.zeros(vertices, np.int32),
        np.full(places, -1, np.int32), np.zeros(vertices, np.int32), np.zeros(charts, np.int8),
        np.zeros((charts, 6), np.int64), np.zeros(3, np.int64),
    )  # fmt: skip


@kernel()
def corner_lists(faces, vertices):
    """(n + 1,) and (3 m,) int32: the corners (3 face + k) at every vertex, one vertex after the other."""
    first = np.zeros(vertices + 1, np.int32)
    for face in range(faces.shape[0]):
        for k in range(3):
            first[faces[face, k] + 1] += 1
    for vertex in range(vertices):
        first[vertex + 1] += first[vertex]
    at = first.copy()
    corners = np.zeros(3 * faces.shape[0], np.int32)
    for face in range(faces.shape[0]):
        for k in range(3):
            vertex = faces[face, k]
            corners[at[vertex]] = 3 * face + k
            at[vertex] += 1
    return first, corners


@kernel()
def _corner_of(faces, face, place):
    for k in range(3):
        if faces[face, k] == place:
            return k
    return -1


@kernel()
def _across(faces, first, corners, face, k):
    """The first face before `face` that has its edge k, or -1; of the first CORNER_MAX_FACES at its start."""
    a, b = faces[face, k], faces[face, (k + 1) % 3]
    for i in range(first[a], min(first[a + 1], first[a] + CORNER_MAX_FACES)):
        other = np.int64(corners[i] // 3)
        if other >= face:
            break
        if _corner_of(faces, other, b) >= 0:
            return other
    return np.int64(-1)


@kernel()
def _code_corner(coder, built, out, beside, state, face, k, vertex):
    """The vertex at corner k; -1 for a new one, -2 for what cannot be."""
    place = built.faces[face, k]
    known = np.int64(out.latest[place])
    if known < 0:
        return np.int64(-1)
    choice = np.full(CORNER_MAX_CHOICES, -1, np.int64)
    support = np.full((CORNER_MAX_CHOICES, 2), NONE, np.int64)
    count = 0
    for side in range(2):
        edge = k if side == 0 else (k + 2) % 3
        if beside[edge] < 0:
            continue
        candidate = np.int64(out.faces[beside[edge], _corner_of(built.faces, beside[edge], place)])
        if count == 1 and choice[0] == candidate:
            support[0, 1] = state[edge]
        else:
            choice[count] = candidate
            support[count, 0] = state[edge]
            count += 1
    for _ in range(CORNER_MAX_FACES):
        if count == CORNER_MAX_CHOICES or known < 0:
            break
        if (count < 1 or known != choice[0]) and (count < 2 or known != choice[1]):
            choice[count] = known
            count += 1
        known = np.int64(out.older[known])
    found = np.int64(-1)
    for j in range(count):
        one, two = support[j, 0], support[j, 1]
        third = ASKED + CORNER_MAX_CHOICES * 19 + min(count, 3) * 4 + one
        if code_flag(
            coder, np.int64(vertex == choice[j]), ASKED + j * 16 + one * 4 + two,
            ASKED + CORNER_MAX_CHOICES * 16 + j * 3 + k, third, M_ASKED,
        ):  # fmt: skip
            found = choice[j]
            break
    if found < 0:
        if code_flag(coder, np.int64(vertex < 0), NEW + count, NEW + count, NEW + CORNER_MAX_CHOICES, M_NEW):
            return np.int64(-1)
        found = code_raw(coder, vertex, binary_digits(out.counts[0] - 1))
        if found >= out.counts[0] or out.place[found] != place:
            return np.int64(-2)
    for side in range(2):
        edge = k if side == 0 else (k + 2) % 3
        if beside[edge] >= 0:
            theirs = out.faces[beside[edge], _corner_of(built.faces, beside[edge], place)]
            state[edge] = AGREES if theirs == found else CUT
    return found


@kernel()
def _code_chart(coder, source, out, given, offset_digits):
    """What a new chart is, and its map: that of an earlier chart, or the linear part of the last and an offset, or four
    float32 numbers and an offset. False for what cannot be."""
    chart = out.counts[1]
    out.counts[1] = chart + 1
    writing = coder.writing[0]
    kind = np.int64(source.kinds[source.label[given]]) if writing else np.int64(PLAIN)
    if not code_flag(coder, np.int64(kind == MAPPED), CHART, CHART, CHART, M_CHART):
        mirrored = code_flag(coder, np.int64(kind == MIRRORED), CHART + 1, CHART + 1, CHART + 1, M_CHART)
        out.kinds[chart] = MIRRORED if mirrored else PLAIN
        return True
    out.kinds[chart] = MAPPED
    if writing:
        for k in range(6):
            out.maps[chart, k] = source.maps[source.label[given], k]
    last, same = np.int64(out.counts[2]) - 1, np.int64(-1)
    out.counts[2] = chart + 1
    for other in range(max(0, chart - CHART_MAX_SEARCH), chart if writing else 0):
        alike = out.kinds[other] == MAPPED
        for k in range(6):
            alike = alike and out.maps[other, k] == out.maps[chart, k]
        if alike:
            same = np.int64(other)
    if last >= 0 and code_flag(coder, np.int64(same >= 0), CHART + 2, CHART + 2, CHART + 2, M_CHART):
        same = code_raw(coder, same, binary_digits(chart - 1))
        if same >= chart or out.kinds[same] != MAPPED:
            return False
        for k in range(6):
            out.maps[chart, k] = out.maps[same, k]
        return True
    linear = np.int64(last >= 0)
    if last >= 0:
        for k in range(4):
            if out.maps[chart, k] != out.maps[last, k]:
                linear = np.int64(0)
        linear = code_flag(coder, linear, CHART + 3, CHART + 3, CHART + 3, M_CHART)
    for k in range(6):
        if k < 4 and linear:
            out.maps[chart, k] = out.maps[last, k]
        else:
            out.maps[chart, k] = code_raw(coder, out.maps[chart, k], 32 if k < 4 else offset_digits)
    return True


@kernel()
def code_corners(coder, source, face_order, built, out, first, corners, offset_digits):
    """Code or decode the vertices of all corners, given corner lists of the built faces and the binary digits of a
    map's offset; whether they can be."""
    room = out.place.shape[0]
    beside, state = np.zeros(3, np.int64), np.zeros(3, np.int64)
    writing = coder.writing[0]
    given = np.zeros(3, np.int64)
    fresh = np.zeros(3, np.bool_)
    for face in range(built.faces.shape[0]):
        for k in range(3):
            beside[k] = _across(built.faces, first, corners, face, k)
            state[k] = UNKNOWN
        chart = np.int64(-1)
        for k in range(3):
            place = built.faces[face, k]
            vertex = np.int64(-1)
            if writing:
                for j in range(3):
                    if source.place[source.faces[face_order[face], j]] == place:
                        given[k] = source.faces[face_order[face], j]
                vertex = np.int64(source.number[given[k]])
            vertex = _code_corner(coder, built, out, beside, state, face, k, vertex)
            fresh[k] = vertex == -1
            if vertex == -1:
                vertex = out.counts[0]
                if vertex >= room:
                    return False
                out.counts[0] = vertex + 1
                out.place[vertex] = place
                out.older[vertex] = out.latest[place]
                out.latest[place] = vertex
                if writing:
                    source.number[given[k]] = vertex
                    source.order[vertex] = given[k]
            elif vertex < 0:
                return False
            else:
                chart = np.int64(out.chart[vertex])
            out.faces[face, k] = vertex
        if chart < 0:
            chart = out.counts[1]
            if not _code_chart(coder, source, out, given[0], offset_digits):
                return False
        for k in range(3):
            if fresh[k]:
                out.chart[out.faces[face, k]] = chart
    return out.counts[0] == room
