"""A multiplane image: layers with colour and opacity on planes before a reference view."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.stereo.multiplane.drawing import draw_picture


@dataclass(frozen=True, eq=False)
class MultiplaneImage:
    """Layers of one size, each on the plane of one label of a `ReferenceView`.

    Attributes:
        labels: (D,) float64 ascending, so that the farthest layer is the first.
        layers: (D, h, w, 4) float32 R, G, B in the photographs' own values and opacity, 0..1.
    """

    labels: NDArray[np.float64]
    layers: NDArray[np.float32]

    def draw(self, matrix: NDArray[np.float64], shape: tuple[int, int]) -> NDArray[np.float32]:
        """As `draw_picture`."""
        return draw_picture(self.labels, self.layers, matrix, shape)
