"""Luma apart from chroma: three numbers a pixel, so chosen that errors in R, G and B are errors in them.

Luma is BT.709's Y' of the photograph's own (sRGB-coded) numbers, l . rgb; chroma are the coordinates of rgb - Y' in
the plane l . c = 0, along two orthonormal axes of that plane: zero for greys. The mean squared error of R, G and B is
then about that of luma plus a third of those of chroma.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.colour import LUMA_BT709

LUMA = np.array(LUMA_BT709)


def split_matrix() -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(1, 3) luma from R, G, B, and (2, 3) chroma."""
    axes = _axes()
    chroma = axes - np.outer(axes.sum(axis=1), LUMA)  # axis . (rgb - Y' (1, 1, 1))
    return LUMA[None].astype(np.float32), chroma.astype(np.float32)


def to_rgb() -> NDArray[np.float32]:
    """(3, 3): R, G, B from luma and both chroma."""
    return np.concatenate([np.ones((3, 1)), _axes().T], axis=1).astype(np.float32)


def _axes() -> NDArray[np.float64]:
    """(2, 3) orthonormal axes of the plane at right angles to LUMA: the first towards blue."""
    first = np.array([0.0, 0.0, 1.0]) - LUMA[2] / (LUMA @ LUMA) * LUMA
    first /= np.linalg.norm(first)
    second = np.cross(first, LUMA / np.linalg.norm(LUMA))
    return np.stack([first, second])
