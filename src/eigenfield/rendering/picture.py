"""What the renderer hands back, and a captured camera's own exposure and white balance, given back to its picture."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.limits import MAX_GAIN
from eigenfield.core.errors import OptionError
from eigenfield.core.scene import Scene
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering.weights import ViewWeights
from eigenfield.runtime.files import write_bytes

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

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write the picture as a PNG of 8 bits, whole or not at all.

        Args:
            path: Of the .png.
            overwrite: Whether an existing file is replaced.

        Raises:
            OptionError: `output-kind`: the name does not end in .png. `not-a-picture`: it has other than 1 or 3
                channels.
            OutputError: The file may not or cannot be written.
        """
        path, data = Path(path), self._repr_png_()
        if path.suffix.lower() != ".png":
            remedy = f"name it {path.with_suffix('.png').name}"
            raise OptionError("output-kind", "a picture is written as a .png", path=path, remedy=remedy)
        if data is None:
            message = f"{self.image.shape[2]} channels make no picture"
            raise OptionError("not-a-picture", message, path=path, remedy="take three of `image`")
        write_bytes(path, data, overwrite=overwrite)

    def _repr_png_(self) -> bytes | None:
        """The picture as a PNG, for notebooks; None where it has other than 1 or 3 channels."""
        return png_bytes(self.to_uint8()) if self.image.shape[2] in (1, 3) else None

    def __repr__(self) -> str:
        height, width, channels = self.image.shape
        return f"Picture of {width}x{height}, {channels} channels, {self.coverage.mean():.1%} covered"


def camera_colour(scene: Scene, index: int) -> NDArray[np.float32] | None:
    """(2, 3) gain and offset of a captured camera that its view weights do not mix, else None."""
    colours, mixed = scene.appearance.colours, scene.appearance.mixed_colours
    return None if colours is None or mixed else colours[index]


def colour_changes(scene: Scene) -> NDArray[np.float64] | None:
    """(No, 6) what draws each observation in its camera's own exposure: the factors of R, G, B, less 1, and what is
    added. None where views are drawn in the common exposure."""
    colours = scene.appearance.colours
    if colours is None or not scene.appearance.mixed_colours:
        return None
    gain, offset = np.moveaxis(colours[scene.rig.encoded].astype(np.float64), 1, 0)
    return np.concatenate([1 / gain - 1, -offset / gain], axis=1)


def mixed_colour(changes: NDArray[np.float64] | None, weights: ViewWeights) -> NDArray[np.float32] | None:
    """(2, 3) gain and offset of a view, mixed of `colour_changes` by its weights as the textures are; None for None."""
    if changes is None:
        return None
    scale, bias = weights.blend(changes).reshape(2, 3)
    gain = 1 / np.maximum(1 + scale, 1 / MAX_GAIN)  # weights that continue beyond a triangle may be negative
    return np.stack([gain, -bias * gain]).astype(np.float32)


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
