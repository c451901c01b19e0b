"""Inner loops that count how often texels of an atlas are covered."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.jit import kernel


@kernel()
def count_layers(
    corners: NDArray[np.float64], faces: NDArray[np.int32], margin: float, layers: NDArray[np.uint8]
) -> None:
    """Count in how many triangles each texel's centre lies.

    Args:
        corners: (n, 2) vertices in texels.
        faces: (m, 3).
        margin: Texels by which a centre must lie inside every edge.
        layers: (H, W) uint8, added to; saturates at 255.
    """
    for f in range(faces.shape[0]):
        _cover_triangle(corners, faces[f], margin, layers, True)


@kernel()
def claim_texels(
    corners: NDArray[np.float64],
    faces: NDArray[np.int32],
    order: NDArray[np.int64],
    margin: float,
    layers: NDArray[np.uint8],
    claimed: NDArray[np.bool_],
) -> None:
    """Select triangles that cover no texel of those selected before.

    Args:
        corners: (n, 2) vertices in texels.
        faces: (m, 3).
        order: Order in which triangles are tried.
        margin: Texels by which a centre must lie inside every edge.
        layers: (H, W) uint8, as in `count_layers`, of the selected triangles.
        claimed: (m,) bool, set for the selected triangles.
    """
    for f in order:
        if _cover_triangle(corners, faces[f], margin, layers, False) == 0:
            _cover_triangle(corners, faces[f], margin, layers, True)
            claimed[f] = True


@kernel()
def _cover_triangle(
    corners: NDArray[np.float64], face: NDArray[np.int32], margin: float, layers: NDArray[np.uint8], add: bool
) -> int:
    """The most layers on the texels whose centre lies in a triangle, before the triangle is added.

    A point p has the signed distance ((b - a) x (p - a)) / |b - a| from the edge a b.

    Args:
        corners: (n, 2) vertices in texels.
        face: (3,) vertices of the triangle.
        margin: Texels by which a centre must lie inside every edge.
        layers: (H, W) uint8.
        add: Whether the triangle is added to `layers`.
    """
    height, width = layers.shape
    x0, y0 = corners[face[0]]
    x1, y1 = corners[face[1]]
    x2, y2 = corners[face[2]]
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    most = 0
    if area == 0:
        return most
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
            ):
                most = max(most, int(layers[row, column]))
                if add and layers[row, column] < 255:
                    layers[row, column] += 1
    return most
