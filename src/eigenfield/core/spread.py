"""Some of many, evenly spread."""

from __future__ import annotations

import numpy as np


def spread_indices(count: int, most: int) -> list[int]:
    """At most so many indices below `count`, evenly spread, with the first and the last; all if there are no more."""
    some: list[int] = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int)).tolist()
    return some
