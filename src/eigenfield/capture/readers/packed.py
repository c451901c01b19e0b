"""All views of a light field in one file: unpacked once into PNG, and then photographs as any others."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.arrangement import Arrangement, make_grid_layout
from eigenfield.capture.layout import GridLayout
from eigenfield.capture.locate import IMAGES_FOLDER, files_named, photographs_in
from eigenfield.capture.messages import Note
from eigenfield.capture.photographs.read import decode
from eigenfield.capture.readers.video import frames_stage, video_identity
from eigenfield.core.errors import CaptureError
from eigenfield.core.open_options import OpenOptions
from eigenfield.runtime.parallel import parallel_map
from eigenfield.runtime.stages import stage_key

PACKED_MIN_BRIGHTNESS = 0.7  # of a view's mean to the middle view's: darker ones are at the rim of the lens
PACKED_BRIGHTNESS_STEP = 4  # pixels, of the sample whose mean is taken
PACKED_SHAPE_FILE = "shape"  # beside the views: rows and columns of the file
PNG_COMPRESSION = 3

Views = NDArray[Any]  # (rows, columns, H, W, C): uint8, uint16, or float of 0..1; C of 1, 3, or 4 with alpha


def only_file(folder: Path, endings: tuple[str, ...] | None = None) -> Path | None:
    """The one photograph of a folder; or the one file that ends so, where there are no photographs."""
    photographs = photographs_in(folder) or photographs_in(folder / IMAGES_FOLDER)
    found = photographs if endings is None else files_named(folder, endings)
    return found[0] if len(found) == 1 and (endings is None or not photographs) else None


def packed_file(found: Path, find: Callable[[Path], Path | None], what: str) -> Path:
    """The file that is named, or the one that `find` finds in a folder. CaptureError `names-unknown`."""
    path = find(found) if found.is_dir() else found
    if path is None:
        raise CaptureError("names-unknown", f"does not hold one file alone, {what}", path=found, remedy="name the file")
    return path


def unpack_views(
    name: str,
    path: Path,
    options: OpenOptions,
    read: Callable[[], Views],
    *,
    finish: Callable[[Views], Views] = lambda view: view,
    bits: int = 16,
    in_line: bool = False,
    key: Any = None,
) -> Arrangement:
    """The views of a file as PNG, in `options.work` (reused if they are there) or in a temporary folder.

    Of a grid the middle `options.grid` is taken; without it, the largest middle part none of whose views is much darker
    than the one in the middle, since a lens shades the views at its rim.

    Args:
        name: Of the format.
        read: All views; called once.
        finish: Makes a view of (H, W, C) what is written.
        bits: 8 or 16, of the PNG of values that are float.
        in_line: The cameras stand in one row, in the order of rows and columns, and all are taken.
        key: What else the views depend on.

    Raises:
        CaptureError: `grid-size`, and those of `read`.
    """

    def build(place: Path) -> None:
        views = read()
        rows, columns = views.shape[:2]
        (place / PACKED_SHAPE_FILE).write_text(f"{rows} {columns}")
        taken = (rows, columns) if in_line else _middle(views, options.grid, path)
        top, left = (rows - taken[0]) // 2, (columns - taken[1]) // 2

        def write(number: int) -> None:
            row, column = divmod(number, taken[1])
            file = f"view_{number:04d}.png" if in_line else f"view_{row:02d}_{column:02d}.png"
            _write_png(place / file, finish(views[top + row, left + column]), (1 << bits) - 1)

        parallel_map(write, range(taken[0] * taken[1]))

    inputs = [video_identity(path), options.grid, key]
    place = frames_stage(options.work).run(name, stage_key(inputs), build)
    files = tuple(sorted(place.glob("*.png")))
    rows, columns = map(int, (place / PACKED_SHAPE_FILE).read_text().split())
    if in_line:
        return Arrangement(name, files, _layout(files, [(0, number) for number in range(len(files))], path))
    nodes = [(int(row), int(column)) for _, row, column in (file.stem.split("_") for file in files)]
    used = nodes[-1][0] + 1, nodes[-1][1] + 1
    lines: tuple[str, ...] = ()
    if used != (rows, columns):
        why = "" if options.grid else ": those at the rim are dark; --grid RxC says how many"
        lines = (Note(f"of {rows}x{columns} views the middle {used[0]}x{used[1]} are used{why}"),)
    return Arrangement(name, files, _layout(files, nodes, path), lines)


def _layout(files: tuple[Path, ...], nodes: list[tuple[int, int]], path: Path) -> GridLayout:
    rows, columns = [row for row, _ in nodes], [column for _, column in nodes]
    layout, _ = make_grid_layout(files, rows, columns, OpenOptions(), path)
    return replace(layout, rectified=True)  # all these forms have their views share a plane


def _middle(views: Views, grid: tuple[int, int] | None, path: Path) -> tuple[int, int]:
    """How many rows and columns around the middle are taken."""
    rows, columns = views.shape[:2]
    if grid is not None:
        if grid[0] > rows or grid[1] > columns:
            raise CaptureError(
                "grid-size",
                f"holds {rows}x{columns} views, not {grid[0]}x{grid[1]}",
                path=path,
                remedy="say fewer with --grid, or leave it out",
            )
        return grid
    step = PACKED_BRIGHTNESS_STEP
    colours = views[..., :3]
    bright = np.array([[view[::step, ::step].mean(dtype=np.float64) for view in row] for row in colours])
    least = PACKED_MIN_BRIGHTNESS * bright[rows // 2, columns // 2]
    cuts = range((min(rows, columns) - 1) // 2)  # down to three or four rows or columns
    cut = next((cut for cut in cuts if bright[cut : rows - cut, cut : columns - cut].min() >= least), 0)
    return rows - 2 * cut, columns - 2 * cut


def decode_picture(path: Path) -> NDArray[np.float32]:
    """A picture that holds all views, (H, W, 3 or 4) of 0..1. Raises CaptureError as `photographs.read.decode`."""
    pixels, alpha = decode(path)
    return pixels if alpha is None else np.concatenate([pixels, alpha[..., None]], axis=2)


def _write_png(file: Path, view: Views, most: int) -> None:
    if view.dtype.kind == "f":
        view = np.rint(view.clip(0, 1) * most).astype(np.uint8 if most == 255 else np.uint16)
    turned = {3: [2, 1, 0], 4: [2, 1, 0, 3]}.get(view.shape[2])
    stored = view[..., 0] if turned is None else view[..., turned]
    ok, data = cv2.imencode(".png", np.ascontiguousarray(stored), [cv2.IMWRITE_PNG_COMPRESSION, PNG_COMPRESSION])
    assert ok
    file.write_bytes(data.tobytes())
