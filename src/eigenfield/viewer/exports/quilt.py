"""A quilt for Looking Glass displays: the views from left to right as the tiles of one picture.

The first view, the leftmost, is the tile at the bottom left; tiles go to the right, then up. The file's name tells a
player how to cut it: `_qs8x6a0.75` is 8 columns of 6 rows whose views are shown 0.75 as wide as high.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.readers.quilt import parse_quilt_name
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.rendering import RenderJob, ViewWeights, view_weights
from eigenfield.rendering.parallel_cameras import ParallelCameras, parallel_cameras
from eigenfield.rendering.render_jobs import png
from eigenfield.runtime.files import refuse_existing, write_bytes

QUILT_COLUMNS, QUILT_ROWS = 8, 6
QUILT_SIDE_PX = 4096  # that every player takes: by default views are made smaller than the cameras' to fit
QUILT_MAX_SIDE_PX = 16384
QUILT_MAX_TILES = 64  # in a row, and in a column


@dataclass(frozen=True)
class Quilt:
    """The shape of a quilt.

    Attributes:
        width: Of a tile, in pixels.
        spread: Part of the array's width that the views cover, 0..1.
        display: Width of the display by its height, which its views have; None: that of a tile.
    """

    columns: int
    rows: int
    width: int
    height: int
    spread: float = 1.0
    display: float | None = None

    @property
    def aspect(self) -> float:
        """Width of a view by its height, as it is shown."""
        return self.width / self.height if self.display is None else self.display

    @property
    def suffix(self) -> str:
        """What a file's name ends in."""
        return f"_qs{self.columns}x{self.rows}a{self.aspect:.4g}"


# Columns, rows, tile and display as Looking Glass' own toolkit has them (github.com/Looking-Glass/LKG-Toolkit,
# HardCodedLKGDeviceTemplates.cs); tiles have whole pixels
QUILT_DEVICES = {
    "go": Quilt(11, 6, 372, 682, display=9 / 16),
    "portrait": Quilt(8, 6, 420, 560, display=3 / 4),
    "16": Quilt(7, 7, 857, 857, display=16 / 9),
    "16-portrait": Quilt(11, 6, 545, 1000, display=9 / 16),
    "32": Quilt(7, 7, 1170, 1170, display=16 / 9),
    "32-portrait": Quilt(11, 6, 744, 1364, display=9 / 16),
    "65": Quilt(8, 9, 1024, 910, display=16 / 9),
}


def quilt_of(
    scene: Scene,
    grid: tuple[int, int] | str | None = None,
    resolution: tuple[int, int] | None = None,
    spread: float = 1.0,
) -> Quilt:
    """The shape of a scene's quilt.

    Args:
        grid: (columns, rows), or the name of a display, one of `QUILT_DEVICES`. Default: 8 x 6.
        resolution: (width, height) of a tile. Default: the display's, or the reference camera's shape, no larger than
            it is, so that the quilt has at most 4096 pixels a side.
        spread: Part of the array's width, 0..1.

    Raises:
        OptionError: `quilt`, `spread`.
    """
    device = None
    if isinstance(grid, str):
        device = QUILT_DEVICES.get(grid)
        if device is None:
            remedy = f"say COLUMNSxROWS, or one of {', '.join(QUILT_DEVICES)}"
            raise OptionError("quilt", f"no display is called {grid}", remedy=remedy)
        grid, resolution = (device.columns, device.rows), resolution or (device.width, device.height)
    columns, rows = grid or (QUILT_COLUMNS, QUILT_ROWS)
    if not (1 <= columns <= QUILT_MAX_TILES and 1 <= rows <= QUILT_MAX_TILES):
        raise OptionError(
            "quilt", f"a quilt of {columns}x{rows}", remedy=f"ask for 1x1 to {QUILT_MAX_TILES}x{QUILT_MAX_TILES}"
        )
    if not 0 <= spread <= 1:
        raise OptionError("spread", f"a spread of {spread:g}", remedy="give 0 (one place) to 1 (the array's width)")
    camera = scene.rig.cameras[scene.rig.reference]
    scale = min(1.0, QUILT_SIDE_PX / (columns * camera.width), QUILT_SIDE_PX / (rows * camera.height))
    width, height = resolution or (max(1, int(camera.width * scale)), max(1, int(camera.height * scale)))
    if width < 1 or height < 1 or columns * width > QUILT_MAX_SIDE_PX or rows * height > QUILT_MAX_SIDE_PX:
        raise OptionError(
            "quilt",
            f"{columns}x{rows} views of {width}x{height}",
            remedy=f"keep the quilt within {QUILT_MAX_SIDE_PX}x{QUILT_MAX_SIDE_PX} pixels",
        )
    return Quilt(columns, rows, width, height, spread, None if device is None else device.display)


