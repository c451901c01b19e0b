"""`eigenfield render`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eigenfield.cli.common import common_options, note, progress_bars
from eigenfield.errors import OptionError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from eigenfield.camera import Camera
    from eigenfield.progress import Progress
    from eigenfield.rendering import Picture
    from eigenfield.scene import Scene

DEFAULT_FRAMES, DEFAULT_FPS = 120, "30"
NUMBERED = re.compile(r"%0?\d*d")


def _place(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[float, float] | None:
    if value is None:
        return None
    try:
        x, y = (float(part) for part in value.split(","))
    except ValueError:
        raise click.BadParameter("two numbers from -1 to 1 with a comma between them: 0.3,-0.2") from None
    return x, y


def _size(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[int, int] | None:
    if value is None:
        return None
    try:
        width, height = (int(part) for part in value.lower().split("x"))
    except ValueError:
        raise click.BadParameter("WIDTHxHEIGHT in pixels: 1024x768") from None
    return width, height


def _colour(context: click.Context, parameter: click.Parameter, value: str) -> tuple[float, ...] | None:
    if value == "transparent":
        return None
    if not re.fullmatch(r"#?[0-9a-fA-F]{6}", value):
        raise click.BadParameter("a colour as '#rrggbb', or transparent")
    digits = value.removeprefix("#")
    return tuple(int(digits[i : i + 2], 16) / 255 for i in (0, 2, 4))


def _rate(context: click.Context, parameter: click.Parameter, value: str) -> Fraction:
    try:
        rate = Fraction(value).limit_denominator(1001)
    except (ValueError, ZeroDivisionError):
        raise click.BadParameter("pictures a second: 30, 24000/1001") from None
    if not 0 < rate <= 1000:
        raise click.BadParameter("more than 0 and at most 1000 pictures a second")
    return rate


@click.command(
    epilog="""\b
