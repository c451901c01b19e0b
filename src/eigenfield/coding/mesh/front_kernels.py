"""The growing border of the triangles that are coded so far: gates, which are directed edges, linked into loops.

A gate start -> end runs as the face behind it does, whose third corner is `opposite`; the face in front of it runs it
from end to start. Gates wait in a heap: the next is the one whose middle has the least x (then y, in lattice steps), so
that the border sweeps over the mesh as one front and seldom meets itself.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.jit import kernel

CLOSED, OPEN, BORDER = 0, 1, 2  # of Front.status
GATES, WAITING = 0, 1  # of Front.sizes
ROW = 2**24  # more than twice any sum of two coordinates


class Front(NamedTuple):
    """Gates: the directed edges of the front between coded and open faces.

    Attributes:
        start: (3 m,) int32 vertices.
        end: (3 m,) int32 vertices.
        opposite: (3 m,) int32, the third vertex of the coded face.
        before: (3 m,) int32 neighbours in the loop.
        after: (3 m,) int32 neighbours in the loop.
        status: (3 m,) int8, CLOSED, OPEN or BORDER.
        into: (n,) int32, the gate that ended last at a vertex, or -1.
        heap: (3 m,) int32 waiting gates.
        key: (3 m,) int64 of the places of their middles.
        sizes: (2,) int64, the numbers of gates and of waiting ones.
    """

    start: NDArray[np.int32]
    end: NDArray[np.int32]
    opposite: NDArray[np.int32]
    before: NDArray[np.int32]
    after: NDArray[np.int32]
    status: NDArray[np.int8]
    into: NDArray[np.int32]
    heap: NDArray[np.int32]
    key: NDArray[np.int64]
    sizes: NDArray[np.int64]


def new_front(vertices: int, faces: int) -> Any:
    """No gates yet."""
    room = 3 * faces
    start, end, opposite, before, after, heap = (np.zeros(room, np.int32) for _ in range(6))
    into = np.full(vertices, -1, np.int32)
    status, key = np.zeros(room, np.int8), np.zeros(room, np.int64)
    return Front(start, end, opposite, before, after, status, into, heap, key, np.zeros(2, np.int64))


@kernel()
def add_gate(front, points, start, end, opposite):
    """A new gate, waiting, linked to nothing; its number."""
    gate = front.sizes[GATES]
    front.sizes[GATES] = gate + 1
    front.start[gate], front.end[gate], front.opposite[gate] = start, end, opposite
    front.status[gate] = OPEN
    front.into[end] = gate
    key = (points[start, 0] + points[end, 0]) * ROW + points[start, 1] + points[end, 1]
    at = front.sizes[WAITING]
    front.sizes[WAITING] = at + 1
    while at > 0:
        parent = (at - 1) // 2
        if front.key[parent] <= key:
            break
        front.heap[at], front.key[at] = front.heap[parent], front.key[parent]
        at = parent
    front.heap[at], front.key[at] = gate, key
    return gate


@kernel()
def next_gate(front):
    """The next open gate, taken out of the heap; -1 if there is none."""
    heap, keys = front.heap, front.key
    while front.sizes[WAITING] > 0:
        gate = heap[0]
        size = front.sizes[WAITING] - 1
        front.sizes[WAITING] = size
        last, key = heap[size], keys[size]
        at = 0
        while 2 * at + 1 < size:
            child = 2 * at + 1
            if child + 1 < size and keys[child + 1] < keys[child]:
                child += 1
            if keys[child] >= key:
                break
            heap[at], keys[at] = heap[child], keys[child]
            at = child
        heap[at], keys[at] = last, key
        if front.status[gate] == OPEN:
            return np.int64(gate)
    return np.int64(-1)


@kernel()
def link(front, one, other):
    """Let gate `other` follow gate `one`."""
    front.after[one] = other
    front.before[other] = one


@kernel()
def open_patch(front, points, corner):
    """The gates round the first face of a patch; corner: (3,) its vertices."""
    first = front.sizes[GATES]
    for k in range(3):
        add_gate(front, points, corner[k], corner[(k + 1) % 3], corner[(k + 2) % 3])
    for k in range(3):
        link(front, first + k, first + (k + 1) % 3)


@kernel()
def close_left(front, points, gate):
    """The face in front of `gate` ends at the start of the gate before it: one gate takes the place of both, none if
    the gate behind ends there too."""
    left, right = front.before[gate], front.after[gate]
    vertex = front.start[left]
    front.status[gate] = CLOSED
    front.status[left] = CLOSED
    if front.status[right] == OPEN and front.end[right] == vertex and right != left:
        front.status[right] = CLOSED
        link(front, front.before[left], front.after[right])
        return
    before = front.before[left]
    new = add_gate(front, points, vertex, front.end[gate], front.start[gate])
    link(front, before, new)
    link(front, new, right)


@kernel()
def close_right(front, points, gate):
    """As `close_left`, at the end of the gate behind."""
    left, right = front.before[gate], front.after[gate]
    front.status[gate] = CLOSED
    front.status[right] = CLOSED
    after = front.after[right]
    new = add_gate(front, points, front.start[gate], front.end[right], front.end[gate])
    link(front, left, new)
    link(front, new, after)


@kernel()
def open_out(front, points, gate, vertex):
    """The face in front of `gate` ends at a new vertex, or at one elsewhere: two gates take its place. Where a loop
    passes through `vertex`, the loops are joined there, or the loop is divided."""
    left, right, there = front.before[gate], front.after[gate], front.into[vertex]
    front.status[gate] = CLOSED
    one = add_gate(front, points, front.start[gate], vertex, front.end[gate])
    other = add_gate(front, points, vertex, front.end[gate], front.start[gate])
    if there >= 0 and front.status[there] != CLOSED:
        link(front, one, front.after[there])
        link(front, there, other)
    else:
        link(front, one, other)
    link(front, left, one)
    link(front, other, right)
    front.into[vertex] = one
