"""A captured camera's own exposure and white balance, given back to its picture of a harmonised scene."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.scene import Scene


def camera_colour(scene: Scene, index: int) -> NDArray[np.float32] | None:
    """(2, 3) gain and offset that harmonised the camera at `index`; None where the scene is not harmonised."""
    return None if scene.appearance.colours is None else scene.appearance.colours[index]


def undo_colour(
    image: NDArray[np.float32],
    coverage: NDArray[np.float32],
    background: NDArray[np.float32],
    colour: NDArray[np.float32],
) -> NDArray[np.float32]:
    """(H, W, C >= 3) with the surface's R, G and B as the camera saw them, (x - offset) / gain; the background, which
    shows with the part 1 - coverage, stays as it is. Nothing is cut."""
    gain, offset = colour
    surface, behind = coverage[..., None], (1 - coverage)[..., None] * background[:3]
    own = image.copy()
    own[..., :3] = (image[..., :3] - behind - surface * offset) / gain + behind
    return own
