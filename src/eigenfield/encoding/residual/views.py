"""Captured views as they were photographed: what the scene draws of an encoded camera, and the residual on it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import OptionError
from eigenfield.core.scene import Residual, Scene
from eigenfield.encoding.residual.colour import to_difference
from eigenfield.gltf.layout_residual import residual_frames
from eigenfield.rendering import Picture, RenderJob, camera_colour, camera_weights, renderer_of


def differences(scene: Scene) -> Iterator[tuple[int, NDArray[np.float32]]]:
    """Camera, counted among all, and its (H, W, 3) residual, one after the other in the video's order.

    Raises:
        OptionError: `residual`, the scene has none.
        FormatError: `residual-damaged`.
    """
    residual = _residual(scene)
    for row, planes in zip(residual.order, residual_frames(residual), strict=True):
        index = int(scene.rig.encoded[row])
        camera = scene.rig.cameras[index]
        yield index, to_difference(planes, camera.height, camera.width, residual.scale, residual.full_chroma)


def with_differences(
    scene: Scene, cameras: Iterable[int], wanted: bool = True
) -> Iterator[tuple[int, NDArray[np.float32] | None]]:
    """Each of these cameras once: those that have a residual with it, in the video's order, then the others.

    Args:
        scene: With a residual, if one is wanted.
        cameras: Counted among all.
        wanted: False: all cameras without a residual.
    """
    left = dict.fromkeys(cameras)
    if wanted:
        for index, difference in differences(scene):
            if index in left:
                del left[index]
                yield index, difference
    yield from left.items()


def difference_of(scene: Scene, index: int) -> NDArray[np.float32]:
    """(H, W, 3): the residual of an encoded camera, counted among all. Every frame before it is decoded.

    Raises:
        OptionError: `residual`, the camera has none.
        FormatError: As `differences`.
    """
    residual = _residual(scene)
    if scene.rig.held_out[index]:
        message = f"{scene.rig.names[index]} is held out: it has no residual"
        raise OptionError("residual", message, remedy="name an encoded camera")
    position = int(np.flatnonzero(residual.order == scene.rows(index))[0])
    camera = scene.rig.cameras[index]
    for number, planes in enumerate(residual_frames(residual)):
        if number == position:
            return to_difference(planes, camera.height, camera.width, residual.scale, residual.full_chroma)
    raise AssertionError("a video ends with an error")


def corrected_picture(
    picture: Picture, difference: NDArray[np.float32], background: Sequence[float] = (0.0,)
) -> Picture:
    """The picture of a captured camera with its residual, which is added to the surface's own colours, clipped to 0..1
    before and after.

    Args:
        difference: (H, W, 3) of `difference_of`.
        background: That it was drawn with.
    """
    part = picture.coverage[..., None]
    behind = (1 - part) * np.asarray(background, np.float32)
    own = surface_colours(picture, background)
    own += difference
    return Picture(np.clip(own, 0, 1) * part + behind, picture.coverage)


def captured_samples(scene: Scene, index: int) -> int | None:
    """`samples` of a renderer for the picture of a camera that the scene's residual belongs to."""
    return None if _residual(scene).smooth_edges else renderer_of(scene).grid_side(scene.rig.cameras[index])


def captured_pixels(job: RenderJob, index: int, difference: NDArray[np.float32]) -> NDArray[np.uint8]:
    """`RenderJob.pixels` of a captured camera with its residual.

    Args:
        index: Of the camera, counted among all.
        difference: (H, W, 3) of `difference_of`.

    Raises:
        OptionError: `residual`, the job does not draw as the residual needs it.
    """
    scene, usual = job.scene, RenderJob(job.scene)
    for name in ("resolution", "filter", "textures", "samples", "renderer"):
        if getattr(job, name) != getattr(usual, name):
            message = f"--{name} draws other pictures than the residual belongs to"
            raise OptionError("residual", message, remedy="leave one of them out")
    job = replace(job, samples=captured_samples(scene, index))
    picture = job.picture(scene.rig.cameras[index], camera_weights(scene, index), camera_colour(scene, index))
    return job.pixels_of(corrected_picture(picture, difference, job.background or (0.0,)))


def surface_colours(picture: Picture, background: Sequence[float] = (0.0,)) -> NDArray[np.float32]:
    """(H, W, 3): colours of the proxy in each pixel without the background, clipped to 0..1; 0 where it is not seen."""
    part = picture.coverage[..., None]
    surface = picture.image - (1 - part) * np.asarray(background, np.float32)
    return np.clip(np.divide(surface, part, out=np.zeros_like(surface), where=part > 0), 0, 1)


def _residual(scene: Scene) -> Residual:
    if scene.residual is None:
        raise OptionError("residual", "the scene has no residual", remedy="encode it with --residual")
    return scene.residual
