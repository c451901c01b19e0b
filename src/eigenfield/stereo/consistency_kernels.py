"""The inner loop of the consistency check between depth maps."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel


@kernel()
def count_consistent_rows(first, last, d, transfer, others, valid, tolerance, count):
    """Add the number of maps that agree with the points of rows [first, last) of d.

    Map o agrees where one of the four samples around the transferred point lies within `tolerance` of the point's
    label. The difference is divided by the rate at which labels of o change with labels of this view, so that both are
    compared in this view's unit.

    Args:
        first, last: Range of rows.
        d: (h, w) labels of the map that is judged.
        transfer: (O, 4, 4) matrices from (x, y, d, 1) of this view to homogeneous (x, y, d, 1) of each other view.
        others: (O, H, W) labels of the other maps.
        valid: (O, H, W) which points of the other maps may confirm.
        tolerance: In labels of d.
        count: (h, w) int32, added to.
    """
    height, width = others.shape[1], others.shape[2]
    for y in range(first, last):
        for x in range(d.shape[1]):
            label = d[y, x]
            if not np.isfinite(label):
                continue
            for o in range(others.shape[0]):
                m = transfer[o]
                w = m[3, 0] * x + m[3, 1] * y + m[3, 2] * label + m[3, 3]
                if not w > 1e-9:
                    continue
                px = (m[0, 0] * x + m[0, 1] * y + m[0, 2] * label + m[0, 3]) / w
                py = (m[1, 0] * x + m[1, 1] * y + m[1, 2] * label + m[1, 3]) / w
                pd = (m[2, 0] * x + m[2, 1] * y + m[2, 2] * label + m[2, 3]) / w
                if not (px > -1 and py > -1 and px < width and py < height):
                    continue
                scale = abs((m[2, 2] - m[3, 2] * pd) / w)
                column, row = np.int64(np.floor(px)), np.int64(np.floor(py))
                for k in range(4):
                    c, r = column + k % 2, row + k // 2
                    inside = 0 <= c < width and 0 <= r < height and valid[o, r, c]
                    if inside and abs(others[o, r, c] - pd) <= tolerance * max(scale, 1e-12):
                        count[y, x] += 1
                        break
