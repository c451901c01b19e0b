"""Sampling a picture at given positions.

cv2.remap is not used: its positions are rounded to 1/32 pixel, and its cubic (a = -0.75) does not even keep a ramp.
"""

from __future__ import annotations

import math

from eigenfield.runtime.jit import kernel


@kernel()
def sample_cubic(picture, x, y, first, last, out):  # type: ignore[no-untyped-def]
    """Sample a picture at given positions.

    Separable Catmull-Rom (Keys 1981, a = -1/2): for a fraction t the four weights are
        w(-1) = t (-1 + t (2 - t)) / 2        w(0) = (2 + t^2 (3 t - 5)) / 2
        w(1)  = t (1 + t (4 - 3 t)) / 2       w(2) = t^2 (t - 1) / 2
    Samples outside the picture are those of its rim.

    Args:
        picture: (H, W, C).
        x: (h, w) positions, integer pixel centres.
        y: (h, w) likewise.
        first: First row to sample.
        last: End of the rows.
        out: (h, w, C) result.
    """
    height, width, channels = picture.shape
    for row in range(first, last):
        for column in range(x.shape[1]):
            px = min(max(float(x[row, column]), -2.0), width + 1.0)
            py = min(max(float(y[row, column]), -2.0), height + 1.0)
            left = math.floor(px)
            top = math.floor(py)
            s = px - left
            t = py - top
            wx = (
                s * (-1 + s * (2 - s)) / 2,
                (2 + s * s * (3 * s - 5)) / 2,
                s * (1 + s * (4 - 3 * s)) / 2,
                s * s * (s - 1) / 2,
            )
            wy = (
                t * (-1 + t * (2 - t)) / 2,
                (2 + t * t * (3 * t - 5)) / 2,
                t * (1 + t * (4 - 3 * t)) / 2,
                t * t * (t - 1) / 2,
            )
            for c in range(channels):
                total = 0.0
                for j in range(4):
                    r = min(max(int(top) - 1 + j, 0), height - 1)
                    line = 0.0
                    for i in range(4):
                        k = min(max(int(left) - 1 + i, 0), width - 1)
                        line += wx[i] * picture[r, k, c]
                    total += wy[j] * line
                out[row, column, c] = total
