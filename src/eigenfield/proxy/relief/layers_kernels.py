"""Where an array sees behind a depth map."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

REVEALED_PADDING_PIXELS = 3  # beyond what the array uncovers
REVEALED_NEAR_FRACTION = 0.6  # of the jump above the far side: nearer pixels belong to the near side


@kernel()
def mark_revealed(d, valid, cut, reach, slack, want, ceiling):
    """For every edge between two valid pixels with a cut: the pixels of its near side that are uncovered.

    The near pixel of a jump J covers reach J pixels from its cut, in the direction of its motion. J includes the next
    pixels on both sides, over which the step may be smeared.

    Args:
        d: (h, w) labels.
        valid: (h, w) where there is surface.
        cut: Difference of labels at which an edge is cut.
        reach: (4,) pixels to the right, down, left and up that a point moves at most for one unit of d.
        slack: Labels that the surface behind may be nearer than the far side.
        want: (h, w) uncovered pixels, set.
        ceiling: (h, w) the smallest over their cuts of the far side's d + slack, updated.
    """
    h, w = d.shape
    for y in range(h):
        for x in range(w):
            for axis in range(2):
                j, i = (y, x + 1) if axis == 0 else (y + 1, x)
                if j >= h or i >= w or not valid[y, x] or not valid[j, i] or abs(d[y, x] - d[j, i]) <= cut:
                    continue
                forward = d[j, i] > d[y, x]  # the near side lies to the right, or below
                near, far = (d[j, i], d[y, x]) if forward else (d[y, x], d[j, i])
                for q, p in ((2 * y - j, 2 * x - i), (2 * j - y, 2 * i - x)):
                    if 0 <= q < h and 0 <= p < w and valid[q, p]:
                        near, far = max(near, d[q, p]), min(far, d[q, p])
                jump = near - far
                right = int(np.ceil(reach[0] * jump)) + REVEALED_PADDING_PIXELS
                down = int(np.ceil(reach[1] * jump)) + REVEALED_PADDING_PIXELS
                left = int(np.ceil(reach[2] * jump)) + REVEALED_PADDING_PIXELS
                up = int(np.ceil(reach[3] * jump)) + REVEALED_PADDING_PIXELS
                if axis == 0 and forward:
                    left = -1
                elif axis == 0:
                    right = 0
                elif forward:
                    up = -1
                else:
                    down = 0
                for row in range(max(0, y - up), min(h, y + down + 1)):
                    for column in range(max(0, x - left), min(w, x + right + 1)):
                        z = d[row, column]
                        if valid[row, column] and z >= far + REVEALED_NEAR_FRACTION * jump:
                            want[row, column] = True
                            ceiling[row, column] = min(ceiling[row, column], max(far, min(far + slack, z - slack)))
