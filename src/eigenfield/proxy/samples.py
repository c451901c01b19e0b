"""Points on a mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh


def surface_samples(mesh: Mesh, count: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Points spread evenly over a mesh, at least one a triangle, and the triangle of each.

    They are the R2 sequence (Roberts, 2018) folded into each triangle, so that the same mesh gives the same points.

    Args:
        count: How many, approximately.
    """
    area = mesh.face_areas()
    number = np.maximum(np.rint(count * area / max(float(area.sum()), 1e-300)), 1).astype(np.int64)
    face = np.repeat(np.arange(len(area)), number)
    step = np.arange(len(face)) - np.repeat(np.cumsum(number) - number, number)
    u, v = (0.5 + 0.7548776662466927 * step) % 1, (0.5 + 0.5698402909980532 * step) % 1
    fold = u + v > 1
    u, v = np.where(fold, 1 - u, u), np.where(fold, 1 - v, v)
    p = mesh.vertices.astype(np.float64)[mesh.faces[face]]
    return p[:, 0] + u[:, None] * (p[:, 1] - p[:, 0]) + v[:, None] * (p[:, 2] - p[:, 0]), face
