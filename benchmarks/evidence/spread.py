"""A few cameras that stand for all of an array."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from eigenfield.core.scene import Scene


def spread_over_array(scene: Scene, indices: Sequence[int], count: int) -> list[int]:
    """`count` of the cameras `indices`, in rising order: those nearest the middles of as many even cells of the view
    plane, each taken once; all of them where there are no more."""
    if len(indices) <= count:
        return sorted(int(index) for index in indices)
    places = scene.rig.view_plane.coordinates(np.array([scene.rig.cameras[index].centre for index in indices]))
    rows = 1 if scene.rig.view_plane.is_line else max(1, round(math.sqrt(count)))
    shares = np.diff(np.rint(np.linspace(0, count, rows + 1)).astype(int))  # nodes in each row of cells
    free = np.ones(len(indices), bool)
    chosen = []
    for row, share in enumerate(shares):
        for column in range(share):
            node = ((2 * column + 1) / share - 1, (2 * row + 1) / rows - 1)
            away = np.where(free, ((places - node) ** 2).sum(axis=1), np.inf)
            nearest = int(np.argmin(away))
            free[nearest] = False
            chosen.append(int(indices[nearest]))
    return sorted(chosen)
