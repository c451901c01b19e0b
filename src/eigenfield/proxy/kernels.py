"""Counting how often an atlas is covered."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.jit import kernel


@kernel()
def count_layers(
    corners: NDArray[np.float64], faces: NDArray[np.int32], margin: float, layers: NDArray[np.uint8]
) -> None:
    """corners (n, 2) in texels; layers (H, W) uint8, out: in how many triangles each texel's centre lies, by more than
    `margin` texels from every edge, saturating at 255.

    A point p is at the signed distance ((b - a) x (p - a)) / |b - a| from the edge a b.
    """
    height, width = layers.shape
    for f in range(faces.shape[0]):
        x0, y0 = corners[faces[f, 0]]
        x1, y1 = corners[faces[f, 1]]
        x2, y2 = corners[faces[f, 2]]
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if area == 0:
            continue
        if area < 0:
            x1, y1, x2, y2 = x2, y2, x1, y1
        m0 = margin * np.hypot(x1 - x0, y1 - y0)
        m1 = margin * np.hypot(x2 - x1, y2 - y1)
        m2 = margin * np.hypot(x0 - x2, y0 - y2)
        left = max(0, int(np.floor(min(x0, x1, x2))))
        right = min(width, int(np.ceil(max(x0, x1, x2))) + 1)
        top = max(0, int(np.floor(min(y0, y1, y2))))
        bottom = min(height, int(np.ceil(max(y0, y1, y2))) + 1)
        for row in range(top, bottom):
            y = row + 0.5
            for column in range(left, right):
                x = column + 0.5
                if (
                    (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0) > m0
                    and (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1) > m1
                    and (x0 - x2) * (y - y2) - (y0 - y2) * (x - x2) > m2
                    and layers[row, column] < 255
                ):
                    layers[row, column] += 1
