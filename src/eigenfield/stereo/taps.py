"""Kernels that every sum over photographs shares: where a run of points falls in one view, and the pixels there.

Points come in runs of at most TAP_RUN neighbours of one row. A run is sampled in three loops: `project_run` (positions,
vectorised), `fetch_run` (memory, one by one) and the caller's arithmetic (vectorised again). The compiler leaves a
single loop scalar, at a fifth of the speed. Scratch arrays are flat: slot k of point i is [k TAP_RUN + i], a distance
that the compiler knows.

A photograph is one uint32 a pixel (red in the lowest byte), so that a corner of the bilinear cell is one load. Where a
photograph smaller than the others ends, the highest byte says so: points beyond are hidden.
"""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

TAP_RUN = 128  # points
TAP_FLOAT_SLOTS = 4  # fraction x, fraction y, visibility limit, depth buffer
TAP_INT_SLOTS = 6  # address of the cell, its four corners, address of the nearest pixel
TAP_OUTSIDE_LIMIT = np.float32(-1e30)
EMPTY_DEPTH_LABEL = np.float32(-1e9)  # of a depth buffer where no point falls
HIDING_DEPTH_LABEL = np.float32(1e9)  # that hides every point
OUTSIDE_PIXEL = np.uint32(0xFF000000)  # of a packed picture: where no photograph is
FASTMATH_ORDERED = {"contract", "nnan", "nsz", "ninf", "arcp"}  # no re-association: sums keep their order
FASTMATH_NAN_SAFE = {"contract", "nsz"}  # where input may hold NaNs that must be recognised

_ONE, _ZERO, _HALF = np.float32(1), np.float32(0), np.float32(0.5)
_BYTE = np.uint32(255)


@kernel(fastmath=FASTMATH_NAN_SAFE)
def project_run(matrix, y, x, count, label, limit, height, width, floats, ints):
    """Positions of points (x + i, y, label[i]) in one view: p = M (x, y, d, 1), (p0, p1) / p2.

    Addresses always lie inside the picture: points outside it, behind the camera or NaN take pixel 0 and are marked as
    hidden by TAP_OUTSIDE_LIMIT.

    Args:
        matrix: M, (3, 4).
        y, x: Index coordinates of the first point.
        count: Number of points.
        label: (TAP_RUN,) labels.
        limit: (TAP_RUN,) largest depth-buffer value that leaves each point visible.
        height, width: Size of the view.
        floats: Scratch; slots 0 to 2 are written.
        ints: Scratch; slots 0 and 5 are written.
    """
    f = np.float32
    a0, a1, a2 = f(matrix[0, 0]), f(matrix[1, 0]), f(matrix[2, 0])
    d0, d1, d2 = f(matrix[0, 2]), f(matrix[1, 2]), f(matrix[2, 2])
    c0 = f(matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 3])
    c1 = f(matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 3])
    c2 = f(matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 3])
    right, bottom = f(width - 1), f(height - 1)
    last_x, last_y = right - f(0.004), bottom - f(0.004)
    wide = np.int32(width)
    for i in range(count):
        step = f(np.int32(i))
        d = label[i]
        z = a2 * step + d2 * d + c2
        inverse = _ONE / max(z, f(1e-6))
        px = (a0 * step + d0 * d + c0) * inverse
        py = (a1 * step + d1 * d + c1) * inverse
        inside = (z > f(1e-6)) & (px >= _ZERO) & (py >= _ZERO) & (px <= right) & (py <= bottom)
        px = min(px, last_x) if inside else _ZERO
        py = min(py, last_y) if inside else _ZERO
        column, row = np.int32(px), np.int32(py)
        floats[i] = px - f(column)
        floats[i + TAP_RUN] = py - f(row)
        floats[i + 2 * TAP_RUN] = limit[i] if inside else TAP_OUTSIDE_LIMIT
        ints[i] = np.uint32(row * wide + column)
        ints[i + 5 * TAP_RUN] = np.uint32(np.int32(py + _HALF) * wide + np.int32(px + _HALF))


@kernel(fastmath=FASTMATH_ORDERED)
def fetch_run(picture, buffer, width, count, floats, ints):
    """The four corners of each point's cell, and the depth buffer at the nearest pixel; outside it hides every point.

    Args:
        picture: (H W,) packed.
        buffer: (H W,) depth buffer; an empty one hides nothing.
        width: Of the view.
        count: Number of points.
        floats: Scratch of `project_run`; slot 3 is written.
        ints: Scratch of `project_run`; slots 1 to 4 are written.
    """
    down = np.uint32(width)
    one = np.uint32(1)
    for i in range(count):
        at = ints[i]
        ints[i + TAP_RUN] = picture[at]
        ints[i + 2 * TAP_RUN] = picture[at + one]
        ints[i + 3 * TAP_RUN] = picture[at + down]
        ints[i + 4 * TAP_RUN] = picture[at + down + one]
    if buffer.size > 0:
        for i in range(count):
            floats[i + 3 * TAP_RUN] = buffer[ints[i + 5 * TAP_RUN]]
    else:
        for i in range(count):
            floats[i + 3 * TAP_RUN] = EMPTY_DEPTH_LABEL
    for i in range(count):
        outside = (ints[i + TAP_RUN] | ints[i + 4 * TAP_RUN]) >= OUTSIDE_PIXEL  # photographs are rectangles
        floats[i + 3 * TAP_RUN] = HIDING_DEPTH_LABEL if outside else floats[i + 3 * TAP_RUN]


@kernel(inline=True)
def _bilinear_channel(ints, i, shift, w00, w01, w10, w11):
    s = np.uint32(shift)
    return (
        w00 * np.float32(np.int32((ints[i + TAP_RUN] >> s) & _BYTE))
        + w01 * np.float32(np.int32((ints[i + 2 * TAP_RUN] >> s) & _BYTE))
        + w10 * np.float32(np.int32((ints[i + 3 * TAP_RUN] >> s) & _BYTE))
        + w11 * np.float32(np.int32((ints[i + 4 * TAP_RUN] >> s) & _BYTE))
    )


@kernel(inline=True)
def bilinear_colour(floats, ints, i):
    """Red, green and blue of a point, bilinearly interpolated.

    Args:
        floats: Scratch of `fetch_run`.
        ints: Scratch of `fetch_run`.
        i: The point.
    """
    fx, fy = floats[i], floats[i + TAP_RUN]
    w11 = fx * fy
    w00, w01, w10 = _ONE - fx - fy + w11, fx - w11, fy - w11
    r = _bilinear_channel(ints, i, 0, w00, w01, w10, w11)
    g = _bilinear_channel(ints, i, 8, w00, w01, w10, w11)
    return r, g, _bilinear_channel(ints, i, 16, w00, w01, w10, w11)


@kernel(inline=True)
def is_visible(floats, i):
    """1 where the point is inside the picture and not hidden, else 0.

    Args:
        floats: Scratch of `fetch_run`.
        i: The point.
    """
    return _ONE if floats[i + 3 * TAP_RUN] <= floats[i + 2 * TAP_RUN] else _ZERO
