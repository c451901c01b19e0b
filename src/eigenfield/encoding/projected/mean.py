"""The mean texture and the filling of what an observation does not show (the paper's equations 1 and 2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.progress import Progress
from eigenfield.encoding.projected.project import TextureMaps
from eigenfield.runtime.parallel import pieces, tracked_map

MAP_TILE_TEXELS = 4096  # chart texels worked on at a time


@dataclass(frozen=True, eq=False)
class Mean:
    """The mean of all maps.

    Attributes:
        values: (n, C) float32, 0 where no observation shows the texel.
        count: (n,) int32, how many observations show it.
    """

    values: NDArray[np.float32]
    count: NDArray[np.int32]

    @property
    def seen(self) -> NDArray[np.bool_]:
        """(n,) bool, texels that at least one observation shows."""
        return self.count > 0


def mean_map(maps: TextureMaps, progress: Progress | None = None) -> Mean:
    """Equation 1: at each texel the mean over the observations that show it, Σ v(c) T(c) / Σ v(c), in float64."""
    values = np.zeros((maps.atlas.count, maps.channels), np.float32)
    count = np.zeros(maps.atlas.count, np.int32)

    def piece(part: tuple[int, int]) -> None:
        first, last = part
        seen = maps.seen[:, first:last] > 0
        number = seen.sum(axis=0, dtype=np.int32)
        total = np.zeros((last - first, maps.channels))
        for index in range(maps.count):
            total += maps.values[index, first:last] * seen[index, :, None]
        values[first:last] = total / np.maximum(number, 1)[:, None]
        count[first:last] = number

    tracked_map(piece, pieces(maps.atlas.count, MAP_TILE_TEXELS), "mean", progress)
    return Mean(values, count)


def filled_map(values: NDArray[np.float32], seen: NDArray[np.uint8], mean: NDArray[np.float32]) -> NDArray[np.float32]:
    """Equation 2: a map with the mean where nothing is seen. All (n, C) or (n,) over chart texels."""
    return np.where(seen[:, None] > 0, values, mean)
