"""What vertices carry, once all faces are known: inverse depth over a plane, texture coordinates.

Predictions are sums of float64 numbers in a fixed order; only +, -, *, / and the square root, which IEEE 754 rounds
alike everywhere, so that every decoder finds the same.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import math

import numpy as np

from eigenfield.coding.entropy.range_kernels import binary_digits, code_integer
from eigenfield.coding.mesh.corner_kernels import CORNERS, MAPPED, MIRRORED
from eigenfield.runtime.jit import kernel

VALUE_MAX_STEPS = 2.0**20  # of lattice coordinates, either way
VALUE_MAX_NEIGHBOURS = 16  # of a vertex, that predict its value
FAR = 6  # classes of a difference of predictions, either way
DIFFERENCES = 2 * FAR + 1
SPREADS = 14
LAST = 20
DEPTH = CORNERS
TEXTURE = DEPTH + DIFFERENCES * DIFFERENCES + SPREADS * LAST + DIFFERENCES * SPREADS
CONTEXTS = TEXTURE + 2 * 24 * 3 + 24 * 24 + 24 * 2
M_DEPTH, M_U = 12, 13  # and one more for v
MIXTURES = 16


@kernel()
def _round_steps(value, other):
    """The nearest whole number within VALUE_MAX_STEPS; that of `other` for NaN."""
    if value != value:
        value = other
    return np.int64(math.floor(min(max(value, -VALUE_MAX_STEPS), VALUE_MAX_STEPS) + 0.5))


@kernel()
def _difference_class(value):
    size = abs(value)
    rank = 0
    for edge in (0.5, 1.5, 3.0, 6.0, 12.0, 30.0):
        if size >= edge:
            rank += 1
    return FAR - rank if value < 0.0 else FAR + rank


@kernel()
def _beside(faces, corner, step):
    return np.int64(faces[corner // 3, (corner % 3 + step) % 3])


@kernel()
def _add_moments(points, vertex, other, sums):
    """Moments of the height over the plane round `vertex`, weighted by 1 / (1 + squared distance)."""
    dx = float(points[other, 0] - points[vertex, 0])
    dy = float(points[other, 1] - points[vertex, 1])
    z = float(points[other, 2])
    w = 1.0 / (1.0 + dx * dx + dy * dy)
    sums[0] += w
    sums[1] += w * dx
    sums[2] += w * dy
    sums[3] += w * dx * dx
    sums[4] += w * dx * dy
    sums[5] += w * dy * dy
    sums[6] += w * z
    sums[7] += w * dx * z
    sums[8] += w * dy * z


@kernel()
def _plane_at_origin(sums):
    """The value at the vertex of the plane with the least squared error; a ridge of 1 holds the slopes."""
    w, x, y = sums[0], sums[1], sums[2]
    xx, xy, yy = sums[3] + 1.0, sums[4], sums[5] + 1.0
    z, xz, yz = sums[6], sums[7], sums[8]
    a, b, c = xx * yy - xy * xy, x * yy - xy * y, x * xy - xx * y
    return (z * a - xz * b + yz * c) / (w * a - x * b + y * c)


@kernel()
def code_depths(coder, built, first, corners):
    """z of every vertex over its x and y: predicted by the plane through earlier vertices up to two edges away, in
    contexts of how far off the mean of its neighbours and the plane of the parent face are."""
    points, faces, parents = built.points, built.faces, built.parents
    sums = np.zeros(9)
    last, low_all, high_all = 0, 0.0, 0.0
    for vertex in range(points.shape[0]):
        sums[:] = 0.0
        total, weight = 0.0, 0.0
        low, high = np.int64(2**40), np.int64(-(2**40))
        for i in range(first[vertex], min(first[vertex + 1], first[vertex] + VALUE_MAX_NEIGHBOURS)):
            for step in range(1, 3):
                near = _beside(faces, corners[i], step)
                if near >= vertex:
                    continue
                dx = float(points[near, 0] - points[vertex, 0])
                dy = float(points[near, 1] - points[vertex, 1])
                w = 1.0 / (1.0 + dx * dx + dy * dy)
                total += w * points[near, 2]
                weight += w
                low, high = min(low, points[near, 2]), max(high, points[near, 2])
                _add_moments(points, vertex, near, sums)
                for j in range(first[near], min(first[near + 1], first[near] + VALUE_MAX_NEIGHBOURS)):
                    for other_step in range(1, 3):
                        far = _beside(faces, corners[j], other_step)
                        if far < vertex:
                            _add_moments(points, vertex, far, sums)
        spread = SPREADS - 1
        mean = float(points[vertex - 1, 2]) if vertex > 0 else 0.0
        plane, parent = mean, mean
        if weight > 0.0:
            spread = min(binary_digits(high - low), SPREADS - 2)
            mean = total / weight
            plane = min(max(_plane_at_origin(sums), low_all), high_all)
            parent = mean
        a, b, o = np.int64(parents[vertex, 0]), np.int64(parents[vertex, 1]), np.int64(parents[vertex, 2])
        if a >= 0:
            ux, uy = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1]
            vx, vy = points[o, 0] - points[a, 0], points[o, 1] - points[a, 1]
            px, py = points[vertex, 0] - points[a, 0], points[vertex, 1] - points[a, 1]
            area = float(ux * vy - uy * vx)
            if area != 0.0:
                s, t = float(px * vy - py * vx) / area, float(ux * py - uy * px) / area
                za, zb, zo = points[a, 2], points[b, 2], points[o, 2]
                parent = min(max(za + s * (zb - za) + t * (zo - za), low_all), high_all)
        value = _round_steps(plane, mean)
        one, other = _difference_class(parent - value), _difference_class(mean - value)
        off = code_integer(
            coder, points[vertex, 2] - value, DEPTH + one * DIFFERENCES + other,
            DEPTH + DIFFERENCES * DIFFERENCES + spread * LAST + last,
            DEPTH + DIFFERENCES * DIFFERENCES + SPREADS * LAST + one * SPREADS + spread, M_DEPTH,
        )  # fmt: skip
        points[vertex, 2] = value + off
        last = min(binary_digits(abs(off)), LAST - 1)
        low_all = float(points[vertex, 2]) if vertex == 0 else min(low_all, float(points[vertex, 2]))
        high_all = float(points[vertex, 2]) if vertex == 0 else max(high_all, float(points[vertex, 2]))


@kernel()
def _similar(world, place, uv, vertex, a, b, mirrored, out):
    """out (2,): where `vertex` is in the texture if the triangle a, b, vertex has the same shape there."""
    ee, ef, ff = 0.0, 0.0, 0.0
    for axis in range(3):
        e = world[place[b], axis] - world[place[a], axis]
        f = world[place[vertex], axis] - world[place[a], axis]
        ee += e * e
        ef += e * f
        ff += f * f
    du, dv = float(uv[b, 0] - uv[a, 0]), float(uv[b, 1] - uv[a, 1])
    s = ef / ee
    h = math.sqrt(max(ff / ee - s * s, 0.0))
    if mirrored:
        h = -h
    out[0] = uv[a, 0] + s * du - h * dv
    out[1] = uv[a, 1] + s * dv + h * du


@kernel()
def code_textures(coder, vertices, world, uv, first, corners):
    """Texture coordinates uv (n, 2) int64 of the vertices in charts that have no map: the mean of what faces with two
    earlier corners predict, or else an earlier corner's; world (places, 3) float64 are decoded positions."""
    faces, charts = vertices.faces, vertices.chart
    guess = np.zeros(2)
    last = np.zeros(2, np.int64)
    before = -1
    for vertex in range(uv.shape[0]):
        kind = vertices.kinds[charts[vertex]]
        if kind == MAPPED:
            continue
        u, v, count, anchor = 0.0, 0.0, 0, -1
        reach = 0
        for i in range(first[vertex], min(first[vertex + 1], first[vertex] + VALUE_MAX_NEIGHBOURS)):
            a, b = _beside(faces, corners[i], 1), _beside(faces, corners[i], 2)
            if a < vertex and charts[a] == charts[vertex]:
                anchor = max(anchor, a)
            if b < vertex and charts[b] == charts[vertex]:
                anchor = max(anchor, b)
            if a < vertex and b < vertex:
                _similar(world, vertices.place, uv, vertex, a, b, kind == MIRRORED, guess)
                if guess[0] - guess[0] == 0.0 and guess[1] - guess[1] == 0.0:
                    u += guess[0]
                    v += guess[1]
                    count += 1
                    reach = max(reach, binary_digits(abs(uv[a, 0] - uv[b, 0]) + abs(uv[a, 1] - uv[b, 1])))
        if anchor < 0:
            anchor = before
        before = vertex
        pu = float(uv[anchor, 0]) if anchor >= 0 else 0.0
        pv = float(uv[anchor, 1]) if anchor >= 0 else 0.0
        if count > 0:
            pu, pv = u / count, v / count
        iu, iv = _round_steps(pu, 0.0), _round_steps(pv, 0.0)
        many, size = min(count, 2), min(reach, 23)
        for axis in range(2):
            expected = iu if axis == 0 else iv
            slot = TEXTURE + 2 * 24 * 3
            off = code_integer(
                coder, uv[vertex, axis] - expected, TEXTURE + (axis * 24 + size) * 3 + many, slot + last[0] * 24 + size,
                slot + 24 * 24 + axis * 24 + last[axis], M_U + axis,
            )  # fmt: skip
            uv[vertex, axis] = expected + off
            last[axis] = min(binary_digits(abs(off)), 23)
