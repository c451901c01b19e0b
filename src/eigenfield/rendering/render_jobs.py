"""Many pictures of a scene under the same options, as files want them: bytes of a PNG, or RGB for a film."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering.opengl.renderer import OpenGLRenderer
from eigenfield.rendering.picture import Picture
from eigenfield.rendering.software.renderer import at_resolution, renderer_of, viewpoint
from eigenfield.rendering.weights import ViewWeights
from eigenfield.runtime.parallel import parallel_stream

RENDERERS = ("software", "opengl")
EDGE_SAMPLES = 4  # of OpenGL
Item = TypeVar("Item")
Drawn = TypeVar("Drawn")


@dataclass(frozen=True, eq=False)
class RenderJob:
    """A scene and how it is to be drawn.

    resolution: (width, height), the camera's own if None. background: 1 or 3 numbers in 0..1, None for transparent.
    weights, filter, textures, samples: as of `render`.
    renderer: `software`, or `opengl`, which has no samples but smooths edges, and draws in one thread.
    """

    scene: Scene
    resolution: tuple[int, int] | None = None
    background: tuple[float, ...] | None = (0.0, 0.0, 0.0)
    weights: str = "delaunay"
    filter: str = "bicubic"
    textures: int | None = None
    samples: int | None = None
    renderer: str = "software"

    def __post_init__(self) -> None:
        if self.renderer not in RENDERERS:
            raise OptionError(
                "renderer", f"no renderer is called {self.renderer!r}", remedy=f"use one of {', '.join(RENDERERS)}"
            )
        if self.renderer == "opengl" and self.samples is not None:
            raise OptionError("samples", "OpenGL chooses its samples itself", remedy="leave them out")

    def picture(self, camera: Camera, weights: ViewWeights, colour: NDArray[np.float32] | None = None) -> Picture:
        """One picture; black behind what is to be transparent. colour: of `Renderer.draw`.

        Raises OptionError `not-a-picture` for scenes of other than 1 or 3 channels, and those of `Renderer.draw`.
        """
        view = camera if self.resolution is None else at_resolution(camera, self.resolution)
        behind = self.background or (0.0,)
        if self.renderer == "opengl":
            return self._opengl.draw(view, weights, background=behind, textures=self.textures, colour=colour)
        renderer = renderer_of(self.scene)
        refuse_attributes(renderer.channels)
        if renderer.channels != len(behind):
            behind = (sum(behind) / len(behind),)  # a grey
        return renderer.draw(
            view, weights, filter=self.filter, background=behind, textures=self.textures, samples=self.samples,
            colour=colour,
        )  # fmt: skip

    def rgb(self, camera: Camera, weights: ViewWeights) -> NDArray[np.uint8]:
        """(H, W, 3) uint8, greys repeated."""
        image = self.picture(camera, weights).to_uint8()
        return image if image.shape[2] == 3 else np.repeat(image, 3, axis=2)

    def pixels(
        self, camera: Camera, weights: ViewWeights, colour: NDArray[np.float32] | None = None
    ) -> NDArray[np.uint8]:
        """(H, W, 1 to 4) uint8 as `png` takes it, with (straight) alpha where it is to be transparent."""
        return self.pixels_of(self.picture(camera, weights, colour))

    def pixels_of(self, picture: Picture) -> NDArray[np.uint8]:
        """`pixels` of a picture that `picture` drew."""
        if self.background is not None:
            return picture.to_uint8()
        part = picture.coverage[..., None]
        straight = np.divide(picture.image, part, out=np.zeros_like(picture.image), where=part > 0)
        values: NDArray[Any] = np.concatenate([straight, part], axis=2)
        return np.clip(np.rint(values * np.float32(255)), 0, 255).astype(np.uint8)

    def png(self, camera: Camera, weights: ViewWeights, colour: NDArray[np.float32] | None = None) -> bytes:
        """The picture as a .png."""
        return png(self.pixels(camera, weights, colour))

    def pngs_along(self, points: NDArray[np.float64], progress: Progress | None = None) -> Iterator[bytes]:
        """A .png for each of (n, 2) viewpoints."""
        drawn = self.each(lambda view: self.png(*view), self._views(points))
        return track(drawn, "drawing", len(points), progress)

    def film_along(self, points: NDArray[np.float64], progress: Progress | None = None) -> Iterator[NDArray[np.uint8]]:
        """(H, W, 3) uint8 for each of (n, 2) viewpoints."""
        drawn = self.each(lambda view: self.rgb(*view), self._views(points))
        return track(drawn, "drawing", len(points), progress)

    def each(self, draw: Callable[[Item], Drawn], items: Iterable[Item]) -> Iterator[Drawn]:
        """draw(item) for each of `items`, in order: in several threads where the renderer allows it."""
        return map(draw, items) if self.renderer == "opengl" else parallel_stream(draw, items)

    def _views(self, points: NDArray[np.float64]) -> Iterator[tuple[Camera, ViewWeights]]:
        for x, y in points:
            yield viewpoint(self.scene, at=(float(x), float(y)), weights=self.weights)

    @cached_property
    def _opengl(self) -> OpenGLRenderer:
        return OpenGLRenderer(self.scene, filter=self.filter, multisample=EDGE_SAMPLES)


def png(picture: NDArray[np.uint8]) -> bytes:
    """(H, W, 1 to 4) uint8 as a .png: grey, grey and alpha, RGB, RGBA."""
    if picture.shape[2] in (1, 3):
        return png_bytes(picture)
    from PIL import Image

    data = io.BytesIO()
    Image.fromarray(picture).save(data, "PNG", compress_level=3)
    return data.getvalue()


def refuse_attributes(channels: int) -> None:
    """Raise OptionError `not-a-picture` unless there are 1 or 3 channels."""
    if channels not in (1, 3):
        raise OptionError(
            "not-a-picture",
            f"the scene has {channels} channels, which make no picture",
            remedy="draw it with eigenfield.render from Python, which returns arrays",
        )
