"""A picture over time: what is changed in each frame, and noise."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from support.scenes import smooth_pictures

PICTURE = 0.5 + 0.3 * smooth_pictures(1, 60, 80, 3, 4)[0]


def changed_frames(change: Callable[[int, np.ndarray], None], count: int, noise: float) -> list[np.ndarray]:
    """PICTURE so many times, (60, 80, 3) float32 in 0 to 1, after `change(number, pixels)`, with noise of so many grey
    levels."""
    random, made = np.random.default_rng(1), []
    for number in range(count):
        pixels = PICTURE.copy()
        change(number, pixels)
        made.append(np.clip(pixels + random.normal(0, noise / 255, pixels.shape), 0, 1).astype(np.float32))
    return made
