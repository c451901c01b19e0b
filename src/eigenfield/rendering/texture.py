"""Equation 8 over the whole atlas: the texture of a camera or of a viewpoint, and the mean."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.arguments import checked
from eigenfield.core.scene import Scene
from eigenfield.gltf import as_scene
from eigenfield.rendering.options import check_textures
from eigenfield.rendering.software.composite import compose_scene, make_buffers, make_composite
from eigenfield.rendering.software.renderer import viewpoint
from eigenfield.rendering.software.tiles import empty_layers, read_layers, tile_shape
from eigenfield.rendering.weights import ViewWeights


@checked
def texture(
    scene: Scene | str | os.PathLike[str],
    camera: str | None = None,
    *,
    at: tuple[float, float] | None = None,
    weights: str = "delaunay",
    textures: int | None = None,
) -> NDArray[np.float32]:
    """(H, W, C) float32: the texture with which a view is drawn, over the whole atlas (equation 8); the reference
    camera's if neither `camera` nor `at` is given.

    It is not clipped. Texels outside the charts are what the scene holds there. In a harmonised scene it has the common
    exposure. The opacity of sheets is apart, in `scene.proxy.sheets`.

    Args:
        scene: The scene, or its file.
        camera: Name of a capture camera: the mean plus the eigen textures with its own weights. A held-out camera has
            the weights of where it stands.
        at: View-plane coordinates, as of `render`.
        weights: As of `render`.
        textures: Number of eigen textures of each basis. Default: all.

    Raises:
        OptionError: `unknown-camera`, `viewpoint`, `weights-mode`, `no-grid`, `textures`.
        FormatError: The file is no scene.
    """
    check_textures(textures)
    found = as_scene(scene)
    return atlas_composer(found)(viewpoint(found, at=at, camera=camera, weights=weights)[1], textures)


def mean_texture(scene: Scene) -> NDArray[np.float32]:
    """(H, W, C) float32: the means of all planes as one texture at the atlas's size, not clipped. It is computed once,
    and cannot be written to."""

    def make() -> NDArray[np.float32]:
        planes = (
            replace(plane, bases=tuple(basis.truncate(0) for basis in plane.bases)) for plane in scene.appearance.planes
        )
        bare = replace(scene, appearance=replace(scene.appearance, planes=tuple(planes)))
        mean = atlas_composer(bare)(ViewWeights(), 0)
        mean.setflags(write=False)
        return mean

    return scene.derive("mean texture", make)


def atlas_composer(scene: Scene) -> Callable[[ViewWeights, int | None], NDArray[np.float32]]:
    """A function of view weights and a number of eigen textures of each basis, or None for all: the (H, W, C) texture.
    May be called from any thread."""
    size, channels = scene.appearance.atlas, scene.appearance.channels
    every = np.ones(tile_shape(size), np.bool_)
    composite = make_composite(scene, every)

    def compose(weights: ViewWeights, textures: int | None) -> NDArray[np.float32]:
        layers = empty_layers(*size, channels)
        compose_scene(composite, weights, textures, every, make_buffers(composite), layers)
        return read_layers(layers, *size, channels)

    return compose
