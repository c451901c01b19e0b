"""The texture map of every encoded camera, as the file has it: mean and eigen textures with that camera's weights."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Plane
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering.checks import check_textures
from eigenfield.rendering.render_jobs import refuse_attributes
from eigenfield.rendering.software.kernels import TILE_TEXELS
from eigenfield.rendering.software.sheets import make_stack
from eigenfield.rendering.software.tiles import tile_shape
from eigenfield.rendering.texture import atlas_composer
from eigenfield.rendering.weights import ViewWeights
from eigenfield.runtime.parallel import parallel_stream
from eigenfield.viewer.exports.folder import atomic_folder, write_file, write_listing
from eigenfield.viewer.exports.names import file_names


def write_maps(
    scene: Scene,
    folder: Path,
    *,
    textures: int | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write a PNG of the whole atlas for each encoded camera: equation 8 with its own weights, clipped to 0..1.

    `eigenfield.json` says which file is whose. Texels that no camera saw are what the scene holds there. A harmonised
    scene's maps have the common exposure. The maps of sheets have their opacity as alpha.

    Args:
        scene: The scene.
        folder: To write.
        textures: Number of eigen textures of each basis. Default: all.
        overwrite: Whether an existing export is replaced.
        progress: Reports each map.

    Raises:
        OptionError: `textures`, `not-a-picture`.
        OutputError: The folder cannot be written.
    """
    check_textures(textures)
    finish = alpha_added(scene)
    compose, rows = atlas_composer(scene), scene.rows()
    names = [scene.rig.names[index] for index in scene.rig.encoded]
    files = file_names(names)
    drawn = parallel_stream(lambda row: png_bytes(finish(compose(ViewWeights.one(int(row)), textures))), rows)
    with atomic_folder(folder, overwrite) as part:
        for file, data in zip(files, track(drawn, "maps", len(names), progress), strict=True):
            write_file(part / file, data)
        height, width = scene.appearance.atlas
        write_listing(part, "maps", {"size": [width, height], "maps": dict(zip(names, files, strict=True))})


def alpha_added(scene: Scene) -> Callable[[NDArray[np.float32]], NDArray[np.float32]]:
    """A function of a map (H, W, C): R, G, B and opacity (H, W, 4) of sheets, else the map.

    Args:
        scene: The scene.

    Raises:
        OptionError: `not-a-picture`: it has other than one or three channels.
    """
    refuse_attributes(scene.appearance.channels)
    if scene.proxy.sheets is None:
        return lambda picture: picture
    height, width = scene.appearance.atlas
    rows, columns = tile_shape((height, width))
    tiles = make_stack(scene.proxy.sheets, (height, width)).opacity.reshape(rows, columns, TILE_TEXELS, TILE_TEXELS)
    whole = tiles.transpose(0, 2, 1, 3).reshape(rows * TILE_TEXELS, columns * TILE_TEXELS)
    alpha = whole[:height, :width, None].clip(0, 1)
    return lambda picture: np.concatenate([np.broadcast_to(picture, (height, width, 3)), alpha], axis=2)


def eigen_maps(scene: Scene, count: int) -> Iterator[tuple[NDArray[np.float32], NDArray[np.float32]]]:
    """Every eigen texture of every plane: (H, W, C) that it adds to a drawn picture, and its (No,) weights.

    Args:
        scene: The scene.
        count: Number of eigen textures of each basis.
    """
    kept = [[basis.truncate(count) for basis in plane.bases] for plane in scene.appearance.planes]
    total, first, planes = sum(basis.count for bases in kept for basis in bases), 0, []
    for plane, bases in zip(scene.appearance.planes, kept, strict=True):
        alone = []
        for basis in bases:
            alone.append(replace(basis, weights=np.eye(total, basis.count, -first, np.float32)))
            first += basis.count
        planes.append(Plane(np.zeros_like(plane.mean), tuple(alone)))
    compose = atlas_composer(replace(scene, appearance=replace(scene.appearance, planes=tuple(planes))))
    weights = [row for bases in kept for basis in bases for row in basis.weights.T]
    for number, row in enumerate(weights):
        yield compose(ViewWeights.one(number), None), row
