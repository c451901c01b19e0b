"""Many pictures of a scene with the same options, as files need them, and a flight as a video or numbered pictures."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.clip import Clip
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.imaging.colour import as_rgb
from eigenfield.imaging.metrics import to_codes
from eigenfield.imaging.png import png_bytes
from eigenfield.rendering.opengl.renderer import OpenGLRenderer
from eigenfield.rendering.options import PictureOptions
from eigenfield.rendering.picture import Picture
from eigenfield.rendering.software.renderer import at_resolution, renderer_of, viewpoint
from eigenfield.rendering.video import write_video
from eigenfield.rendering.weights import ViewWeights
from eigenfield.runtime.files import atomic_files, is_numbered, numbered_files, refuse_existing
from eigenfield.runtime.parallel import parallel_stream

RENDERERS = ("software", "opengl")
OPENGL_EDGE_SAMPLES = 4  # a pixel
Item = TypeVar("Item")
Drawn = TypeVar("Drawn")


@dataclass(frozen=True, eq=False)
class RenderJob(PictureOptions):
    """A scene, and how pictures of it are drawn.

    Attributes:
        resolution: (width, height). Default: the camera's own.
        weights: One of `WEIGHT_MODES`.
        renderer: `software`, or `opengl`, which has no `samples` but smooths edges, and draws in one thread.

    Raises:
        OptionError: `filter`, `textures`, `renderer`, `samples`.
    """

    scene: Scene
    resolution: tuple[int, int] | None = None
    weights: str = "delaunay"
    renderer: str = "software"

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.renderer not in RENDERERS:
            remedy = f"use one of {', '.join(RENDERERS)}"
            raise OptionError("renderer", f"no renderer is called {self.renderer!r}", remedy=remedy)
        if self.renderer == "opengl" and self.samples is not None:
            raise OptionError("samples", "OpenGL chooses its samples itself", remedy="leave them out")

    def picture(self, camera: Camera, weights: ViewWeights, colour: NDArray[np.float32] | None = None) -> Picture:
        """One picture, on black where the background is transparent.

        Raises:
            OptionError: `not-a-picture`: the scene has other than 1 or 3 channels; as `Renderer.draw`.
        """
        view = camera if self.resolution is None else at_resolution(camera, self.resolution)
        behind = self.background or (0.0,)
        if self.renderer == "opengl":
            return self._opengl.draw(view, weights, background=behind, textures=self.textures, colour=colour)
        renderer = renderer_of(self.scene)
        refuse_attributes(renderer.channels)
        if renderer.channels != len(behind):
            behind = (sum(behind) / len(behind),)  # a grey
        return renderer.draw(view, weights, self, background=behind, colour=colour)

    def rgb(self, camera: Camera, weights: ViewWeights) -> NDArray[np.uint8]:
        """(H, W, 3) uint8 of `picture`; greys are repeated."""
        return as_rgb(self.picture(camera, weights).to_uint8())

    def pixels(
        self, camera: Camera, weights: ViewWeights, colour: NDArray[np.float32] | None = None
    ) -> NDArray[np.uint8]:
        """(H, W, 1 to 4) uint8 as `png` takes it, with straight alpha where the background is transparent."""
        return self.pixels_of(self.picture(camera, weights, colour))

    def pixels_of(self, picture: Picture) -> NDArray[np.uint8]:
        """`pixels` of a drawn picture."""
        if self.background is not None:
            return picture.to_uint8()
        part = picture.coverage[..., None]
        straight = np.divide(picture.image, part, out=np.zeros_like(picture.image), where=part > 0)
        return to_codes(np.concatenate([straight, part], axis=2))

    def png(self, camera: Camera, weights: ViewWeights, colour: NDArray[np.float32] | None = None) -> bytes:
        """The bytes of a .png."""
        return png(self.pixels(camera, weights, colour))

    def along(
        self,
        draw: Callable[[Camera, ViewWeights], Drawn],
        points: NDArray[np.float64],
        progress: Progress | None = None,
    ) -> Iterator[Drawn]:
        """draw(camera, weights) for each viewpoint, in order.

        Args:
            draw: A method such as `png`.
            points: (n, 2) viewpoints.
        """
        views = (viewpoint(self.scene, at=(float(x), float(y)), weights=self.weights) for x, y in points)
        return track(self.each(lambda view: draw(*view), views), "drawing", len(points), progress)

    def each(self, draw: Callable[[Item], Drawn], items: Iterable[Item]) -> Iterator[Drawn]:
        """draw(item) for each item, in order; in several threads where the renderer allows it."""
        return map(draw, items) if self.renderer == "opengl" else parallel_stream(draw, items)

    @cached_property
    def _opengl(self) -> OpenGLRenderer:
        return OpenGLRenderer(self.scene, filter=self.filter, multisample=OPENGL_EDGE_SAMPLES)


def png(picture: NDArray[np.uint8]) -> bytes:
    """The bytes of a .png of (H, W, 1 to 4) uint8: grey, grey and alpha, RGB, RGBA."""
    if picture.shape[2] in (1, 3):
        return png_bytes(picture)
    from PIL import Image

    data = io.BytesIO()
    Image.fromarray(picture).save(data, "PNG", compress_level=3)
    return data.getvalue()


def refuse_attributes(channels: int) -> None:
    """Refuse scenes whose channels make no picture.

    Raises:
        OptionError: `not-a-picture`: neither 1 nor 3.
    """
    if channels not in (1, 3):
        remedy = "draw it with eigenfield.render from Python, which returns arrays"
        raise OptionError("not-a-picture", f"the scene has {channels} channels, which make no picture", remedy=remedy)


def write_flight(
    job: RenderJob,
    points: NDArray[np.float64],
    output: Path,
    fps: Fraction,
    *,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Draw viewpoints into a video, or into a .png each. All files appear at the end, or none.

    Args:
        points: (n, 2) viewpoints.
        output: An .mp4, or a .png whose name has a %04d.
        fps: Pictures a second of the video.

    Raises:
        OptionError: As `Renderer.draw`.
        OutputError: A file cannot be written.
    """
    if is_numbered(output):
        write_numbered(job.along(job.png, points, progress), len(points), output, overwrite)
    else:
        write_video(output, job.along(job.rgb, points, progress), fps, overwrite=overwrite)


