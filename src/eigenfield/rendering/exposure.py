"""A captured camera's own exposure and white balance, given back to its picture of a harmonised scene."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.scene import Scene


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
