"""Kernels that every sum over photographs shares: where a row of points falls in one view, and what is there.

Points come in runs of at most `RUN` neighbours of one canvas row. A tap is taken in three loops: `place` (positions, in
vectors), `fetch` (memory, one by one) and the caller's arithmetic (in vectors again). Written as one loop the compiler
would leave it scalar, at a fifth of the speed. Scratch arrays are flat: slot k of point i is [k RUN + i], a distance
that the compiler knows.

A photograph is one uint32 a pixel (red in the lowest byte), so that a corner of the bilinear cell is one load.
"""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

RUN = 128
REAL_SLOTS = 4  # fraction x, fraction y, visibility limit, depth buffer
WHOLE_SLOTS = 6  # address of the cell, its four corners, address of the nearest pixel
OUTSIDE = np.float32(-1e30)
EMPTY = np.float32(-1e9)  # of a depth buffer: nothing there
EXACT = {"contract", "nnan", "nsz", "ninf", "arcp"}  # no re-association: sums keep their order
GUARDED = {"contract", "nsz"}  # where a NaN may come in and must be told from a number

_ONE, _ZERO, _HALF = np.float32(1), np.float32(0), np.float32(0.5)
_BYTE = np.uint32(255)


@kernel(fastmath=GUARDED)
def place(matrix, y, x, count, label, limit, height, width, real, whole):
    """Positions of points (x + i, y, label[i]) in the view of `matrix` (3, 4): p = M (x, y, d, 1), (p0, p1) / p2.

    limit[i]: the largest depth-buffer value that leaves the point visible; OUTSIDE is put in its place where the point
    falls outside the picture or behind the camera, or is no number. Addresses are always inside: such points take
    pixel 0.
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
        real[i] = px - f(column)
        real[i + RUN] = py - f(row)
        real[i + 2 * RUN] = limit[i] if inside else OUTSIDE
        whole[i] = np.uint32(row * wide + column)
        whole[i + 5 * RUN] = np.uint32(np.int32(py + _HALF) * wide + np.int32(px + _HALF))


@kernel(fastmath=EXACT)
def fetch(picture, buffer, width, count, real, whole):
    """The four corners of each point's cell, and the depth buffer at the nearest pixel (an empty one hides nothing)."""
    down = np.uint32(width)
    one = np.uint32(1)
    for i in range(count):
        at = whole[i]
        whole[i + RUN] = picture[at]
        whole[i + 2 * RUN] = picture[at + one]
        whole[i + 3 * RUN] = picture[at + down]
        whole[i + 4 * RUN] = picture[at + down + one]
    if buffer.size > 0:
        for i in range(count):
            real[i + 3 * RUN] = buffer[whole[i + 5 * RUN]]
    else:
        for i in range(count):
            real[i + 3 * RUN] = EMPTY


@kernel(inline=True)
def channel(whole, i, shift, w00, w01, w10, w11):
    """One colour channel (shift 0, 8 or 16) of point i's cell under bilinear weights."""
    s = np.uint32(shift)
    return (
        w00 * np.float32(np.int32((whole[i + RUN] >> s) & _BYTE))
        + w01 * np.float32(np.int32((whole[i + 2 * RUN] >> s) & _BYTE))
        + w10 * np.float32(np.int32((whole[i + 3 * RUN] >> s) & _BYTE))
        + w11 * np.float32(np.int32((whole[i + 4 * RUN] >> s) & _BYTE))
    )


@kernel(inline=True)
def weights(real, i):
    """Bilinear weights of the corners (top left, top right, bottom left, bottom right)."""
    fx, fy = real[i], real[i + RUN]
    w11 = fx * fy
    return _ONE - fx - fy + w11, fx - w11, fy - w11, w11


@kernel(inline=True)
def visible(real, i):
    """1 where the point is inside the picture and not hidden, else 0."""
    return _ONE if real[i + 3 * RUN] <= real[i + 2 * RUN] else _ZERO