def write_clip_flight(
    clip: Clip,
    frames: range,
    places: Sequence[Mapping[str, Any]],
    output: Path,
    fps: Fraction,
    *,
    overwrite: bool = False,
    progress: Progress | None = None,
    **picture: Any,
) -> None:
    """As `write_flight`, of frames of a clip. A video in which time passes as in the clip has its sound, too.

    Args:
        frames: Their numbers.
        places: For each the place to draw it from: arguments of `viewpoint`.
        picture: Fields of `RenderJob`.
    """
    scenes = (clip.scene(float(time)) for time in clip.timeline.times[frames.start : frames.stop])
    jobs = ((RenderJob(scene, **picture), place) for scene, place in zip(scenes, places, strict=True))
    numbered, one_thread = is_numbered(output), picture.get("renderer") == "opengl"

    def draw(item: tuple[RenderJob, Mapping[str, Any]]) -> Any:
        job, place = item
        view = viewpoint(job.scene, weights=job.weights, **place)
        return job.png(*view) if numbered else job.rgb(*view)

    made = map(draw, jobs) if one_thread else parallel_stream(draw, jobs)
    made = track(made, "drawing", len(frames), progress)
    if numbered:
        write_numbered(made, len(frames), output, overwrite)
    else:
        audio, sound = clip.audio, None
        if audio is not None and fps == clip.timeline.rate:
            sound = audio.data, float(clip.timeline.times[frames.start]) - audio.first
        write_video(output, made, fps, sound=sound, overwrite=overwrite)


def write_numbered(pictures: Iterator[bytes], count: int, output: Path, overwrite: bool) -> None:
    """Write so many pictures as files that appear together; output: a .png whose name has a %04d."""
    with atomic_files(numbered_files(output, count), overwrite=overwrite) as places:
        for place, data in zip(places, pictures, strict=True):
            place.write_bytes(data)


def refuse_flight(output: Path, count: int, overwrite: bool) -> None:
    """Before any work: check that all files may be written.

    Raises:
        OutputError: One of the files may not or cannot be written.
    """
    for path in numbered_files(output, count) if is_numbered(output) else [output]:
        refuse_existing(path, overwrite)
