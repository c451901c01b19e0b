"""What the renderer hands back, and a captured camera's own exposure and white balance, given back to its picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.scene import Scene
from eigenfield.imaging.metrics import to_codes

# Of a pixel's samples: all, of up to 4 x 4. The coded opacity of what is opaque is a few hundredths off.
PICTURE_COVERED_RATIO = 0.95


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
        return to_codes(self.image)


def camera_colour(scene: Scene, index: int) -> NDArray[np.float32] | None:
    """(2, 3) gain and offset that harmonised a camera; None where the scene is not harmonised.

    Args:
        scene: The scene.
        index: Of the camera.
    """
    return None if scene.appearance.colours is None else scene.appearance.colours[index]


def undo_colour(
    image: NDArray[np.float32],
    coverage: NDArray[np.float32],
    background: NDArray[np.float32],
    colour: NDArray[np.float32],
) -> NDArray[np.float32]:
    """(H, W, C) with the surface's R, G and B as the camera saw them: (x - offset) / gain.

    The background, which shows with the weight 1 - coverage, stays as it is. Nothing is clipped.

    Args:
        image: (H, W, C >= 3) the drawn picture.
        coverage: (H, W) the part of each pixel that shows the surface.
        background: (C,) its colour.
        colour: (2, 3) gain and offset, of `camera_colour`.
    """
    gain, offset = colour
    surface, behind = coverage[..., None], (1 - coverage)[..., None] * background[:3]
    own = image.copy()
    own[..., :3] = (image[..., :3] - behind - surface * offset) / gain + behind
    return own
