"""Constants and transfer functions of colour spaces."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T", bound=np.generic)
LUMA_BT709 = (0.2126, 0.7152, 0.0722)  # Y' of R', G', B' (ITU-R BT.709)


def as_rgb(image: NDArray[T]) -> NDArray[T]:
    """(H, W, 3) of a picture (H, W, 1 or 3): greys are repeated."""
    return image if image.shape[2] == 3 else np.repeat(image, 3, axis=2)


def linear_of_srgb(coded: NDArray[np.float64]) -> NDArray[np.float64]:
    """Linear light 0..1 of sRGB-coded values 0..1 (IEC 61966-2-1)."""
    return np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)
