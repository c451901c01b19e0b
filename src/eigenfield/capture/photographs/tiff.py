"""TIFF (revision 6.0): tags of colour, kinds that are not read, and JPEG within."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from PIL import TiffImagePlugin

from eigenfield.capture.photographs.colour import (
    COLOUR_CURVE_STEPS,
    COLOUR_PRIMARIES,
    Profile,
    make_profile,
    srgb_curve,
)
from eigenfield.capture.photographs.jpeg import decode_jpeg
from eigenfield.core.errors import CaptureError

TIFF_DEPTH_TAG, TIFF_COMPRESSION_TAG, TIFF_PHOTOMETRIC_TAG, TIFF_PLANES_TAG = 258, 259, 262, 284
TIFF_EXTRA_TAG, TIFF_FORM_TAG, TIFF_JPEG_TABLES_TAG = 338, 339, 347
TIFF_TRANSFER_TAG, TIFF_WHITE_TAG, TIFF_PRIMARIES_TAG = 301, 318, 319
TIFF_PIECES_TAGS = ((273, 279), (324, 325))  # offsets and sizes, of strips and of tiles
TIFF_JPEG = 7  # as compression
TIFF_FORMS = {2: "signed numbers", 3: "floating point numbers", 5: "complex numbers", 6: "complex numbers"}
TIFF_DEPTHS = (1, 2, 4, 8, 16)


def read_tiff_tags(file: Any) -> Any:
    """The tags of a file that Pillow does not open. Raises what its decoders raise."""
    file.seek(0)
    tags = TiffImagePlugin.ImageFileDirectory_v2(file.read(8))
    file.seek(tags.next)
    tags.load(file)
    return tags


def refuse_tiff_kind(tags: Any, path: Path) -> None:
    """Raise CaptureError `image-kind` for a TIFF whose kind of numbers is not read."""
    depth, form = (max(np.atleast_1d(tags.get(tag, 1)).tolist()) for tag in (TIFF_DEPTH_TAG, TIFF_FORM_TAG))
    if form in TIFF_FORMS:
        what = f"is a TIFF of {TIFF_FORMS[form]}"
        remedy = "save it as OpenEXR or 16 bit"
    elif depth not in TIFF_DEPTHS:
        what, remedy = f"is a TIFF of {depth} bit a sample", "save it as 8 bit, or as 16 bit with white at 65535"
    else:
        return
    raise CaptureError("image-kind", f"{what}, which is not read", path=path, remedy=remedy)


def refuse_tiff_damage(data: bytes, tags: Any, mode: str, path: Path) -> None:
    """Raise CaptureError `image-unreadable` where a JPEG within is damaged, which libtiff does not pass on."""
    if tags.get(TIFF_COMPRESSION_TAG) != TIFF_JPEG:
        return
    tables = bytes(tags.get(TIFF_JPEG_TABLES_TAG, b""))
    for offsets, sizes in TIFF_PIECES_TAGS:
        for offset, size in zip(np.atleast_1d(tags.get(offsets, ())), np.atleast_1d(tags.get(sizes, ())), strict=False):
            piece = data[int(offset) : int(offset) + int(size)]
            decode_jpeg(tables[:-2] + piece[2:] if tables else piece, mode, (0, 0), path)


def read_tiff_colours(tags: Any, depth: int) -> Profile | None:
    """The profile that PrimaryChromaticities, WhitePoint and TransferFunction state; None where they are not there.

    Raises ValueError where they state no colours that there are.
    """
    corners, white, transfer = (tags.get(tag) for tag in (TIFF_PRIMARIES_TAG, TIFF_WHITE_TAG, TIFF_TRANSFER_TAG))
    if corners is None and transfer is None:
        return None
    primaries = np.array(COLOUR_PRIMARIES[1])
    if corners is not None:
        primaries[:3] = np.reshape(np.array(corners, np.float64), (3, 2))
    if white is not None:
        primaries[3] = np.array(white, np.float64)
    curves = srgb_curve()
    if transfer is not None:
        given = np.reshape(np.array(transfer, np.float64), (-1, 1 << depth))
        steps, places = np.linspace(0, 1, COLOUR_CURVE_STEPS + 1), np.linspace(0, 1, 1 << depth)
        curves = np.stack([np.interp(steps, places, row / 65535) for row in given])
        if len(curves) not in (1, 3):
            raise ValueError("a transfer function of no three channels")
    return make_profile(primaries.tolist(), curves)