Examples:
  eigenfield render scene.glb -o view.png
  eigenfield render scene.glb --at 0.3,-0.2 --resolution 1024x768 -o view.png
  eigenfield render scene.glb --camera out_08_08 --background transparent -o view.png
  eigenfield render scene.glb --path circle --frames 240 -o around.mp4
  eigenfield render scene.glb --path grid --frames 25 -o 'frames/%04d.png'"""
)
@click.argument("scene", type=click.Path(path_type=Path))
@click.option(
    "--output",
    "-o",
    required=True,
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="A .png, an .mp4 for a path, or a .png with %04d in its name for a path's single pictures.",
)
@click.option("--at", callback=_place, metavar="X,Y", help="Viewpoint in the array: 0,0 its middle, ±1 its edges.")
@click.option("--camera", metavar="NAME", help="A captured camera.  [default: the reference camera]")
@click.option("--path", "path", metavar="circle|spiral|grid", help="A fly-through.")
@click.option("--frames", type=int, metavar="N", help=f"Pictures of a path.  [default: {DEFAULT_FRAMES}]")
@click.option("--fps", callback=_rate, default=DEFAULT_FPS, show_default=True, metavar="F", help="Pictures a second.")
@click.option("--resolution", callback=_size, metavar="WxH", help="Size in pixels.  [default: the camera's]")
@click.option(
    "--background",
    callback=_colour,
    default="#000000",
    show_default=True,
    metavar="COLOUR",
    help="'#rrggbb', or transparent, where the proxy does not reach.",
)
@click.option(
    "--weights",
    default="delaunay",
    show_default=True,
    metavar="delaunay|nearest3|bilinear",
    help="How cameras near the viewpoint are mixed.",
)
@click.option("--filter", default="bicubic", show_default=True, metavar="bicubic|bilinear", help="Texel filter.")
@click.option("--textures", "-n", type=int, metavar="N", help="Eigen textures to sum.  [default: all]")
@click.option("--samples", type=int, metavar="K", help="K x K samples a pixel.  [default: as the density asks for]")
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@common_options
def command(
    scene: Path, output: Path, at: tuple[float, float] | None, camera: str | None, path: str | None,
    frames: int | None, fps: Fraction, resolution: tuple[int, int] | None, background: tuple[float, ...] | None,
    weights: str, filter: str, textures: int | None, samples: int | None, overwrite: bool, quiet: bool,
) -> None:  # fmt: skip
    """Draw SCENE: one picture, or a fly-through.

    The picture is that of a viewpoint in the array (--at), of a captured camera (--camera), or a path's.
    """
    _check(output, at, camera, path, frames, background)
    from eigenfield.files import refuse_existing, write_bytes
    from eigenfield.format import load
    from eigenfield.rendering import path_points, viewpoint, viewpoint_colour

    count = DEFAULT_FRAMES if frames is None else frames
    points = None if path is None else path_points(path, count)
    targets = [Path(str(output) % i) for i in range(count)] if _numbered(output) else [output]
    for target in targets:
        refuse_existing(target, overwrite)
    loaded = load(scene)
    shots = _Shots(loaded, resolution, background, weights, filter, textures, samples)
    if points is None:
        chosen = viewpoint(loaded, at=at, camera=camera, weights=weights)
        colour = viewpoint_colour(loaded, at=at, camera=camera)
        write_bytes(output, shots.png(*chosen, colour), overwrite=overwrite)
        note(f"wrote {output}", quiet)
        return
    with progress_bars(quiet) as progress:
        if _numbered(output):
            for target, view in zip(targets, shots.along(points, progress), strict=True):
                write_bytes(target, shots.png(*view), overwrite=overwrite)
        else:
            from eigenfield.rendering import write_video

            write_video(output, (shots.rgb(*view) for view in shots.along(points, progress)), fps, overwrite=overwrite)
    note(f"wrote {output}: {count} pictures", quiet)


@dataclass(frozen=True)
class _Shots:
    """Pictures of a scene with the options of the command line."""

    scene: Scene
    resolution: tuple[int, int] | None
    background: tuple[float, ...] | None
    weights: str
    filter: str
    textures: int | None
    samples: int | None

    def along(
        self, points: NDArray[np.float64], progress: Progress | None
    ) -> Iterator[tuple[Camera, NDArray[np.float64]]]:
        """Cameras and view weights along a path."""
        from eigenfield.progress import track
        from eigenfield.rendering import viewpoint

        for x, y in track(points, "drawing", len(points), progress):
            yield viewpoint(self.scene, at=(float(x), float(y)), weights=self.weights)

    def picture(self, camera: Camera, mix: NDArray[np.float64], colour: NDArray[np.float32] | None = None) -> Picture:
        """One picture; black behind what is to be transparent. colour: of `Renderer.draw`."""
        from eigenfield.rendering import at_resolution, renderer_of

        view = camera if self.resolution is None else at_resolution(camera, self.resolution)
        renderer = renderer_of(self.scene)
        behind = self.background or (0.0,)
        if renderer.channels != len(behind):
            behind = (sum(behind) / len(behind),)  # one channel: a grey; other attributes: the same number everywhere
        return renderer.draw(
            view, mix, filter=self.filter, background=behind, textures=self.textures, samples=self.samples,
            colour=colour,
        )  # fmt: skip

    def rgb(self, camera: Camera, mix: NDArray[np.float64]) -> NDArray[np.uint8]:
        """(H, W, 3) uint8, greys repeated."""
        import numpy as np

        image = self.picture(camera, mix).to_uint8()
        _refuse_attributes(image.shape[2])
        return image if image.shape[2] == 3 else np.repeat(image, 3, axis=2)

    def png(self, camera: Camera, mix: NDArray[np.float64], colour: NDArray[np.float32] | None = None) -> bytes:
        """The picture as a .png, with alpha where it is to be transparent."""
        import numpy as np

        picture = self.picture(camera, mix, colour)
        _refuse_attributes(picture.image.shape[2])
        if self.background is not None:
            return _png(picture.to_uint8())
        part = picture.coverage[..., None]
        straight = np.divide(picture.image, part, out=np.zeros_like(picture.image), where=part > 0)
        values: NDArray[Any] = np.concatenate([straight, part], axis=2)
        return _png(np.clip(np.rint(values * np.float32(255)), 0, 255).astype(np.uint8))


def _numbered(output: Path) -> bool:
    return NUMBERED.search(output.name) is not None


def _png(picture: NDArray[np.uint8]) -> bytes:
    """(H, W, 1 to 4) uint8: grey, grey and alpha, RGB, RGBA."""
    import io

    from PIL import Image

    data = io.BytesIO()
    Image.fromarray(picture[..., 0] if picture.shape[2] == 1 else picture).save(data, "PNG")
    return data.getvalue()


def _refuse_attributes(channels: int) -> None:
    if channels not in (1, 3):
        raise OptionError(
            "not-a-picture",
            f"the scene has {channels} channels, which make no picture",
            remedy="draw it with eigenfield.render from Python, which returns arrays",
        )


def _check(
    output: Path,
    at: tuple[float, float] | None,
    camera: str | None,
    path: str | None,
    frames: int | None,
    background: tuple[float, ...] | None,
) -> None:
    """Refuse combinations that cannot be, before anything is read."""
    given = [name for name, value in (("--at", at), ("--camera", camera), ("--path", path)) if value is not None]
    kind = output.suffix.lower()
    if len(given) > 1:
        raise OptionError("viewpoint", f"{' and '.join(given)} exclude each other", remedy="give one of them")
    if kind not in (".png", ".mp4"):
        raise OptionError("output-kind", f"{output}: the output is a .png or an .mp4", remedy="name it so")
    if path is None and (kind == ".mp4" or _numbered(output)):
        raise OptionError("output-kind", f"{output}: one picture makes no film", remedy="give --path, or name a .png")
    if path is not None and kind == ".png" and not _numbered(output):
        raise OptionError(
            "output-kind",
            f"{output}: a path makes many pictures",
            remedy="name an .mp4, or a .png with %04d in its name",
        )
    if path is None and frames is not None:
        raise OptionError("frames", "--frames needs --path", remedy="give a path, or leave it out")
    if kind == ".mp4" and background is None:
        raise OptionError("background", "a film cannot be transparent", remedy="name a colour, or write .png pictures")
