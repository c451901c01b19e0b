"""What `import eigenfield` adds to the rooms: a scene and a clip that save and draw themselves, and the functions that
return one.

`core.Scene` and `core.Clip` are data, and know nothing of files and renderers, which lie above them. What is convenient
to have as a method stands here, above all rooms: each method is the function of the same name.
"""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from typing import Any, ParamSpec, overload

import numpy as np
from numpy.typing import NDArray

from eigenfield import encoding, gltf, rendering
from eigenfield.capture import Capture, Footage
from eigenfield.core import clip as clip_data
from eigenfield.core import scene as data
from eigenfield.core.observations import CalibratedObservations
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


@dataclass(frozen=True, eq=False, repr=False)
class Clip(clip_data.Clip):
    __doc__ = clip_data.Clip.__doc__  # it has the same parts

    render = rendering.render
    render_many = rendering.render_many
    save = gltf.save

    @property
    def times(self) -> NDArray[np.float64]:
        """(n,) seconds of the frames."""
        return self.timeline.times

    def scene(self, time: float) -> Scene:
        """The frame nearest to a time in seconds. OptionError `time`, outside the clip."""
        return _with_methods(super().scene(time))

    def scenes(self, first: float | None = None, last: float | None = None) -> Iterator[Scene]:
        """The frames from one time to another, both in seconds, one after the other; by default all."""
        times = self.times
        ends = [times[index] if time is None else time for index, time in ((0, first), (-1, last))]
        start, stop = map(self.timeline.frame_at, ends)
        return map(self.scene, times[start : stop + 1])

    def _repr_html_(self) -> str:
        """The viewer in a frame, for notebooks."""
        from eigenfield.viewer import scene_html

        return scene_html(self)


def _with_methods(scene: data.Scene) -> Scene:
    return Scene(**{one.name: getattr(scene, one.name) for one in fields(scene) if one.init})


def _returning_scene(function: Callable[P, data.Scene]) -> Callable[P, Scene]:
    @functools.wraps(function)
    def call(*args: P.args, **named: P.kwargs) -> Scene:
        return _with_methods(function(*args, **named))

    return call


def _clip_with_methods(clip: clip_data.Clip) -> Clip:
    return Clip(**{one.name: getattr(clip, one.name) for one in fields(clip)})


@functools.wraps(gltf.load_clip)
def load_clip(path: str | os.PathLike[str]) -> Clip:
    return _clip_with_methods(gltf.load_clip(path))


_encode_scene = _returning_scene(encoding.encode)


@overload
def encode(capture: Footage, *args: Any, **named: Any) -> Clip: ...


@overload
def encode(capture: str | os.PathLike[str] | Capture | CalibratedObservations, *args: Any, **named: Any) -> Scene: ...


@functools.wraps(encoding.encode)
def encode(*args: Any, **named: Any) -> Scene | Clip:
    if isinstance(args[0] if args else named.get("capture"), Footage):
        footage = args[0] if args else named.pop("capture")
        return _clip_with_methods(encoding.encode_footage(footage, *args[1:], **named))
    return _encode_scene(*args, **named)


load = _returning_scene(gltf.load)
