"""The software renderer: a viewpoint in, a picture out (equations 7 and 8)."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.arguments import checked
from eigenfield.core.camera import Camera
from eigenfield.core.camera_names import named_camera
from eigenfield.core.clip import Clip
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.scene import Scene
from eigenfield.gltf import as_scene
from eigenfield.rendering.novel import novel_camera
from eigenfield.rendering.options import BLACK, PICTURE_DEFAULTS, PictureOptions, background_of
from eigenfield.rendering.picture import Picture, camera_colour, colour_changes, mixed_colour, undo_colour
from eigenfield.rendering.software import drawing
from eigenfield.rendering.software.composite import compose_scene, make_buffers, make_composite
from eigenfield.rendering.software.sheets import make_stack, set_up_sheets, shade_sheets
from eigenfield.rendering.software.tiles import empty_layers, fill_layers, read_layers
from eigenfield.rendering.weights import ViewWeights, camera_weights, view_weights

RENDER_PLACE_TOLERANCE = 1e-6  # half widths of the array, by which a viewpoint may be rounded beyond its edge
RENDER_SPARE_BUFFERS = 4  # sets kept for the next pictures


@dataclass(frozen=True, eq=False)
class Buffers:
    """The memory in which one picture is drawn.

    Attributes:
        frame: Where its samples land.
        sums: Of `make_buffers`.
        layers: Of `empty_layers`.
    """

    frame: drawing.Framebuffer
    sums: list[NDArray[np.float32]]
    layers: NDArray[np.float32]


class Renderer:
    """Draws a scene; prepared once, then callable from any number of threads at a time."""

    def __init__(self, scene: Scene) -> None:
        """Prepare a scene."""
        self.channels = scene.appearance.channels
        self._changes = colour_changes(scene)
        self._surface = drawing.make_surface(scene.proxy.mesh, *scene.appearance.atlas)
        self._detail = drawing.median_footprint(self._surface, scene.rig.cameras[scene.rig.reference])
        sheets, used = scene.proxy.sheets, self._surface.used
        self._stack = None if sheets is None else make_stack(sheets, self._surface.size)
        if self._stack is None:
            self._composite = make_composite(scene, used)
        else:
            self._composite = make_composite(scene, used & self._stack.visible, self._stack.opacity)
        self._spare: deque[Buffers] = deque(maxlen=RENDER_SPARE_BUFFERS)

    def draw(
        self,
        camera: Camera,
        weights: ViewWeights,
        options: PictureOptions = PICTURE_DEFAULTS,
        *,
        colour: NDArray[np.float32] | None = None,
        **changes: Any,
    ) -> Picture:
        """A view.

        Args:
            weights: What is blended (`view_weights`, `camera_weights`).
            colour: (2, 3) gain and offset of R, G, B that harmonised a captured camera (`camera_colour`): the surface
                gets that camera's own exposure. Default: what the weights mix, or the scene's common exposure.
            changes: Fields of `PictureOptions` by name, in place of those of `options`.

        Raises:
            OptionError: `filter`, `samples`, `textures`, `background`.
        """
        options = replace(options, **changes)
        behind, samples = background_of(options.background, self.channels), options.samples
        if samples is None and self._stack is not None:
            samples = self.grid_side(camera)  # no edge is smoothed
        sampling = drawing.choose_sampling(self._surface, camera, samples, self._detail)
        buffers = self._take(camera.height, camera.width, sampling)
        frame, layers, bands = buffers.frame, buffers.layers, []
        if self._stack is None:
            drawing.rasterise_surface(self._surface, camera, sampling, frame)
        else:
            bands = set_up_sheets(self._surface, camera, frame)
        compose_scene(self._composite, weights, options.textures, frame.needed != 0, buffers.sums, layers)
        if self._stack is None:
            image, coverage = drawing.shade(self._surface, frame, layers, options.filter, behind)
        else:
            image, coverage = shade_sheets(self._surface, self._stack, bands, frame, layers, options.filter, behind)
        self._spare.append(buffers)
        colour = mixed_colour(self._changes, weights) if colour is None else colour
        if colour is not None:
            image = undo_colour(image, coverage, behind, colour)
        return Picture(image, coverage)

    def grid_side(self, camera: Camera) -> int:
        """k of the k x k samples a pixel that are taken by default; 1: smooth edges."""
        return drawing.grid_side(self._surface, camera, self._detail)

    def texture(self, weights: ViewWeights, textures: int | None = None) -> NDArray[np.float32]:
        """(H, W, C): equation 8 for the tiles that the mesh uses, with so many eigen textures a basis; else zero."""
        layers = empty_layers(*self._surface.size, self.channels)
        compose_scene(self._composite, weights, textures, self._surface.used, make_buffers(self._composite), layers)
        return read_layers(layers, *self._surface.size, self.channels)

    def _take(self, height: int, width: int, sampling: drawing.Sampling) -> Buffers:
        """Buffers for a picture of that size: spare ones, or new ones."""
        for _ in range(len(self._spare)):
            try:
                spare = self._spare.pop()
            except IndexError:  # another thread was faster
                break
            if spare.frame.fits(height, width, sampling):
                return spare
        frame = drawing.Framebuffer(self._surface, height, width, sampling)
        return Buffers(frame, make_buffers(self._composite), empty_layers(*self._surface.size, self.channels))


def draw_texture(
    mesh: Mesh,
    texture: NDArray[np.float32],
    camera: Camera,
    options: PictureOptions = PICTURE_DEFAULTS,
    *,
    detail: float = 1.0,
    **changes: Any,
) -> Picture:
    """A view of one plain texture on a mesh: a camera's own texture map, or the mean.

    Args:
        mesh: With UVs.
        texture: (H, W, C) float32.
        detail: Texels for one pixel of the photographs.
        changes: Fields of `PictureOptions` by name, in place of those of `options`.

    Raises:
        OptionError: `filter`, `samples`, `background`.
    """
    options = replace(options, **changes)
    height, width, channels = texture.shape
    surface = drawing.make_surface(mesh, height, width)
    sampling = drawing.choose_sampling(surface, camera, options.samples, detail)
    frame = drawing.Framebuffer(surface, camera.height, camera.width, sampling)
    drawing.rasterise_surface(surface, camera, sampling, frame)
    layers = empty_layers(height, width, channels)
    fill_layers(texture, layers)
    behind = background_of(options.background, channels)
    return Picture(*drawing.shade(surface, frame, layers, options.filter, behind))


def renderer_of(scene: Scene) -> Renderer:
    """The scene's renderer, made on the first call and kept as long as the scene."""
    return scene.derive("software renderer", lambda: Renderer(scene))


