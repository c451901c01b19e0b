"""Ear clipping."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel


@kernel()
def _area_vector(vertices, a, b, c):
    """Twice the area of a triangle, as a vector along its normal."""
    ux, uy, uz = vertices[b, 0] - vertices[a, 0], vertices[b, 1] - vertices[a, 1], vertices[b, 2] - vertices[a, 2]
    vx, vy, vz = vertices[c, 0] - vertices[a, 0], vertices[c, 1] - vertices[a, 1], vertices[c, 2] - vertices[a, 2]
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx


@kernel()
def _turn(x, y, a, b, c):
    """Twice the signed area of the triangle a, b, c."""
    return (x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a])


@kernel()
def _is_ear(x, y, reflex, before, corner, after, following, least):
    """Whether no reflex corner of the rest lies in the triangle before, corner, after.

    least: twice the signed area that a corner inside makes with each side; a little below 0, the border is inside too,
    however it is rounded.
    """
    at = following[after]
    while at != before:
        other = reflex[at]
        for end in (before, corner, after):
            other = other and not (x[at] == x[end] and y[at] == y[end])
        other = other and _turn(x, y, before, corner, at) >= least and _turn(x, y, corner, after, at) >= least
        if other and _turn(x, y, after, before, at) >= least:
            return False
        at = following[at]
    return True


@kernel()
def _clip(x, y, first, triangles, begin):
    """Cut one polygon of the plane, whose area is positive; False if it crosses itself, so that an ear was missing."""
    n = x.size
    scale = (x.max() - x.min()) * (y.max() - y.min())
    flat = 1e-14 * scale
    following, preceding = np.empty(n, np.int64), np.empty(n, np.int64)
    for i in range(n):
        following[i], preceding[i] = (i + 1) % n, (i + n - 1) % n
    reflex = np.empty(n, np.bool_)
    for i in range(n):
        reflex[i] = _turn(x, y, preceding[i], i, following[i]) <= flat
    simple = True
    corner = 0
    for k in range(n - 2):
        ear, straight, widest, most = -1, -1, corner, -np.inf
        at = corner
        for _ in range(n - k):
            turn = _turn(x, y, preceding[at], at, following[at])
            if turn > flat and _is_ear(x, y, reflex, preceding[at], at, following[at], following, -flat):
                ear = at
                break
            if straight < 0 and abs(turn) <= flat:
                straight = at
            if turn > most:
                widest, most = at, turn
            at = following[at]
        if ear < 0:
            ear = straight
        if ear < 0:
            ear, simple = widest, False
        before, after = preceding[ear], following[ear]
        triangles[begin + k, 0], triangles[begin + k, 1], triangles[begin + k, 2] = (
            first + before, first + ear, first + after,
        )  # fmt: skip
        following[before], preceding[after] = after, before
        reflex[before] = _turn(x, y, preceding[before], before, after) <= flat
        reflex[after] = _turn(x, y, before, after, following[after]) <= flat
        corner = after
    return simple


@kernel()
def clip_ears(vertices, corners, first, size, begin, triangles):
    """Cut polygons into triangles by ear clipping.

    Args:
        vertices: (n, 3) float64.
        corners: (c,) vertices of the corners.
        first: (p,) first corner of each polygon.
        size: (p,) its number of corners.
        begin: (p,) its first row in `triangles`.
        triangles: (m, 3) corners; filled.

    Returns:
        How many of the polygons cross themselves.
    """
    crossing = 0
    for p in range(first.size):
        a, n = first[p], size[p]
        nx, ny, nz = 0.0, 0.0, 0.0
        for k in range(n - 2):
            tx, ty, tz = _area_vector(vertices, corners[a], corners[a + k + 1], corners[a + k + 2])
            nx, ny, nz = nx + tx, ny + ty, nz + tz
        one, other, along = 0, 1, nz
        if abs(nx) >= abs(ny) and abs(nx) >= abs(nz):
            one, other, along = 1, 2, nx
        elif abs(ny) >= abs(nz):
            one, other, along = 2, 0, ny
        x, y = np.empty(n), np.empty(n)
        for k in range(n):
            x[k] = vertices[corners[a + k], one]
            y[k] = vertices[corners[a + k], other] * (1.0 if along > 0 else -1.0)
        if not _clip(x, y, a, triangles, begin[p]):
            crossing += 1
    return crossing
