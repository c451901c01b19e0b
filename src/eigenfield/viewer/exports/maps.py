"""The texture map of every encoded camera, as the file has it: mean and eigen textures with that camera's weights."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from eigenfield.core.appearance import Basis
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering.options import check_textures
from eigenfield.rendering.render_jobs import refuse_attributes
from eigenfield.rendering.software.kernels import TILE_TEXELS
from eigenfield.rendering.software.resample import tap_matrix
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
        textures: Number of eigen textures of each basis. Default: all.

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
        listed = {"size": [width, height], "maps": dict(zip(names, files, strict=True))}
        write_listing(part, "maps", listed, scene.rights)


def alpha_added(scene: Scene) -> Callable[[NDArray[np.float32]], NDArray[np.float32]]:
    """A function of a map (H, W, C): R, G, B and opacity (H, W, 4) of sheets, else the map.

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


def eigen_maps(scene: Scene, count: int) -> Iterator[tuple[Callable[[], NDArray[np.float32]], NDArray[np.float32]]]:
    """Every eigen texture of every plane: a function that makes what it adds to a drawn picture, and its (No,) weights.

    That is (C, H, W) of the whole atlas, and (1, H, W) where it is the same in R, G and B.

    Args:
        count: Number of eigen textures of each basis.
    """
    appearance = scene.appearance
    to_rgb = np.eye(appearance.channels, dtype=np.float32) if appearance.to_rgb is None else appearance.to_rgb
    for plane, own in zip(appearance.planes, appearance.channel_slices, strict=True):
        share = to_rgb[:, own]
        share = share[:1] if (share == share[0]).all() else share
        for basis in plane.bases:
            sides = zip(appearance.atlas, basis.size, basis.corner, basis.textures.shape[1:3], strict=True)
            taps = [tap_matrix(fine, coarse)[:, first : first + extent] for fine, coarse, first, extent in sides]
            for index in range(min(count, basis.count)):
                yield partial(_enlarged, basis, index, share, taps), basis.weights[:, index]


def _enlarged(basis: Basis, index: int, share: NDArray[np.float32], taps: Sequence[csr_array]) -> NDArray[np.float32]:
    rows, columns = taps
    mixed = np.moveaxis(basis.values(index, index + 1)[0] @ share.T, 2, 0)
    return np.stack([(columns @ (rows @ channel).T).T for channel in mixed])
