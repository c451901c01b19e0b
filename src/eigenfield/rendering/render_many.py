"""Many views of a scene as arrays, one after the other."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.arguments import checked
from eigenfield.core.camera import Camera
from eigenfield.core.clip import Clip
from eigenfield.core.errors import OptionError
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.gltf import as_scene
from eigenfield.rendering.options import BLACK, PictureOptions
from eigenfield.rendering.picture import Picture
from eigenfield.rendering.software.renderer import at_resolution, renderer_of, viewpoint, viewpoint_colour
from eigenfield.rendering.weights import ViewWeights
from eigenfield.runtime.parallel import parallel_stream

View = tuple[tuple[Camera, ViewWeights], NDArray[np.float32] | None]


@checked
def render_many(
    scene: Scene | Clip | str | os.PathLike[str],
    *,
    at: Sequence[tuple[float, float]] | None = None,
    cameras: Sequence[str] | None = None,
    time: float | None = None,
    resolution: tuple[int, int] | None = None,
    weights: str = "delaunay",
    filter: str = "bicubic",
    background: Sequence[float] = BLACK,
    textures: int | None = None,
    samples: int | None = None,
    progress: Progress | None = notebook_progress,
) -> Iterator[Picture]:
    """Draw many views, several at a time; those of all capture cameras if neither `at` nor `cameras` is given.

    The pictures come in the order of the views while the next ones are drawn, so that a long flight fits into memory.
    The first one is drawn before this returns: what is wrong with an argument is raised here.

        for picture in ef.render_many(scene, at=[(x / 10, 0.0) for x in range(-10, 11)]):
            frames.append(picture.to_uint8())

    Args:
        scene: The scene or the clip, or its file.
        at: (n, 2) view-plane coordinates: an array, or a sequence of pairs.
        cameras: Names of capture cameras.
        time: Seconds, of a clip, of which the nearest frame is drawn.
        resolution: (width, height), and the next five: as of `render`.
        weights: `delaunay`, `nearest3` or `bilinear`.
        filter: `bilinear` or `bicubic`.
        background: A sequence of one number for all channels, or of one for each.
        textures: How many eigen textures of each basis at most.
        samples: k of k x k samples a pixel.
        progress: Reports each picture; by default a bar in a notebook.

    Raises:
        OptionError, FormatError: As `render`.
    """
    found = as_scene(scene, time)
    if at is not None and cameras is not None:
        raise OptionError("viewpoint", "places and cameras were both given", remedy="give one of them")
    names = found.names if cameras is None else cameras
    places: list[dict[str, Any]] = (
        [{"camera": name} for name in names] if at is None else [{"at": (float(x), float(y))} for x, y in at]
    )
    views = [(viewpoint(found, weights=weights, **place), viewpoint_colour(found, **place)) for place in places]
    renderer = renderer_of(found)
    options = PictureOptions(filter=filter, background=background, textures=textures, samples=samples)

    def draw(view: View) -> Picture:
        (camera, mix), colour = view
        view_camera = camera if resolution is None else at_resolution(camera, resolution)
        return renderer.draw(view_camera, mix, options, colour=colour)

    first = [draw(view) for view in views[:1]]
    return track(chain(first, parallel_stream(draw, views[1:])), "drawing", len(views), progress)
