"""A lenslet picture of a plenoptic camera, resampled to squares (`*_eslf.png`, the Stanford Lytro archives).

Below each lens stands a block of 14 by 14 pixels, or 15 by 15: pixel (r, c) of a block is what view (r, c) sees there.
"""

from __future__ import annotations

from pathlib import Path

from eigenfield.capture.arrangement import Arrangement
from eigenfield.capture.photographs.read import read_header
from eigenfield.capture.readers.packed import Views, decode_picture, only_file, packed_file, unpack_views
from eigenfield.core.errors import CaptureError
from eigenfield.core.open_options import OpenOptions

ESLF_ENDING = "_eslf"
ESLF_BLOCKS = (14, 15)  # pixels; the first that divides both sides


def is_eslf(path: Path) -> bool:
    """Whether a file's name is that of a lenslet picture."""
    return path.stem.lower().endswith(ESLF_ENDING)


def find_eslf(folder: Path) -> Path | None:
    """The lenslet picture of a folder that holds no other photograph."""
    path = only_file(folder)
    return path if path is not None and is_eslf(path) else None


def read_eslf(found: Path, options: OpenOptions) -> Arrangement:
    """The middle views of a lenslet picture.

    Raises CaptureError: `names-unknown`, `eslf-size`, `grid-size`; as `photographs.read.decode`.
    """
    path = packed_file(found, only_file, "a lenslet picture")
    header = read_header(path)
    width, height = header.upright_size
    block = next((block for block in ESLF_BLOCKS if height % block == width % block == 0), None)
    if block is None:
        raise CaptureError(
            "eslf-size",
            f"is {width}x{height} pixels, which blocks of 14x14 or 15x15 do not divide",
            path=path,
            remedy="take the picture as it was published, neither cut nor resized",
        )

    def read() -> Views:
        blocks = decode_picture(path).reshape(height // block, block, width // block, block, -1)
        return blocks.transpose(1, 3, 0, 2, 4)

    return unpack_views("eslf", path, options, read, bits=16 if header.depth > 8 else 8)
