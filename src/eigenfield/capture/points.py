"""Sparse points of a scene, and their observations in the photographs."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class SparsePoints:
    """Points with their observations.

    Attributes:
        positions: (n, 3) float64, world.
        colours: (n, 3) uint8.
        errors: (n,) float64, mean reprojection error in pixels.
        point: (m,) int64, the point of each observation; sorted by point, then view.
        view: (m,) int64, the view of the light field that observes it.
        pixels: (m, 2) float64, place in the photograph (its lens not removed), pixels with centres at +0.5.
    """

    positions: NDArray[np.float64]
    colours: NDArray[np.uint8]
    errors: NDArray[np.float64]
    point: NDArray[np.int64]
    view: NDArray[np.int64]
    pixels: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.positions)

    @property
    def track_lengths(self) -> NDArray[np.int64]:
        """(n,) how many views observe each point."""
        return np.bincount(self.point, minlength=len(self.positions)).astype(np.int64)

    def transform(self, scale: float, R: NDArray[np.float64], t: NDArray[np.float64]) -> SparsePoints:
        """The points in the world x' = scale R x + t."""
        return replace(self, positions=scale * self.positions @ R.T + t)

    def with_errors(self, errors: NDArray[np.float64]) -> SparsePoints:
        """With each point's mean of the (m,) errors of its observations, pixels."""
        sums = np.bincount(self.point, weights=errors, minlength=len(self.positions))
        return replace(self, errors=sums / np.maximum(self.track_lengths, 1))
