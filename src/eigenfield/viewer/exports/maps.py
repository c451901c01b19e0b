"""The texture map of every encoded camera, as the file has it: mean and eigen textures with that camera's weights."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.errors import FormatError, OptionError
from eigenfield.parallel import parallel_stream
from eigenfield.progress import Progress, track
from eigenfield.rendering.kernels import TILE
from eigenfield.rendering.shots import refuse_attributes
from eigenfield.rendering.tiles import compose, empty_layers, read_layers, tile_plane
from eigenfield.scene import Scene
from eigenfield.texturing import png_bytes
from eigenfield.viewer.exports.folder import atomic_folder, put, write_listing
from eigenfield.viewer.exports.names import file_names


def write_maps(
    scene: Scene,
    folder: Path,
    *,
    textures: int | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write a PNG of the whole atlas for each encoded camera, named by it: equation 8 with the camera's own weights,
    cut to 0..1. `eigenfield.json` says which file is whose.

    Texels that no camera saw are what the file holds there. A harmonised scene's maps are in the common exposure.
    textures: how many eigen textures to sum. Raises OutputError, OptionError (`textures`, `not-a-picture`) and
    FormatError `unsupported-layout`.
    """
    if textures is not None and textures < 0:
        raise OptionError("textures", f"{textures} eigen textures were asked for", remedy="ask for 0 or more")
    make = camera_maps(scene)
    names = [scene.names[index] for index in scene.encoded]
    files = file_names(names)
    drawn = parallel_stream(lambda row: png_bytes(make(row, textures)), range(len(names)))
    with atomic_folder(folder, overwrite) as part:
        for file, data in zip(files, track(drawn, "maps", len(names), progress), strict=True):
            put(part / file, data)
        height, width = scene.planes[0].mean.shape[:2]
        write_listing(part, "maps", {"size": [width, height], "maps": dict(zip(names, files, strict=True))})


def camera_maps(scene: Scene) -> Callable[[int, int | None], NDArray[np.float32]]:
    """A function of an encoded camera's row and a number of eigen textures: its (H, W, C) texture map, not cut."""
    refuse_attributes(sum(plane.mean.shape[2] for plane in scene.planes))
    sizes = {plane.mean.shape[:2] for plane in scene.planes}
    if len(sizes) != 1:
        raise FormatError(
            "unsupported-layout", "planes of different sizes make no one map", where="planes", remedy="encode with one"
        )
    height, width = sizes.pop()
    every = np.ones((-(-height // TILE), -(-width // TILE)), np.bool_)
    planes = [tile_plane(plane, every) for plane in scene.planes]

    def make(row: int, textures: int | None) -> NDArray[np.float32]:
        parts = []
        for plane, tiled in zip(scene.planes, planes, strict=True):
            channels = plane.mean.shape[2]
            layers = empty_layers(height, width, channels)
            omega = tiled.weights[row][:textures] if tiled.weights.size else np.zeros(0)
            compose(tiled, omega, np.arange(every.size), layers)
            parts.append(read_layers(layers, height, width, channels))
        return np.concatenate(parts, axis=2)

    return make
