"""The precision of a mean, place by place, as a small grey picture.

A texel that few cameras see answers for few pixels, and is coded coarser: the mean is multiplied by its precision,
0..1, before it is coded, and the decoded numbers are divided by it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def precision_codes(precision: NDArray[np.float32]) -> NDArray[np.uint8]:
    """(h, w) numbers in 0..1 as the codes of a grey picture, each the nearest of 1/256 to 1."""
    return np.rint(256 * precision - 1).clip(0, 255).astype(np.uint8)


def spread_precision(codes: NDArray[np.uint8], height: int, width: int) -> NDArray[np.float32]:
    """(height, width, 1): the precision at each texel of a mean, between the middles of the (h, w) codes linearly."""
    import cv2  # most files need none

    values = (codes.astype(np.float32) + 1) / 256
    return np.asarray(cv2.resize(values, (width, height), interpolation=cv2.INTER_LINEAR), np.float32)[..., None]
