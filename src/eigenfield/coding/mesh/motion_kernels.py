"""Where moving vertices are in each frame of a group, on the lattice of the mesh; one body codes and decodes.

A vertex is expected to move as those of its neighbours that are known have moved: either in this frame, or beside what
each of them, and the vertex itself, did in the frame before. All of it is in whole numbers.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.coding.entropy.range_kernels import binary_digits, code_flag, code_integer
from eigenfield.runtime.jit import kernel

MOTION_MAX_STEPS = 2**20  # of lattice coordinates, either way
MAX_NEIGHBOURS = 8  # of a vertex that predict it
AXES, AGAIN = 7, 8  # of a frame's flags: the axes along which anything moves; what the frame before did counts too
SIZES = 12  # classes of a magnitude
TWIN, MANY, ONE, NONE = range(4)  # what predicts a vertex
NEAR = 4 * SIZES * SIZES
SPREAD = NEAR + 3 * 4 * SIZES
MOVES = SPREAD + 3 * SIZES * SIZES
CONTEXTS = MOVES + 7
M_MOVES = 3
MIXTURES = 4


@kernel()
def _size(value):
    return min(binary_digits(value), SIZES - 1)


@kernel()
def code_moving(coder, moves, near, starts):
    """Which vertices move, (v,) uint8 in place; near: those before that predict each, from starts (v + 1,) on."""
    before = np.int64(0)
    for vertex in range(moves.shape[0]):
        count = np.int64(0)
        total = starts[vertex + 1] - starts[vertex]
        for at in range(starts[vertex], starts[vertex + 1]):
            count += moves[near[at]]
        kind = 3 if total == 0 else 0 if count == 0 else 2 if count == total else 1
        a = MOVES + kind
        moves[vertex] = code_flag(coder, np.int64(moves[vertex]), a, MOVES + 4 + before, MOVES + 6, M_MOVES)
        before = np.int64(moves[vertex])


@kernel()
def _expect(steps, frame, vertex, axis, again, near, starts, out):
    """The lattice coordinate that is expected, and in out (1,) how much the neighbours differ. steps: the frame before
    the first stands at 0 and at 1."""
    low, high, total = np.int64(2**40), np.int64(-(2**40)), np.int64(0)
    first, last = starts[vertex], starts[vertex + 1]
    for at in range(first, last):
        other = near[at]
        moved = steps[frame, other, axis] - steps[frame - 1, other, axis]
        if again:
            moved -= steps[frame - 1, other, axis] - steps[frame - 2, other, axis]
        low, high, total = min(low, moved), max(high, moved), total + moved
    expected = steps[frame - 1, vertex, axis]
    if again:
        expected += expected - steps[frame - 2, vertex, axis]
    count = last - first
    out[0] = high - low if count > 0 else 0
    if count > 0:
        expected += (2 * total + count) // (2 * count)
    return min(max(expected, np.int64(-MOTION_MAX_STEPS)), np.int64(MOTION_MAX_STEPS))


@kernel()
def motion_cost(steps, frame, again, near, starts):
    """About how many bits what is not expected takes."""
    out = np.zeros(1, np.int64)
    cost = np.int64(0)
    for vertex in range(steps.shape[1]):
        for axis in range(3):
            off = steps[frame, vertex, axis] - _expect(steps, frame, vertex, axis, again, near, starts, out)
            cost += 2 * binary_digits(abs(off))
    return cost


@kernel()
def code_motion(coder, steps, flags, near, starts, twins):
    """Lattice coordinates steps (2 + T, n, 3) int64 of the vertices that move, in place from the third row on; before
    these the places in the mesh, twice.

    Args:
        flags: (T,) uint8 of each frame.
        near: The vertices before that predict each, from starts (n + 1,) on; of twins (n,) that are True it is one at
            the same place of the mesh.
    """
    vertices = steps.shape[1]
    off = np.zeros((2, vertices, 3), np.int64)
    out = np.zeros(1, np.int64)
    for number in range(flags.shape[0]):
        frame, flag = number + 2, np.int64(flags[number])
        now, before = number & 1, 1 - (number & 1)
        for vertex in range(vertices):
            first, last = starts[vertex], starts[vertex + 1]
            kind = TWIN if twins[vertex] else NONE if last == first else ONE if last == first + 1 else MANY
            for axis in range(3):
                if not (flag >> axis) & 1:
                    steps[frame, vertex, axis] = steps[frame - 1, vertex, axis]
                    off[now, vertex, axis] = 0
                    continue
                expected = _expect(steps, frame, vertex, axis, flag & AGAIN, near, starts, out)
                beside = np.int64(0)
                for at in range(first, last):
                    beside += abs(off[now, near[at], axis])
                if last > first:
                    beside = (4 * beside) // (last - first)
                a, b, c = _size(beside), _size(4 * abs(off[before, vertex, axis])), _size(out[0])
                wrong = code_integer(
                    coder, steps[frame, vertex, axis] - expected, (kind * SIZES + a) * SIZES + b,
                    NEAR + (axis * 4 + kind) * SIZES + c, SPREAD + (axis * SIZES + c) * SIZES + a, axis,
                )  # fmt: skip
                steps[frame, vertex, axis] = expected + wrong
                off[now, vertex, axis] = wrong
