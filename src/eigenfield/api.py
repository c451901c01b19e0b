"""What `import eigenfield` adds to the rooms: a scene that saves and draws itself, and the functions that return one.

`core.Scene` is data, and knows nothing of files and renderers, which lie above it. What is convenient to have as a
method stands here, above them all: each method is the function of the same name.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import ParamSpec

import numpy as np
from numpy.typing import NDArray

from eigenfield import encoding, gltf, rendering
from eigenfield.core import scene as data
from eigenfield.encoding.geometry.exchange import with_mesh

P = ParamSpec("P")


@dataclass(frozen=True, eq=False, repr=False)
class Scene(data.Scene):
    __doc__ = data.Scene.__doc__  # it has the same parts

    render = rendering.render
    render_many = rendering.render_many
    save = gltf.save
    texture = rendering.texture
    with_mesh = with_mesh

    @property
    def mean(self) -> NDArray[np.float32]:
        """(H, W, C) float32: the mean texture at the atlas's size, which cannot be written to."""
        return rendering.mean_texture(self)

    def _repr_html_(self) -> str:
        """The viewer in a frame, for notebooks."""
        from eigenfield.viewer import scene_html  # a server and its kin, which only notebooks need

        return scene_html(self)


def _returning_scene(function: Callable[P, data.Scene]) -> Callable[P, Scene]:
    @functools.wraps(function)
    def call(*args: P.args, **named: P.kwargs) -> Scene:
        made = function(*args, **named)
        return Scene(**{one.name: getattr(made, one.name) for one in fields(made) if one.init})

    return call


encode = _returning_scene(encoding.encode)
load = _returning_scene(gltf.load)