@checked
def render(
    scene: Scene | Clip | str | os.PathLike[str],
    *,
    at: tuple[float, float] | None = None,
    camera: str | None = None,
    time: float | None = None,
    resolution: tuple[int, int] | None = None,
    weights: str = "delaunay",
    filter: str = "bicubic",
    background: Sequence[float] = BLACK,
    textures: int | None = None,
    samples: int | None = None,
) -> Picture:
    """Draw a view; the reference camera's if neither `at` nor `camera` is given.

    In a harmonised scene a captured camera's picture has that camera's own exposure, and a viewpoint's is mixed of
    those around it by the same weights as the textures. May be called from several threads.

    Args:
        scene: The scene or the clip, or its file, which is read at every call.
        at: View-plane coordinates: X right, Y up, ±1 at the array's edges.
        camera: Name of a capture camera.
        time: Seconds, of a clip, of which the nearest frame is drawn.
        resolution: (width, height). Default: the camera's own.
        weights: `delaunay`, `nearest3` or `bilinear`.
        filter: `bilinear` or `bicubic` (Catmull-Rom).
        background: A sequence of one number for all channels, or of one for each, 0..1.
        textures: How many eigen textures of each basis at most. Default: all.
        samples: k of k x k samples a pixel, 1 to 16. Default: one, but four at edges, or more in a picture smaller than
            the photographs.

    Raises:
        OptionError: `unknown-camera`, `viewpoint`, `weights-mode`, `no-grid`, `resolution`, `filter`,
            `background`, `textures`, `samples`, `time`.
        FormatError: The file is no scene.
    """
    found = as_scene(scene, time)
    view, mix = viewpoint(found, at=at, camera=camera, weights=weights)
    if resolution is not None:
        view = at_resolution(view, resolution)
    colour = viewpoint_colour(found, at=at, camera=camera)
    return renderer_of(found).draw(
        view, mix, filter=filter, background=background, textures=textures, samples=samples, colour=colour
    )


def viewpoint(
    scene: Scene,
    *,
    at: tuple[float, float] | None = None,
    camera: str | None = None,
    weights: str = "delaunay",
) -> tuple[Camera, ViewWeights]:
    """The camera and the view weights of a place, of a capture camera, or of the reference camera.

    Args:
        at: View-plane coordinates.
        camera: Name or index of a capture camera.
        weights: One of `WEIGHT_MODES`.

    Raises:
        OptionError: `unknown-camera`, `viewpoint`, `weights-mode`, `no-grid`.
    """
    if at is not None and camera is not None:
        raise OptionError("viewpoint", "a place and a camera were both given", remedy="give one of them")
    if at is not None and not all(abs(v) <= 1 + RENDER_PLACE_TOLERANCE for v in at):  # False for NaN
        x, y = (min(max(v, -1e9), 1e9) for v in at)  # integers may be beyond what floats hold
        message = f"the viewpoint {x:g},{y:g} lies outside the array"
        raise OptionError("viewpoint", message, remedy="give two numbers from -1 to 1; 0,0 is its middle")
    if at is not None:
        return novel_camera(scene, at), view_weights(scene, at, weights)
    index = scene.rig.reference if camera is None else camera_index(scene, camera)
    return scene.rig.cameras[index], camera_weights(scene, index, weights)


def viewpoint_colour(
    scene: Scene, *, at: tuple[float, float] | None = None, camera: str | None = None
) -> NDArray[np.float32] | None:
    """The `colour` of `Renderer.draw` for a view: that of `camera_colour` for a captured camera, None for a place.

    Raises:
        OptionError: `unknown-camera`.
    """
    if at is not None:
        return None
    return camera_colour(scene, scene.rig.reference if camera is None else camera_index(scene, camera))


def camera_index(scene: Scene, name: str) -> int:
    """The index of a camera.

    Args:
        name: Of the camera, with or without its ending.

    Raises:
        OptionError: `unknown-camera`, with the names most like it.
    """
    return named_camera(name, scene.rig.names, "unknown-camera")


def at_resolution(camera: Camera, resolution: tuple[int, int]) -> Camera:
    """The camera with another resolution.

    Args:
        resolution: (width, height), 1 to 16384 each.

    Raises:
        OptionError: `resolution`.
    """
    width, height = resolution
    if not (1 <= width <= 16384 and 1 <= height <= 16384):
        raise OptionError("resolution", f"a picture of {width}x{height}", remedy="give 1x1 to 16384x16384")
    return camera.resize(width, height)