def quilt_file(output: Path, quilt: Quilt) -> Path:
    """A file's path with the quilt's suffix.

    Raises:
        OptionError: `quilt-name`: the name has a suffix of another shape.
    """
    said = parse_quilt_name(output)
    if said is None:
        return output.with_name(f"{output.stem}{quilt.suffix}{output.suffix}")
    off = 1 if said.aspect is None else abs(said.aspect / quilt.aspect - 1)
    if (said.columns, said.rows) != (quilt.columns, quilt.rows) or off > 0.01:
        raise OptionError(
            "quilt-name",
            f"{output.name} is not what is made: {quilt.suffix}",
            remedy="leave the suffix out, or give the --quilt and --resolution that it says",
        )
    return output


def write_quilt(
    job: RenderJob, quilt: Quilt, output: Path, *, overwrite: bool = False, progress: Progress | None = None
) -> Path:
    """Draw and write a quilt; returns the file's path, which has the suffix.

    Raises:
        OptionError: `array-side`, `quilt-name`; as `Renderer.draw`.
        OutputError: The file cannot be written.
    """
    path = quilt_file(output, quilt)
    refuse_existing(path, overwrite)
    whole = draw_quilt(job, quilt, quilt_views(job, quilt), progress)
    write_bytes(path, png(whole), overwrite=overwrite)
    return path


def draw_quilt(
    job: RenderJob, quilt: Quilt, views: list[tuple[Camera, ViewWeights]], progress: Progress | None = None
) -> NDArray[np.uint8]:
    """(H, W, 1 to 4) uint8: the tiles of a quilt's views, in their places. OptionError as `Renderer.draw`."""
    plain = replace(job, resolution=None)
    drawn = plain.each(lambda view: plain.pixels(*view), views)
    whole: NDArray[np.uint8] | None = None
    for number, tile in enumerate(track(drawn, "views", len(views), progress)):
        if whole is None:
            whole = np.zeros((quilt.rows * quilt.height, quilt.columns * quilt.width, tile.shape[2]), np.uint8)
        row, column = divmod(number, quilt.columns)
        top, left = (quilt.rows - 1 - row) * quilt.height, column * quilt.width
        whole[top : top + quilt.height, left : left + quilt.width] = tile
    assert whole is not None
    return whole


def quilt_views(
    job: RenderJob, quilt: Quilt, at: tuple[float, float] = (0.0, 0.0), cameras: ParallelCameras | None = None
) -> list[tuple[Camera, ViewWeights]]:
    """The quilt's cameras and their view weights, from left to right along the array.

    What the array's middle sees in the middle of the picture, at its median depth, is shown in the plane of the
    display.

    Args:
        at: The viewpoint around which they stand. As much of its X counts as `spread` leaves.
        cameras: Those of another picture of the same film; None: the scene's own.

    Raises:
        OptionError: `array-side`: the cameras do not stand side by side, or see nothing.
    """
    plane = job.scene.rig.view_plane
    cameras = quilt_cameras(job.scene, quilt) if cameras is None else cameras
    count = quilt.columns * quilt.rows
    side = quilt.spread if count > 1 else 0.0
    places = at[0] * (1 - side) + np.linspace(-side, side, count)
    views = []
    for x in places.tolist():
        camera = cameras.at(plane.point(x, at[1]))
        scale = np.diag([quilt.width / camera.width, quilt.height / camera.height, 1.0])
        squeezed = replace(camera, K=scale @ camera.K, width=quilt.width, height=quilt.height)
        views.append((squeezed, view_weights(job.scene, (x, at[1]), job.weights)))
    return views


def quilt_cameras(scene: Scene, quilt: Quilt) -> ParallelCameras:
    """Cameras with square pixels, of the shape that the display shows."""
    return parallel_cameras(scene, (max(1, round(quilt.height * quilt.aspect)), quilt.height))
