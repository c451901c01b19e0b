"""Inner loops: depth buffers by splatting, and mean colours over the views that see a point."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel
from eigenfield.stereo.taps import (
    EMPTY_DEPTH_LABEL,
    FASTMATH_NAN_SAFE,
    FASTMATH_ORDERED,
    TAP_FLOAT_SLOTS,
    TAP_INT_SLOTS,
    TAP_RUN,
    bilinear_colour,
    fetch_run,
    is_visible,
    project_run,
)

_ONE = np.float32(1)


@kernel(fastmath=FASTMATH_NAN_SAFE)
def splat_labels(matrix, d, valid, buffer):
    """The largest d of the points that fall on each pixel; each point covers the 2 x 2 pixels around it.

    Args:
        matrix: (3, 4) of the view.
        d: (h, w) labels.
        valid: (h, w) points that count.
        buffer: (H, W), written.
    """
    height, width = buffer.shape
    f = np.float32
    buffer[:] = EMPTY_DEPTH_LABEL
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
            inverse = f(1) / z
            px, py = (a0 * f(x) + d0 * label + c0) * inverse, (a1 * f(x) + d1 * label + c1) * inverse
            if not (px > f(-1) and py > f(-1) and px < f(width) and py < f(height)):
                continue
            left, top = max(np.int32(np.floor(px)), 0), max(np.int32(np.floor(py)), 0)
            right, bottom = min(np.int32(np.floor(px)) + 1, width - 1), min(np.int32(np.floor(py)) + 1, height - 1)
            buffer[top, left] = max(buffer[top, left], label)
            buffer[top, right] = max(buffer[top, right], label)
            buffer[bottom, left] = max(buffer[bottom, left], label)
            buffer[bottom, right] = max(buffer[bottom, right], label)


@kernel(fastmath=FASTMATH_ORDERED)
def mean_rows(first, last, pictures, buffers, matrices, height, width, d, bias, texture, count_out):
    """Bilinear mean and number of the views that see each point of rows [first, last).

    Args:
        first, last: Range of rows.
        pictures: (V, H W) packed.
        buffers: (V, H W) depth buffers, or (V, 0) for none.
        matrices: (V, 3, 4) of the views.
        height, width: Size of the views.
        d: (h, w) labels.
        bias: Labels behind the depth buffer at which a point still counts as visible.
        texture: (h, w, 3) mean colour, written.
        count_out: (h, w) number of views, written.
    """
    columns = d.shape[1]
    floats, ints = np.zeros(TAP_FLOAT_SLOTS * TAP_RUN, np.float32), np.zeros(TAP_INT_SLOTS * TAP_RUN, np.uint32)
    limit, label = np.zeros(TAP_RUN, np.float32), np.zeros(TAP_RUN, np.float32)
    total = np.zeros(4 * TAP_RUN, np.float32)
    for y in range(first, last):
        for x in range(0, columns, TAP_RUN):
            count = min(TAP_RUN, columns - x)
            for i in range(count):
                label[i] = d[y, x + i]
                limit[i] = label[i] + bias
            total[:] = 0
            for v in range(matrices.shape[0]):
                project_run(matrices[v], y, x, count, label, limit, height, width, floats, ints)
                fetch_run(pictures[v], buffers[v], width, count, floats, ints)
                _add_means(count, floats, ints, total)
            for i in range(count):
                inverse = _ONE / max(total[i + 3 * TAP_RUN], _ONE)
                for c in range(3):
                    texture[y, x + i, c] = total[i + c * TAP_RUN] * inverse
                count_out[y, x + i] = np.int32(total[i + 3 * TAP_RUN])


@kernel(fastmath=FASTMATH_ORDERED)
def _add_means(count, floats, ints, total):
    """total += visible (r, g, b, 1)."""
    for i in range(count):
        m = is_visible(floats, i)
        r, g, b = bilinear_colour(floats, ints, i)
        total[i] += m * r
        total[i + TAP_RUN] += m * g
        total[i + 2 * TAP_RUN] += m * b
        total[i + 3 * TAP_RUN] += m
