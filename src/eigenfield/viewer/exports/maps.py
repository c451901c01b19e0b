"""The texture map of every encoded camera, as the file has it: mean and eigen textures with that camera's weights."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.errors import OptionError
from eigenfield.parallel import parallel_stream
from eigenfield.progress import Progress, track
from eigenfield.rendering.composite import compose_scene, make_buffers, make_composite
from eigenfield.rendering.shots import refuse_attributes
from eigenfield.rendering.tiles import empty_layers, read_layers, tile_shape
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
    textures: how many eigen textures to sum. Raises OutputError, OptionError (`textures`, `not-a-picture`).
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
        height, width = scene.atlas
        write_listing(part, "maps", {"size": [width, height], "maps": dict(zip(names, files, strict=True))})


def camera_maps(scene: Scene) -> Callable[[int, int | None], NDArray[np.float32]]:
    """A function of an encoded camera's row and a number of eigen textures: its (H, W, C) texture map, not cut."""
    refuse_attributes(scene.channels)
    every = np.ones(tile_shape(scene.atlas), np.bool_)
    composite = make_composite(scene, every)

    def make(row: int, textures: int | None) -> NDArray[np.float32]:
        layers = empty_layers(*scene.atlas, scene.channels)
        mix = np.zeros(len(scene.encoded))
        mix[row] = 1
        compose_scene(composite, mix, textures, every, make_buffers(composite), layers)
        return read_layers(layers, *scene.atlas, scene.channels)

    return make
