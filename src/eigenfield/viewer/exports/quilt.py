"""A quilt for Looking Glass displays: the views from left to right as the tiles of one picture.

The first view, the leftmost, is the tile at the bottom left; tiles go to the right, then up. The file's name tells a
player how to cut it: `_qs8x6a0.75` is 8 columns of 6 rows whose views are shown 0.75 as wide as high.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, track
from eigenfield.core.proxy import opaque_mesh
from eigenfield.core.scene import Scene
from eigenfield.imaging.raster import rasterise_view
from eigenfield.rendering import RenderJob, ViewWeights, at_resolution, novel_camera, view_weights
from eigenfield.rendering.render_jobs import png
from eigenfield.runtime.files import write_bytes

QUILT_COLUMNS, QUILT_ROWS = 8, 6
QUILT_SIDE_PX = 4096  # that every player takes: by default views are made smaller than the cameras' to fit
QUILT_MAX_SIDE_PX = 16384
QUILT_MAX_TILES = 64  # in a row, and in a column
QUILT_MIN_COSINE = 0.7  # between the array's X and the cameras' own x axis
QUILT_SUFFIX = re.compile(r"_qs([1-9]\d?)x([1-9]\d?)a(\d+(?:\.\d+)?)$")


@dataclass(frozen=True)
class Quilt:
    """The shape of a quilt.

    Attributes:
        width: Of a view, in pixels.
        spread: Part of the array's width that the views cover, 0..1.
    """

    columns: int
    rows: int
    width: int
    height: int
    spread: float = 1.0

    @property
    def suffix(self) -> str:
        """What a file's name ends in."""
        return f"_qs{self.columns}x{self.rows}a{self.width / self.height:.4g}"


def quilt_of(
    scene: Scene, grid: tuple[int, int] | None = None, resolution: tuple[int, int] | None = None, spread: float = 1.0
) -> Quilt:
    """The shape of a scene's quilt.

    Args:
        grid: (columns, rows). Default: 8 x 6.
        resolution: (width, height) of a view. Default: the reference camera's shape, no larger than it is, so that the
            quilt has at most 4096 pixels a side.
        spread: Part of the array's width, 0..1.

    Raises:
        OptionError: `quilt`, `spread`.
    """
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
    return Quilt(columns, rows, width, height, spread)


def quilt_file(output: Path, quilt: Quilt) -> Path:
    """A file's path with the quilt's suffix.

    Raises:
        OptionError: `quilt-name`: the name has a suffix of another shape.
    """
    said = QUILT_SUFFIX.search(output.stem)
    if said is None:
        return output.with_name(f"{output.stem}{quilt.suffix}{output.suffix}")
    aspect = quilt.width / quilt.height
    if (int(said[1]), int(said[2])) != (quilt.columns, quilt.rows) or abs(float(said[3]) - aspect) > 0.01 * aspect:
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
        OptionError: `quilt-array`, `quilt-name`; as `Renderer.draw`.
        OutputError: The file cannot be written.
    """
    path = quilt_file(output, quilt)
    views = quilt_views(job, quilt)
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
    write_bytes(path, png(whole), overwrite=overwrite)
    return path


def quilt_views(job: RenderJob, quilt: Quilt) -> list[tuple[Camera, ViewWeights]]:
    """The quilt's cameras and their view weights, from left to right along the middle of the array.

    All look the same way, with their x axis along the array's X. Principal points are shifted so that the point in the
    middle of the picture, at the median depth of what the array's middle sees, stays in the middle: it is shown in the
    plane of the display.

    Raises:
        OptionError: `quilt-array`: the cameras do not stand side by side, or see nothing.
    """
    scene, plane = job.scene, job.scene.rig.view_plane
    base = at_resolution(novel_camera(scene, (0.0, 0.0)), (quilt.width, quilt.height))
    right = plane.right
    if base.R[0] @ right < QUILT_MIN_COSINE:
        raise OptionError(
            "quilt-array",
            "the cameras do not stand side by side before the scene",
            remedy="a quilt needs an array that looks one way",
        )
    forward = base.R[2] - (base.R[2] @ right) * right
    forward = forward / np.linalg.norm(forward)
    R = np.stack([right, np.cross(forward, right), forward])
    middle = base.R.T @ np.linalg.inv(base.K) @ (quilt.width / 2, quilt.height / 2, 1.0)
    towards = R @ middle
    depth = _median_depth(scene, _camera_towards(base, R, base.centre, middle))
    focus = base.centre + middle * (depth / towards[2])
    places = np.linspace(-quilt.spread, quilt.spread, quilt.columns * quilt.rows)
    return [
        (
            _camera_towards(base, R, plane.point(x, 0.0), focus - plane.point(x, 0.0)),
            view_weights(scene, (float(x), 0.0), job.weights),
        )
        for x in places.tolist()
    ]


def _camera_towards(
    base: Camera, R: NDArray[np.float64], centre: NDArray[np.float64], direction: NDArray[np.float64]
) -> Camera:
    """A camera at `centre` with axes R and the focal lengths of `base`, which sees `direction` in its middle."""
    x, y, z = R @ direction
    fx, fy = base.K[0, 0], base.K[1, 1]
    K = np.array([[fx, 0, base.width / 2 - fx * x / z], [0, fy, base.height / 2 - fy * y / z], [0, 0, 1]])
    return Camera(K, R, -R @ centre, base.width, base.height)


def _median_depth(scene: Scene, camera: Camera) -> float:
    """Of what the camera sees, along its z. Raises OptionError `quilt-array` where it sees nothing."""
    near = rasterise_view(opaque_mesh(scene.proxy), camera).inverse_depth
    if not near.any():
        raise OptionError(
            "quilt-array", "the array's middle sees nothing of the scene", remedy="a quilt needs a surface before it"
        )
    return float(1 / np.median(near[near > 0]))
