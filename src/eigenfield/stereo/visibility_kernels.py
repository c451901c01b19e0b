"""Depth buffers by splatting, and mean colours over the views that see a point."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel
from eigenfield.stereo.taps import (
    EMPTY,
    EXACT,
    GUARDED,
    REAL_SLOTS,
    RUN,
    WHOLE_SLOTS,
    channel,
    fetch,
    place,
    visible,
    weights,
)

_ONE, _ZERO = np.float32(1), np.float32(0)


@kernel(fastmath=GUARDED)
def splat(matrix, d, valid, buffer):
    """buffer (H, W): the largest d of the points that fall on a pixel; each point covers the 2 x 2 pixels round it."""
    height, width = buffer.shape
    f = np.float32
    buffer[:] = EMPTY
    a0, a1, a2 = f(matrix[0, 0]), f(matrix[1, 0]), f(matrix[2, 0])
    d0, d1, d2 = f(matrix[0, 2]), f(matrix[1, 2]), f(matrix[2, 2])
    for y in range(d.shape[0]):
        c0 = f(matrix[0, 1] * y + matrix[0, 3])
        c1 = f(matrix[1, 1] * y + matrix[1, 3])
        c2 = f(matrix[2, 1] * y + matrix[2, 3])
        for x in range(d.shape[1]):
            if not valid[y, x]:
                continue
            label = d[y, x]
            z = a2 * f(x) + d2 * label + c2
            if not z > f(1e-6):
                continue
            px = (a0 * f(x) + d0 * label + c0) / z
            py = (a1 * f(x) + d1 * label + c1) / z
            if not (px > f(-1) and py > f(-1) and px < f(width) and py < f(height)):
                continue
            column, row = int(np.floor(px)), int(np.floor(py))
            for r in range(max(row, 0), min(row + 2, height)):
                for c in range(max(column, 0), min(column + 2, width)):
                    buffer[r, c] = max(buffer[r, c], label)


@kernel(fastmath=EXACT)
def mean_rows(first, last, pictures, buffers, matrices, height, width, d, bias, texture, count_out):
    """texture, count_out: bilinear mean and number of the views that see each point of rows [first, last)."""
    columns = d.shape[1]
    real, whole = np.zeros(REAL_SLOTS * RUN, np.float32), np.zeros(WHOLE_SLOTS * RUN, np.uint32)
    limit, label, total = np.zeros(RUN, np.float32), np.zeros(RUN, np.float32), np.zeros(4 * RUN, np.float32)
    for y in range(first, last):
        for x in range(0, columns, RUN):
            count = min(RUN, columns - x)
            for i in range(count):
                label[i] = d[y, x + i]
                limit[i] = label[i] + bias
            total[:] = 0
            for v in range(matrices.shape[0]):
                place(matrices[v], y, x, count, label, limit, height, width, real, whole)
                fetch(pictures[v], buffers[v], width, count, real, whole)
                add_means(count, real, whole, total)
            for i in range(count):
                inverse = _ONE / max(total[i + 3 * RUN], _ONE)
                for c in range(3):
                    texture[y, x + i, c] = total[i + c * RUN] * inverse
                count_out[y, x + i] = np.int32(total[i + 3 * RUN])


@kernel(fastmath=EXACT)
def add_means(count, real, whole, total):
    """total += visible (r, g, b, 1)."""
    for i in range(count):
        w00, w01, w10, w11 = weights(real, i)
        m = visible(real, i)
        total[i] += m * channel(whole, i, 0, w00, w01, w10, w11)
        total[i + RUN] += m * channel(whole, i, 8, w00, w01, w10, w11)
        total[i + 2 * RUN] += m * channel(whole, i, 16, w00, w01, w10, w11)
        total[i + 3 * RUN] += m


@kernel(inline=True)
def _cubic(t):
    """Catmull-Rom's weights of the four samples round a point at fraction t."""
    w0 = ((-np.float32(0.5) * t + _ONE) * t - np.float32(0.5)) * t
    w1 = (np.float32(1.5) * t - np.float32(2.5)) * t * t + _ONE
    w2 = ((-np.float32(1.5) * t + np.float32(2)) * t + np.float32(0.5)) * t
    return w0, w1, w2, _ONE - w0 - w1 - w2


@kernel(fastmath=EXACT)
def cubic_mean_rows(first, last, pictures, buffers, matrices, height, width, d, bias, texture, count_out):
    """As `mean_rows`, with Catmull-Rom interpolation; samples beyond the picture are its border's."""
    columns = d.shape[1]
    real, whole = np.zeros(REAL_SLOTS * RUN, np.float32), np.zeros(WHOLE_SLOTS * RUN, np.uint32)
    limit, label, total = np.zeros(RUN, np.float32), np.zeros(RUN, np.float32), np.zeros(4 * RUN, np.float32)
    byte = np.uint32(255)
    for y in range(first, last):
        for x in range(0, columns, RUN):
            count = min(RUN, columns - x)
            for i in range(count):
                label[i] = d[y, x + i]
                limit[i] = label[i] + bias
            total[:] = 0
            for v in range(matrices.shape[0]):
                picture = pictures[v]
                place(matrices[v], y, x, count, label, limit, height, width, real, whole)
                fetch(picture, buffers[v], width, count, real, whole)
                for i in range(count):
                    if visible(real, i) == _ZERO:
                        continue
                    row, column = np.int64(whole[i]) // width, np.int64(whole[i]) % width
                    across, down = _cubic(real[i]), _cubic(real[i + RUN])
                    r, g, b = _ZERO, _ZERO, _ZERO
                    for j in range(4):
                        line = min(max(row + j - 1, 0), height - 1) * width
                        for k in range(4):
                            p = picture[line + min(max(column + k - 1, 0), width - 1)]
                            w = down[j] * across[k]
                            r += w * np.float32(p & byte)
                            g += w * np.float32((p >> np.uint32(8)) & byte)
                            b += w * np.float32((p >> np.uint32(16)) & byte)
                    total[i] += r
                    total[i + RUN] += g
                    total[i + 2 * RUN] += b
                    total[i + 3 * RUN] += _ONE
            for i in range(count):
                inverse = _ONE / max(total[i + 3 * RUN], _ONE)
                for c in range(3):
                    texture[y, x + i, c] = total[i + c * RUN] * inverse
                count_out[y, x + i] = np.int32(total[i + 3 * RUN])
