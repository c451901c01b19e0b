"""Whether the depth maps of several views agree."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel


@kernel()
def count_agreeing(first, last, d, across, others, present, tolerance, count):
    """count (h, w) += maps that agree with rows [first, last) of d.

    across[o] (4, 4) takes (x, y, d, 1) of this canvas to the homogeneous (x, y, d, 1) of canvas o. Map o agrees where
    one of the four samples round the point there lies within `tolerance` of the point's label, relative to how fast
    labels of o change with those of this canvas: both are then compared in this canvas's unit.
    """
    height, width = others.shape[1], others.shape[2]
    for y in range(first, last):
        for x in range(d.shape[1]):
            label = d[y, x]
            if not np.isfinite(label):
                continue
            for o in range(others.shape[0]):
                m = across[o]
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
                    inside = 0 <= c < width and 0 <= r < height and present[o, r, c]
                    if inside and abs(others[o, r, c] - pd) <= tolerance * max(scale, 1e-12):
                        count[y, x] += 1
                        break
