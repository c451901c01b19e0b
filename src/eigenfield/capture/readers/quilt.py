"""A quilt, as Looking Glass displays take it: a row of views as the tiles of one picture, told by its name.

`NAME_qs8x6a0.75.png` has 8 columns and 6 rows of tiles, whose views are shown 0.75 times as wide as high. The first
view, the leftmost, is the tile at the bottom left; tiles go to the right, then up
(https://docs.lookingglassfactory.com/keyconcepts/quilts). A tile need not have the shape of its view: then its shorter
side is stretched. In quilts whose sides are powers of two, as players of the first displays asked for, tiles have whole
pixels, and what is left over, at the right and at the top, is no part of any.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np

from eigenfield.capture.arrangement import Arrangement
from eigenfield.capture.photographs.read import read_header
from eigenfield.capture.readers.packed import Views, decode_picture, only_file, packed_file, unpack_views
from eigenfield.core.errors import CaptureError
from eigenfield.core.open_options import OpenOptions

QUILT_NAME = re.compile(r"_qs([1-9]\d?)x([1-9]\d?)(?:a(\d{1,3}(?:\.\d{1,9})?))?$", re.IGNORECASE)
QUILT_ASPECT_RANGE = (0.1, 10.0)  # of a view
QUILT_MAX_STRETCH = 4.0  # of a tile into its view
QUILT_MIN_VIEWS = 3  # that a scene can be made from


class QuiltShape(NamedTuple):
    """What a quilt's name says.

    Attributes:
        columns: Of tiles.
        rows: Of tiles.
        aspect: Width of a view by its height, as it is shown; None: as its tile.
    """

    columns: int
    rows: int
    aspect: float | None = None


def parse_quilt_name(path: Path) -> QuiltShape | None:
    """What the end of a name without its ending says; None where it is no quilt's."""
    said = QUILT_NAME.search(path.stem)
    return None if said is None else QuiltShape(int(said[1]), int(said[2]), float(said[3]) if said[3] else None)


def find_quilt(folder: Path) -> Path | None:
    """The quilt of a folder that holds no other photograph."""
    path = only_file(folder)
    return path if path is not None and parse_quilt_name(path) is not None else None


def read_quilt(found: Path, options: OpenOptions) -> Arrangement:
    """The views of a quilt as a row of photographs, by its name or as `options.quilt` says.

    Raises CaptureError: `names-unknown`, `quilt-missing`, `quilt-size`; as `photographs.read.decode`.
    """
    path = packed_file(found, only_file, "a quilt")
    shape = parse_quilt_name(path)
    if options.quilt is not None:
        shape = QuiltShape(*options.quilt, None if shape is None else shape.aspect)
    if shape is None:
        message = "its name does not say how many columns and rows of views the quilt has"
        raise CaptureError("quilt-missing", message, path=path, remedy="say --quilt COLUMNSxROWS, as 8x6")
    if shape.columns * shape.rows < QUILT_MIN_VIEWS:
        message = f"a quilt of {shape.columns}x{shape.rows} has too few views; {QUILT_MIN_VIEWS} are needed"
        raise CaptureError("quilt-size", message, path=path, remedy="say the right --quilt COLUMNSxROWS")
    columns, rows, aspect = shape
    header = read_header(path)
    height, width = _tile_size(header.upright_size, shape, path)
    shown = _shown_size(height, width, aspect, path)

    def read() -> Views:
        tiles = decode_picture(path)[-rows * height :, : columns * width].reshape(rows, height, columns, width, -1)
        return tiles.transpose(0, 2, 1, 3, 4)[::-1]

    def finish(view: Views) -> Views:
        if shown == (height, width):
            return view
        return cv2.resize(np.ascontiguousarray(view), shown[::-1], interpolation=cv2.INTER_LANCZOS4)

    bits = 16 if header.depth > 8 else 8
    return unpack_views("quilt", path, options, read, finish=finish, bits=bits, in_line=True, key=[*shape])


def _tile_size(size: tuple[int, int], shape: QuiltShape, path: Path) -> tuple[int, int]:
    """(height, width) of a tile of a quilt of (width, height), pixels."""
    width, height = size
    rest = height % shape.rows, width % shape.columns
    padded = all(side & (side - 1) == 0 for side in (height, width))
    if (any(rest) and not padded) or height < shape.rows or width < shape.columns:
        raise CaptureError(
            "quilt-size",
            f"is {width}x{height} pixels, which {shape.columns}x{shape.rows} views do not divide",
            path=path,
            remedy="say the right --quilt COLUMNSxROWS, or make the quilt anew",
        )
    return height // shape.rows, width // shape.columns


def _shown_size(height: int, width: int, aspect: float | None, path: Path) -> tuple[int, int]:
    """(height, width) of a view with square pixels: a tile's, or with its shorter side stretched."""
    if aspect is None or abs(height * aspect - width) <= 1:
        return height, width
    stretch = height * aspect / width
    if not (QUILT_ASPECT_RANGE[0] <= aspect <= QUILT_ASPECT_RANGE[1]) or max(stretch, 1 / stretch) > QUILT_MAX_STRETCH:
        raise CaptureError(
            "quilt-size",
            f"its tiles of {width}x{height} pixels are no views that are {aspect:g} times as wide as high",
            path=path,
            remedy="say the right --quilt COLUMNSxROWS, or correct the name",
        )
    return (height, round(height * aspect)) if stretch > 1 else (round(width / aspect), width)
