"""Drawing of footage of the demo's scene: a folder a camera, a time for each picture, and a mesh a frame."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.writers.transforms import transforms_document
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.progress import Progress, track
from eigenfield.demo.cameras import array_cameras
from eigenfield.demo.capture import DEMO_SAMPLES_PER_SIDE, Look, draw_png
from eigenfield.demo.moving import MovingLook, at_time
from eigenfield.proxy import write_ply
from eigenfield.runtime.files import make_folder, write_bytes
from eigenfield.runtime.parallel import parallel_stream

CLIP_ROWS, CLIP_COLUMNS = 5, 5  # of the array
CLIP_SIZE, CLIP_FRAMES, CLIP_RATE = 320, 30, 30  # pixels a side, frames, frames a second
CLIP_SAMPLES_PER_SIDE = 2  # of a pixel
CLIP_TEXELS_PER_PIXEL = 3  # side of the atlas over side of the picture
CLIP_MESHES = "mesh_%04d.ply"
FOOTAGE_CALIBRATION = "transforms.json"


def is_drawn(folder: Path) -> bool:
    """Whether all of a folder's footage is there.

    Args:
        folder: Of the footage.
    """
    return (folder / FOOTAGE_CALIBRATION).exists()


def draw_demo_clip(
    folder: Path,
    *,
    rows: int = CLIP_ROWS,
    columns: int = CLIP_COLUMNS,
    size: int = CLIP_SIZE,
    frames: int = CLIP_FRAMES,
    progress: Progress | None = None,
) -> None:
    """Draw footage of the scene in motion, as `draw_footage`, and mesh_NNNN.ply: the exact surface of each frame.

    The meshes have the same faces and texture coordinates. After the last frame the motion goes on with the first. The
    same arguments give the same bytes, at any number of threads.

    Args:
        folder: Of the footage. What a run that was stopped has drawn in it is kept, and all of it once it is whole.
        rows: Of the array.
        columns: Of the array.
        size: Side of the pictures in pixels.
        frames: Of the whole turn.
        progress: Called for each frame.

    Raises:
        OutputError: `not-a-folder`, `disk-full` or `not-writable`.
        OptionError: `demo-size`.
    """
    if rows < 1 or columns < 1 or rows * columns < 3 or size < 16 or frames < 1:
        raise OptionError(
            "demo-size",
            f"{frames} frames of {rows}x{columns} views of {size} pixels were asked for",
            remedy="ask for 1 frame of 3 views or more, of 16 pixels",
        )
    if is_drawn(folder):
        return
    make_folder(folder)
    look = MovingLook(CLIP_TEXELS_PER_PIXEL * size)
    for frame in range(frames):
        mesh = at_time(look.scene, frame / frames).mesh
        write_ply(mesh, folder / (CLIP_MESHES % frame), overwrite=True)
    draw_footage(folder, array_cameras(rows, columns, size), columns, look, frames, CLIP_SAMPLES_PER_SIDE, progress)


def draw_footage(
    folder: Path,
    cameras: Sequence[Camera],
    columns: int,
    look_at: Callable[[float], Look],
    frames: int,
    samples: int = DEMO_SAMPLES_PER_SIDE,
    progress: Progress | None = None,
) -> None:
    """Draw cam_R_C/NNNNNN.png, those that are not there yet, and at last transforms.json, with a time for each.

    Args:
        folder: Of the footage; it is made where it is not there.
        cameras: Row by row.
        columns: Of the array.
        look_at: The look of a time from 0 to 1, which is the whole turn.
        frames: Of the whole turn.
        samples: Points on each side of a pixel.
        progress: Called for each frame.

    Raises:
        OutputError: `not-a-folder`, `disk-full` or `not-writable`.
    """
    names = [f"cam_{index // columns}_{index % columns}" for index in range(len(cameras))]
    for name in names:
        make_folder(folder / name)
    for frame in track(range(frames), "draw", frames, progress):
        wanted = [(folder / name / f"{frame:06d}.png", camera) for name, camera in zip(names, cameras, strict=True)]
        wanted = [(path, camera) for path, camera in wanted if not path.exists()]
        if wanted:
            draw = partial(draw_png, look=look_at(frame / frames), samples=samples)
            drawn = parallel_stream(draw, [camera for _, camera in wanted])
            for (path, _), data in zip(wanted, drawn, strict=True):
                write_bytes(path, data)
    write_timed(folder, names, cameras, frames)


def write_timed(folder: Path, names: Sequence[str], cameras: Sequence[Camera], frames: int) -> None:
    """Write transforms.json of footage whose frames lie in the cameras' folders as NNNNNN.png, each with its time.

    Args:
        folder: Of the footage.
        names: Of the cameras' folders.
        cameras: Likewise.
        frames: Of each.

    Raises:
        OutputError: `disk-full` or `not-writable`.
    """
    views = tuple(View(name, folder / name / "000000.png", camera) for name, camera in zip(names, cameras, strict=True))
    document = transforms_document(LightField(folder, views, (), "transforms"), folder, None)
    document["fps"] = CLIP_RATE
    document["frames"] = [
        {**entry, "file_path": entry["file_path"].replace("000000", f"{frame:06d}"), "time": frame / CLIP_RATE}
        for entry in document["frames"]
        for frame in range(frames)
    ]
    write_bytes(folder / FOOTAGE_CALIBRATION, json.dumps(document).encode(), overwrite=True)
