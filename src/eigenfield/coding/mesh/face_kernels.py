"""Faces one by one: what lies in front of each gate of the growing border. One body codes and decodes.

Vertices are numbered in the order in which they come. The contexts are what coder and decoder both see: how the
neighbours of the gate look from it, whether they are borders, how many faces its ends have.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.entropy.range_kernels import binary_digits, code_flag, code_raw
from eigenfield.coding.mesh.front_kernels import BORDER, OPEN, close_left, close_right, next_gate, open_out, open_patch
from eigenfield.coding.mesh.place_kernels import PLACES, code_place, code_seed_place, off_grid
from eigenfield.runtime.jit import kernel

ANGLES = 13  # classes of a neighbour of the gate
NO_GATE, AT_BORDER = 11, 12  # the last two of them
PAIRS = ANGLES * ANGLES
FANS = 8  # classes of numbers of faces at a vertex
LEFT = PLACES  # first contexts; those before are code_place's
RIGHT = LEFT + PAIRS + ANGLES * FANS + 2 * ANGLES
EDGE = RIGHT + PAIRS + ANGLES * FANS + ANGLES
FRESH = EDGE + 64 + FANS * FANS + PAIRS
SEED = FRESH + PAIRS + 4 + 1
FACES = SEED + 6  # all contexts so far
M_LEFT, M_RIGHT, M_EDGE, M_FRESH, M_SEED = 4, 5, 6, 7, 8


class Built(NamedTuple):
    """Faces between places as far as they are known, places in the order of the bytes.

    Attributes:
        points: (n, 3) int64 lattice coordinates.
        faces: (m, 3) int32.
        parents: (n, 3) int32, start, end and third corner of the gate over which a place came, or -1.
        fan: (n,) int32 faces at a place.
        counts: (2,) int64 places and faces so far.
    """

    points: NDArray[np.int64]
    faces: NDArray[np.int32]
    parents: NDArray[np.int32]
    fan: NDArray[np.int32]
    counts: NDArray[np.int64]


class Source(NamedTuple):
    """The mesh to be coded; of size 0 in decoding.

    Attributes:
        points: (n, 3) int64.
        faces: (m, 3) int32.
        seeds: (m,) int32, the faces in the order in which they may begin a patch.
        edges: (3 m,) int64, start * n + end of each face's edges, sorted.
        edge_faces: (3 m,) int32, the face of each edge.
        used: (m,) bool.
        number: (n,) int32, a place's in the bytes or -1.
        order: (n,) int32, the inverse of `number`.
        face_order: (m,) int32, likewise of faces.
    """

    points: NDArray[np.int64]
    faces: NDArray[np.int32]
    seeds: NDArray[np.int32]
    edges: NDArray[np.int64]
    edge_faces: NDArray[np.int32]
    used: NDArray[np.bool_]
    number: NDArray[np.int32]
    order: NDArray[np.int32]
    face_order: NDArray[np.int32]


def no_source() -> Any:
    """For a decoder."""
    i, j = np.zeros(0, np.int32), np.zeros(0, np.int64)
    return Source(j.reshape(0, 3), i.reshape(0, 3), i, j, i, np.zeros(0, np.bool_), i, i, i)


def new_built(places: int, faces: int) -> Any:
    """Nothing yet of a mesh of that size."""
    return Built(
        np.zeros((places, 3), np.int64), np.zeros((faces, 3), np.int32), np.full((places, 3), -1, np.int32),
        np.zeros(places, np.int32), np.zeros(2, np.int64),
    )  # fmt: skip


@kernel()
def _angle_class(points, a, b, vertex, o, planar):
    """How `vertex` looks as the third corner over the gate a -> b of a face with the third corner o: 0 on the same side
    as o, else 1 to 10 by the cotangent of its angle. Planar: in x and y alone."""
    ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
    vx, vy, vz = points[vertex, 0] - points[a, 0], points[vertex, 1] - points[a, 1], points[vertex, 2] - points[a, 2]
    ox, oy, oz = points[o, 0] - points[a, 0], points[o, 1] - points[a, 1], points[o, 2] - points[a, 2]
    if planar:
        uz, vz, oz = np.int64(0), np.int64(0), np.int64(0)
    nx, ny, nz = float(uy * vz - uz * vy), float(uz * vx - ux * vz), float(ux * vy - uy * vx)
    mx, my, mz = float(uy * oz - uz * oy), float(uz * ox - ux * oz), float(ux * oy - uy * ox)
    area = math.sqrt(nx * nx + ny * ny + nz * nz)
    if area == 0.0 or nx * mx + ny * my + nz * mz > 0.0:
        return 0
    cotangent = float(vx * (vx - ux) + vy * (vy - uy) + vz * (vz - uz)) / area
    edges = (-1.0, -0.4, 0.0, 0.3, 0.6, 0.9, 1.3, 2.0, 4.0)
    for k in range(9):
        if cotangent < edges[k]:
            return k + 1
    return 10


@kernel()
def _neighbour(front, points, gate, near, vertex, far, planar):
    """The class of a gate's neighbour `near`, by which the face in front might end at `vertex`; far: the gate's other
    end."""
    if front.status[near] == BORDER:
        return AT_BORDER
    if front.status[near] != OPEN or vertex == far or near == gate:
        return NO_GATE
    return _angle_class(points, front.start[gate], front.end[gate], vertex, front.opposite[gate], planar)


@kernel()
def _face_at(source, key):
    """The first face with the directed edge `key` that is not coded yet, or -1."""
    low, high = 0, source.edges.shape[0]
    while low < high:
        middle = (low + high) // 2
        if source.edges[middle] < key:
            low = middle + 1
        else:
            high = middle
    while low < source.edges.shape[0] and source.edges[low] == key:
        if not source.used[source.edge_faces[low]]:
            return np.int64(source.edge_faces[low])
        low += 1
    return np.int64(-1)


@kernel()
def _new_vertex(coder, source, built, given):
    """Room for a new vertex; in coding, `given` of the source."""
    new = built.counts[0]
    built.counts[0] = new + 1
    if coder.writing[0]:
        source.number[given] = new
        source.order[new] = given
        for axis in range(3):
            built.points[new, axis] = source.points[given, axis]
    return new


@kernel()
def _code_old(coder, built, vertex):
    """An earlier vertex, by its number; -1 if there is none of it."""
    vertex = code_raw(coder, vertex, binary_digits(built.counts[0] - 1))
    return vertex if vertex < built.counts[0] else np.int64(-1)


@kernel()
def _add_face(built, a, b, c):
    at = built.counts[1]
    built.counts[1] = at + 1
    built.faces[at, 0], built.faces[at, 1], built.faces[at, 2] = a, b, c
    built.fan[a] += 1
    built.fan[b] += 1
    built.fan[c] += 1


@kernel()
def _code_seed(coder, source, built, front, planar, room, face):
    """The first face of a patch: each corner is an earlier vertex or a new one. True if it is one."""
    corner = np.zeros(3, np.int64)
    for k in range(3):
        given = np.int64(source.faces[face, k]) if coder.writing[0] else np.int64(-1)
        old = np.int64(coder.writing[0] and source.number[given] >= 0)
        old = code_flag(coder, old, SEED + k, SEED + 3 + k, SEED + k, M_SEED) if built.counts[0] > 0 else np.int64(0)
        if old:
            corner[k] = _code_old(coder, built, np.int64(source.number[given]) if coder.writing[0] else np.int64(0))
            if corner[k] < 0:
                return False
        else:
            if built.counts[0] >= room:
                return False
            corner[k] = _new_vertex(coder, source, built, given)
            code_seed_place(coder, built, corner[k], corner[k - 1] if k > 0 else corner[k] - 1, planar)
    if corner[0] == corner[1] or corner[1] == corner[2] or corner[2] == corner[0]:
        return False
    _add_face(built, corner[0], corner[1], corner[2])
    open_patch(front, built.points, corner)
    return True


@kernel()
def traverse(coder, source, built, front, planar, fine):
    """Code or decode faces and the lattice coordinates of places (planar: x and y alone; most of them
    multiples of 2^fine); whether they can be."""
    points = built.points
    room = points.shape[0]
    writing = coder.writing[0]
    seed = 0
    while built.counts[1] < built.faces.shape[0]:
        gate = next_gate(front)
        if gate < 0:
            face = np.int64(-1)
            if writing:
                while source.used[source.seeds[seed]]:
                    seed += 1
                face = np.int64(source.seeds[seed])
                source.used[face] = True
                source.face_order[built.counts[1]] = face
            if not _code_seed(coder, source, built, front, planar, room, face):
                return False
            continue
        a, b = np.int64(front.start[gate]), np.int64(front.end[gate])
        left, right = front.before[gate], front.after[gate]
        start, end = np.int64(front.start[left]), np.int64(front.end[right])
        lc = _neighbour(front, points, gate, left, start, b, planar)
        rc = _neighbour(front, points, gate, right, end, a, planar)
        pair = lc * ANGLES + rc
        fa, fb = min(built.fan[a], FANS - 1), min(built.fan[b], FANS - 1)
        face, given, target = np.int64(-1), np.int64(-1), np.int64(-1)
        if writing:
            sa, sb = np.int64(source.order[a]), np.int64(source.order[b])
            face = _face_at(source, sb * source.points.shape[0] + sa)
            if face >= 0:
                source.used[face] = True
                source.face_order[built.counts[1]] = face
                for k in range(3):
                    corner = np.int64(source.faces[face, k])
                    if corner != sa and corner != sb:
                        given = corner
                target = np.int64(source.number[given])
        if lc < NO_GATE and code_flag(
            coder, np.int64(target == start), LEFT + pair, LEFT + PAIRS + lc * FANS + fa,
            LEFT + PAIRS + ANGLES * FANS + 2 * lc + np.int64(start == end), M_LEFT,
        ):  # fmt: skip
            _add_face(built, b, a, start)
            close_left(front, points, gate)
            continue
        if rc < NO_GATE and (end != start or lc >= NO_GATE) and code_flag(
            coder, np.int64(target == end), RIGHT + pair, RIGHT + PAIRS + rc * FANS + fb,
            RIGHT + PAIRS + ANGLES * FANS + rc, M_RIGHT,
        ):  # fmt: skip
            _add_face(built, b, a, end)
            close_right(front, points, gate)
            continue
        borders = np.int64(lc == AT_BORDER) + 2 * np.int64(rc == AT_BORDER)
        grid = off_grid(points, a, fine) + 4 * off_grid(points, b, fine)
        if code_flag(
            coder, np.int64(face < 0), EDGE + borders * 16 + grid, EDGE + 64 + fa * FANS + fb,
            EDGE + 64 + FANS * FANS + pair, M_EDGE,
        ):  # fmt: skip
            front.status[gate] = BORDER
            continue
        if code_flag(coder, np.int64(target < 0), FRESH + pair, FRESH + PAIRS + borders, FRESH + PAIRS + 4, M_FRESH):
            if built.counts[0] >= room:
                return False
            target = _new_vertex(coder, source, built, given)
            built.parents[target, 0], built.parents[target, 1] = a, b
            built.parents[target, 2] = front.opposite[gate]
            code_place(coder, built, target, pair, planar, fine)
        else:
            target = _code_old(coder, built, target)
            if target < 0 or target in (a, b):
                return False
        _add_face(built, b, a, target)
        open_out(front, points, gate, target)
    return built.counts[0] == room
