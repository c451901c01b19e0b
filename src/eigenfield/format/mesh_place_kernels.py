"""Where a vertex is, in lattice steps, as soon as it comes: predicted from the gate over which it comes."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math

import numpy as np

from eigenfield.format.range_kernels import binary_digits, code_integer
from eigenfield.jit import kernel

REACH = 2**20  # of lattice coordinates, either way
OUT = 0.8  # a triangle's height over its base, in a plane
SIZES = 24  # binary digits of squared lengths that are told apart, in a plane
DEEP = 44  # likewise, in space
PAIRS = 169  # classes of both neighbours of a gate
X, Y, SPACE = 0, 0 + SIZES * 8 + SIZES + PAIRS, 0
FLAT = Y + SIZES * 8 + 16 * 8 + SIZES * 8  # contexts of a plane
START = max(FLAT, SPACE + DEEP + 3 * 24 + 3 * DEEP)
PLACES = START + 3 * 3
M_X, M_Y, M_SPACE, M_START = 0, 1, 2, 3


@kernel()
def _bounded(value):
    """The nearest whole number within REACH."""
    return np.int64(math.floor(min(max(value, -float(REACH)), float(REACH)) + 0.5))


@kernel()
def _octant(dx, dy):
    octant = 0
    if dx < 0:
        octant += 1
        dx = -dx
    if dy < 0:
        octant += 2
        dy = -dy
    return octant + 4 if dy > dx else octant


@kernel()
def _code_flat(coder, points, vertex, a, b, o, pair):
    """x and y: predicted OUT times the gate's length in front of its middle."""
    gx, gy = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1]
    hx, hy = points[o, 0] - points[a, 0], points[o, 1] - points[a, 1]
    area = gx * hy - gy * hx
    out = OUT if area > 0 else -OUT
    x = _bounded((points[a, 0] + points[b, 0]) * 0.5 + out * gy)
    y = _bounded((points[a, 1] + points[b, 1]) * 0.5 - out * gx)
    size = min(binary_digits(gx * gx + gy * gy), SIZES - 1)
    spread = min(binary_digits(abs(area)), SIZES - 1)
    way = _octant(gx, gy)
    dx = points[vertex, 0] - x
    dx = code_integer(coder, dx, X + size * 8 + way, X + SIZES * 8 + spread, X + SIZES * 9 + pair, M_X)
    points[vertex, 0] = x + dx
    amount = min(binary_digits(abs(dx)), 7)
    sign = np.int64(dx > 0)
    second, third = Y + SIZES * 8, Y + SIZES * 8 + 16 * 8
    dy = points[vertex, 1] - y
    dy = code_integer(
        coder, dy, Y + size * 8 + way, second + (amount * 2 + sign) * 8 + way, third + spread * 8 + amount, M_Y
    )
    points[vertex, 1] = y + dy


@kernel()
def _code_deep(coder, points, vertex, a, b, o):
    """x, y and z by a parallelogram."""
    length = np.int64(0)
    for axis in range(3):
        side = points[b, axis] - points[a, axis]
        length += side * side
    size = min(binary_digits(length), DEEP - 1)
    last = 0
    for axis in range(3):
        expected = _bounded(float(points[a, axis] + points[b, axis] - points[o, axis]))
        off = code_integer(
            coder, points[vertex, axis] - expected, SPACE + size, SPACE + DEEP + axis * 24 + last,
            SPACE + DEEP + 72 + axis * DEEP + size, M_SPACE,
        )  # fmt: skip
        points[vertex, axis] = expected + off
        last = min(binary_digits(abs(off)), 23)


@kernel()
def code_place(coder, built, vertex, pair, planar):
    """The place of a new vertex, from the gate over which it comes: x and y in a plane, x, y and z in space."""
    parents = built.parents
    a, b, o = np.int64(parents[vertex, 0]), np.int64(parents[vertex, 1]), np.int64(parents[vertex, 2])
    if planar:
        _code_flat(coder, built.points, vertex, a, b, o, pair)
    else:
        _code_deep(coder, built.points, vertex, a, b, o)


@kernel()
def code_seed_place(coder, built, vertex, near, planar):
    """The place of a vertex of a patch's first face: its difference from vertex `near`, from 0 for the first of all."""
    points = built.points
    for axis in range(2 if planar else 3):
        base = min(max(points[near, axis], -REACH), REACH) if near >= 0 else np.int64(0)
        slot = START + axis
        points[vertex, axis] = base + code_integer(
            coder, points[vertex, axis] - base, slot, slot + 3, slot + 6, M_START
        )
