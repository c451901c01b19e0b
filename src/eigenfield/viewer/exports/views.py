"""A grid of drawn views as the HCI 4D benchmark has them, for methods that take light fields from others."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, track
from eigenfield.core.scene import Scene
from eigenfield.rendering import RenderJob, view_weights
from eigenfield.rendering.parallel_cameras import ParallelCameras, inverse_depths, parallel_cameras
from eigenfield.viewer.exports.folder import atomic_folder, write_file, write_listing

VIEWS_SIDE = 9  # rows and columns by default, HCI's own
VIEWS_MAX_SIDE = 99
VIEWS_SENSOR_MM = 35.0  # which parameters.cfg states; only its ratio to the focal length counts


def write_views(
    job: RenderJob,
    folder: Path,
    *,
    grid: tuple[int, int] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> tuple[int, int]:
    """Write `input_Cam000.png` and so on, row by row from the top left, and `parameters.cfg`; returns rows and columns.

    The views stand at even steps, the same along rows and columns, in the middle of the array and as far apart as fits.
    All look one way, and the plane at the median depth of what the middle sees has no parallax. A step moves a point
    at depth Z by b f (1/Z - 1/F) pixels to the left, with the baseline b, the focal length f in pixels and the depth F
    of that plane. Lengths are metres where the scene knows its scale, else the capture's own.

    Args:
        grid: (rows, columns). Default: 9 x 9, or 9 in a line where the cameras stand in one.

    Raises:
        OptionError: `views-grid`: no such grid fits into the array; `array-side`; as `Renderer.draw`.
        OutputError: The folder cannot be written.
    """
    scene, plane = job.scene, job.scene.rig.view_plane
    rows, columns = _shape(scene, grid)
    reference = scene.rig.cameras[scene.rig.reference]
    cameras = parallel_cameras(scene, job.resolution or (reference.width, reference.height), square=True)
    steps = [2 * extent / (count - 1) for extent, count in zip(plane.extent, (columns, rows), strict=True) if count > 1]
    step = float(min(steps))
    views = []
    for number in range(rows * columns):
        row, column = divmod(number, columns)
        x, y = (column - (columns - 1) / 2) * step, ((rows - 1) / 2 - row) * step
        camera = cameras.at(cameras.base.centre + x * cameras.R[0] - y * cameras.R[1])
        at = x / float(plane.extent[0]), y / float(plane.extent[1]) if y else 0.0
        views.append((camera, view_weights(scene, at, job.weights)))
    plain = replace(job, resolution=None)
    drawn = plain.each(lambda view: plain.png(*view), views)
    files = [f"input_Cam{number:03d}.png" for number in range(len(views))]
    with atomic_folder(folder, overwrite) as part:
        for file, data in zip(files, track(drawn, "views", len(files), progress), strict=True):
            write_file(part / file, data)
        write_file(part / "parameters.cfg", _parameters(scene, cameras, (rows, columns), step).encode())
        write_listing(part, "views", {"rows": rows, "columns": columns}, scene.rights)
    return rows, columns


def _shape(scene: Scene, grid: tuple[int, int] | None) -> tuple[int, int]:
    """Rows and columns that fit into the array."""
    is_line = scene.rig.view_plane.is_line
    rows, columns = grid or (1 if is_line else VIEWS_SIDE, VIEWS_SIDE)
    if not (1 <= rows <= VIEWS_MAX_SIDE and 1 <= columns <= VIEWS_MAX_SIDE) or rows * columns < 2:
        message, remedy = f"a grid of {rows}x{columns} views", f"ask for 1x2 to {VIEWS_MAX_SIDE}x{VIEWS_MAX_SIDE}"
        raise OptionError("views-grid", message, remedy=remedy)
    if not scene.rig.view_plane.extent[0] > 0:
        raise OptionError("views-grid", "the cameras stand in one place", remedy="a grid needs an array of them")
    if is_line and rows > 1:
        remedy = f"ask for one row, as --grid 1x{rows * columns}"
        raise OptionError("views-grid", "the cameras stand in one line", remedy=remedy)
    return rows, columns


def _parameters(scene: Scene, cameras: ParallelCameras, grid: tuple[int, int], step: float) -> str:
    """The contents of HCI's parameters.cfg."""
    base, metres = cameras.base, scene.provenance.metres_per_unit or 1.0
    focal = float(base.K[0, 0])
    near = inverse_depths(scene, cameras.at(base.centre))
    low, high = (step * focal * (float(inverse) - 1 / cameras.depth) for inverse in (near.min(), near.max()))
    values = {
        "intrinsics": {
            "image_resolution_x_px": base.width,
            "image_resolution_y_px": base.height,
            "focal_length_mm": focal / max(base.width, base.height) * VIEWS_SENSOR_MM,
            "sensor_size_mm": VIEWS_SENSOR_MM,
        },
        "extrinsics": {
            "num_cams_x": grid[1],
            "num_cams_y": grid[0],
            "baseline_mm": step * metres * 1000,
            "focus_distance_m": cameras.depth * metres,
        },
        "meta": {"disp_min": math.floor(low * 10) / 10, "disp_max": math.ceil(high * 10) / 10},
    }
    return "".join(
        f"[{section}]\n" + "".join(f"{key} = {value:.12g}\n" for key, value in entries.items()) + "\n"
        for section, entries in values.items()
    )
