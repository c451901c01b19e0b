"""What the renderer hands back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

PICTURE_COVERED_RATIO = 0.999  # of a pixel's samples


@dataclass(frozen=True, eq=False)
class Picture:
    """A drawn view.

    Attributes:
        image: (H, W, C) float32 in the textures' range (0..1 for photographs; bicubic filtering and truncated bases may
            go a little beyond), the background where nothing is covered.
        coverage: (H, W) float32, the part of each pixel's samples that show the proxy.
    """

    image: NDArray[np.float32]
    coverage: NDArray[np.float32]

    @property
    def covered(self) -> NDArray[np.bool_]:
        """(H, W) the pixels all of whose samples show the proxy; the others are blended with the background."""
        return self.coverage > PICTURE_COVERED_RATIO

    def to_uint8(self) -> NDArray[np.uint8]:
        """(H, W, C) uint8: times 255, rounded half to even, clipped."""
        return np.clip(np.rint(self.image * np.float32(255)), 0, 255).astype(np.uint8)
