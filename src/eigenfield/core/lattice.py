"""The grid to which a mesh's positions are rounded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.core.brief import brief_repr


@dataclass(frozen=True, eq=False)
class Lattice:
    """A map from integers (i, j, k) to the world.

    Attributes:
        matrix: (4, 4) float64, invertible, from (i, j, k, 1) to homogeneous world coordinates.
        flat: (i, j) are pixels of a camera that sees the mesh from one side, and k is inverse depth, coded over them.
        fine: Number of the last binary digits of i and j that are mostly zero.
    """

    matrix: NDArray[np.float64]
    flat: bool
    fine: int = 0

    __repr__ = brief_repr

    def points(self, steps: NDArray[np.int64] | NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 3) lattice coordinates, whole or between, to world positions. The order of the sums is part of the
        format."""
        i, j, k = steps.astype(np.float64).T
        m = self.matrix
        with np.errstate(all="ignore"):
            x, y, z, w = (m[r, 0] * i + m[r, 1] * j + m[r, 2] * k + m[r, 3] for r in range(4))
            return np.stack([x / w, y / w, z / w], axis=1)

    def coordinates(self, positions: ArrayLike) -> NDArray[np.float64]:
        """(n, 3) world positions to lattice coordinates, not rounded; infinite at the camera's own depth."""
        p = np.asarray(positions, np.float64)
        h = np.concatenate([p, np.ones((len(p), 1))], axis=1) @ np.linalg.inv(self.matrix).T
        with np.errstate(all="ignore"):
            return h[:, :3] / h[:, 3:]


def camera_lattice(
    matrix: ArrayLike, step: float, inverse_step: float, origin: tuple[float, float] = (0.5, 0.5)
) -> Lattice:
    """Pixels and inverse depth of a camera, for a mesh that is all in front of it and seen from one side.

    Rounding moves a point by at most half of each step. An error e of 1 / Z moves a point by e |K R (C - C')| pixels
    (the first two numbers) in another view from C' with the same K and R, which bounds `inverse_step`.

    Args:
        matrix: (3, 4) K [R | t], last row of K 0 0 1.
        step: In pixels.
        inverse_step: Of 1 / Z, Z along the camera's axis; k is 0 or more in front of it.
        origin: The pixel at (0, 0).
    """
    m = np.asarray(matrix, np.float64)
    turn = np.linalg.inv(m[:, :3])
    centre = -turn @ m[:, 3]
    result = np.zeros((4, 4))
    result[:3, 0], result[:3, 1] = step * turn[:, 0], step * turn[:, 1]
    result[:3, 2], result[3, 2] = inverse_step * centre, inverse_step
    result[:3, 3] = turn @ np.array([*origin, 1.0]) + inverse_step / 2 * centre
    result[3, 3] = inverse_step / 2
    return Lattice(result, True)


def world_lattice(origin: ArrayLike, step: ArrayLike) -> Lattice:
    """A grid along the world's axes: origin (3,) and step (3,), or one for all, in world units."""
    result = np.diag([*np.broadcast_to(np.asarray(step, np.float64), 3), 1.0])
    result[:3, 3] = origin
    return Lattice(result, False)
