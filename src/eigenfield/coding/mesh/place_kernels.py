"""Where a vertex is, in lattice steps, as soon as it comes: predicted from the gate over which it comes."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math

import numpy as np

from eigenfield.coding.entropy.range_kernels import binary_digits, code_flag, code_integer, code_raw
from eigenfield.runtime.jit import kernel

PLACE_MAX_STEPS = 2**20  # of lattice coordinates, either way
HEIGHT_RATIO = 0.8  # of a predicted triangle to its base, in a plane
SIZES = 24  # classes of binary digits of squared lengths, in a plane
DEEP = 44  # likewise, in space
PAIRS = 169  # classes of both neighbours of a gate
X, Y, SPACE = 0, 0 + SIZES * 8 + SIZES + PAIRS, 0
REST = Y + SIZES * 8 + 16 * 8 + SIZES * 8
FLAT = REST + 16 + 4 + PAIRS  # contexts of a plane
START = max(FLAT, SPACE + DEEP + 3 * 24 + 3 * DEEP)
PLACES = START + 3 * 3
M_X, M_Y, M_SPACE, M_START, M_REST = 0, 1, 2, 3, 15


@kernel()
def _clamp_steps(value):
    """The nearest whole number within PLACE_MAX_STEPS."""
    return np.int64(math.floor(min(max(value, -float(PLACE_MAX_STEPS)), float(PLACE_MAX_STEPS)) + 0.5))


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
def off_grid(points, vertex, fine):
    """1 if x is no multiple of 2^fine, plus 2 if y is not; of 2 if fine is 0."""
    mask = np.int64(max((1 << fine) - 1, 1))
    return np.int64(points[vertex, 0] & mask != 0) + 2 * np.int64(points[vertex, 1] & mask != 0)


@kernel()
def _code_flat(coder, points, vertex, a, b, o, pair, fine):
    """x and y: predicted HEIGHT_RATIO times the gate's length in front of its middle, in units of 2^fine; then whether
    there is more to them than these, and how much."""
    gx, gy = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1]
    hx, hy = points[o, 0] - points[a, 0], points[o, 1] - points[a, 1]
    area = gx * hy - gy * hx
    out = HEIGHT_RATIO if area > 0 else -HEIGHT_RATIO
    x = _clamp_steps((points[a, 0] + points[b, 0]) * 0.5 + out * gy)
    y = _clamp_steps((points[a, 1] + points[b, 1]) * 0.5 - out * gx)
    half = np.int64(1 << fine >> 1)
    size = min(binary_digits((gx * gx + gy * gy) >> 2 * fine), SIZES - 1)
    spread = min(binary_digits(abs(area) >> 2 * fine), SIZES - 1)
    way = _octant(gx, gy)
    x, y = (x + half) >> fine, (y + half) >> fine
    dx = ((points[vertex, 0] + half) >> fine) - x
    dx = code_integer(coder, dx, X + size * 8 + way, X + SIZES * 8 + spread, X + SIZES * 9 + pair, M_X)
    amount = min(binary_digits(abs(dx)), 7)
    sign = np.int64(dx > 0)
    second, third = Y + SIZES * 8, Y + SIZES * 8 + 16 * 8
    dy = ((points[vertex, 1] + half) >> fine) - y
    dy = code_integer(
        coder, dy, Y + size * 8 + way, second + (amount * 2 + sign) * 8 + way, third + spread * 8 + amount, M_Y
    )
    rest_x = points[vertex, 0] - (((points[vertex, 0] + half) >> fine) << fine)
    rest_y = points[vertex, 1] - (((points[vertex, 1] + half) >> fine) << fine)
    points[vertex, 0], points[vertex, 1] = (x + dx) << fine, (y + dy) << fine
    if fine == 0:
        return
    near = off_grid(points, a, fine) + 4 * off_grid(points, b, fine)
    more = np.int64(rest_x != 0 or rest_y != 0)
    if code_flag(coder, more, REST + near, REST + 16 + off_grid(points, o, fine), REST + 20 + pair, M_REST):
        points[vertex, 0] += code_raw(coder, rest_x + half, fine) - half
        points[vertex, 1] += code_raw(coder, rest_y + half, fine) - half


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
        expected = _clamp_steps(float(points[a, axis] + points[b, axis] - points[o, axis]))
        off = code_integer(
            coder, points[vertex, axis] - expected, SPACE + size, SPACE + DEEP + axis * 24 + last,
            SPACE + DEEP + 72 + axis * DEEP + size, M_SPACE,
        )  # fmt: skip
        points[vertex, axis] = expected + off
        last = min(binary_digits(abs(off)), 23)


@kernel()
def code_place(coder, built, vertex, pair, planar, fine):
    """The place of a new vertex, from the gate over which it comes: x and y in a plane, x, y and z in space."""
    parents = built.parents
    a, b, o = np.int64(parents[vertex, 0]), np.int64(parents[vertex, 1]), np.int64(parents[vertex, 2])
    if planar:
        _code_flat(coder, built.points, vertex, a, b, o, pair, fine)
    else:
        _code_deep(coder, built.points, vertex, a, b, o)


@kernel()
def code_seed_place(coder, built, vertex, near, planar):
    """The place of a vertex of a patch's first face: its difference from vertex `near`, from 0 for the first of all."""
    points = built.points
    for axis in range(2 if planar else 3):
        base = min(max(points[near, axis], -PLACE_MAX_STEPS), PLACE_MAX_STEPS) if near >= 0 else np.int64(0)
        slot = START + axis
        points[vertex, axis] = base + code_integer(
            coder, points[vertex, axis] - base, slot, slot + 3, slot + 6, M_START
        )
