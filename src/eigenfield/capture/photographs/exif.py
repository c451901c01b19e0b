"""The focal length that a camera wrote into a photograph, and whose the photograph is."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from PIL import Image

from eigenfield.capture.photographs.header import DECODER_ERRORS, Header
from eigenfield.capture.photographs.jxl import read_jxl_header
from eigenfield.capture.photographs.read import open_picture
from eigenfield.core.errors import CaptureError

EXIF_FORMATS = ("JPEG", "WebP", "TIFF", "AVIF", "HEIC", "JPEG XL", "RAW")  # Pillow would decode a PNG to find it
EXIF_PHOTO_IFD = 0x8769  # the IFD of the tags below
EXIF_FOCAL_TAG = 0x920A  # FocalLength, millimetres
EXIF_FOCAL_35MM_TAG = 0xA405  # FocalLengthIn35mmFilm, millimetres
EXIF_PLANE_X_TAG = 0xA20E  # FocalPlaneXResolution, pixels a unit
EXIF_PLANE_UNIT_TAG = 0xA210  # FocalPlaneResolutionUnit
EXIF_PIXELS_X_TAG = 0xA002  # PixelXDimension
EXIF_ARTIST_TAG, EXIF_COPYRIGHT_TAG = 0x013B, 0x8298
EXIF_UNITS_MM = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}
EXIF_35MM_DIAGONAL_MM = math.hypot(36, 24)  # of 35 mm film, for the equivalent focal length (CIPA DCG-001)
EXIF_FOCAL_RANGE_SIDES = (0.2, 50.0)  # focal length over the longer side


def read_focal_length(path: Path, header: Header) -> float | None:
    """Focal length in pixels from EXIF: FocalLengthIn35mmFilm, else FocalLength with FocalPlaneXResolution.

    None where neither is there, or the value is impossible. EXIF does not state a crop, which makes it too short.
    """
    tags = _read_tags(path, header, lambda exif: exif.get_ifd(EXIF_PHOTO_IFD))
    equivalent, plane, millimetres = (
        _read_positive(tags, tag) for tag in (EXIF_FOCAL_35MM_TAG, EXIF_PLANE_X_TAG, EXIF_FOCAL_TAG)
    )
    focal = None
    if equivalent:
        focal = equivalent / EXIF_35MM_DIAGONAL_MM * math.hypot(*header.stored_size)
    elif plane and millimetres:
        unit = EXIF_UNITS_MM.get(tags.get(EXIF_PLANE_UNIT_TAG, 2), 25.4)
        # the resolution is that of the picture as taken: a smaller copy keeps the tag
        focal = millimetres * plane / unit * header.width / (_read_positive(tags, EXIF_PIXELS_X_TAG) or header.width)
    low, high = (bound * max(header.stored_size) for bound in EXIF_FOCAL_RANGE_SIDES)
    return focal if focal is not None and low <= focal <= high else None


def read_credit(path: Path, header: Header) -> tuple[str | None, str | None]:
    """Artist and Copyright of EXIF, each None where it is not stated."""
    tags = _read_tags(path, header, lambda exif: exif)
    artist, notice = (tags.get(tag) for tag in (EXIF_ARTIST_TAG, EXIF_COPYRIGHT_TAG))
    return _read_text(artist), _read_text(notice)


def _read_text(value: object) -> str | None:
    return value.strip("\0 ") or None if isinstance(value, str) else None


def _read_tags(path: Path, header: Header, part: Callable[[Image.Exif], Mapping[int, Any]]) -> dict[int, Any]:
    """The tags of a part of EXIF; none where it cannot be read."""
    if header.format not in EXIF_FORMATS:
        return {}
    try:
        with path.open("rb") as file:
            return dict(part(_read_exif(file, path, header.format)))
    except (*DECODER_ERRORS, CaptureError, ZeroDivisionError, OverflowError):
        return {}


def _read_exif(file: Any, path: Path, kind: str) -> Image.Exif:
    if kind == "JPEG XL":
        return read_jxl_header(file).exif
    if kind == "RAW":  # most are TIFF
        exif = Image.Exif()
        exif.load_from_fp(file)
        return exif
    return open_picture(file, path)[1].getexif()


def _read_positive(tags: dict[int, Any], tag: int) -> float | None:
    try:
        value = float(tags[tag])
    except (KeyError, TypeError, ValueError, ZeroDivisionError, OverflowError):
        return None
    return value if math.isfinite(value) and value > 0 else None
