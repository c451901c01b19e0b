"""The colour space of a photograph that has no ICC profile, or of which something else has precedence over it."""

from __future__ import annotations

import contextlib
import logging
from pathlib import Path

from PIL import Image, TiffImagePlugin

from eigenfield.capture.photographs.colour import (
    Profile,
    read_adobe_rgb,
    read_code_points,
)
from eigenfield.capture.photographs.header import DECODER_ERRORS, PHOTOGRAPH_HEAD_BYTES, one_line
from eigenfield.capture.photographs.png import read_png_colours
from eigenfield.capture.photographs.tiff import read_tiff_colours

EXIF_PHOTO_IFD, EXIF_INTEROP_IFD = 0x8769, 0xA005
EXIF_COLOUR_SPACE_TAG, EXIF_INTEROP_INDEX_TAG = 0xA001, 1
EXIF_ADOBE_RGB, EXIF_UNCALIBRATED = 2, 0xFFFF  # the former of cameras that do not follow DCF
EXIF_ADOBE_INDEX = "R03"  # DCF 2.0's optional colour space

log = logging.getLogger(__name__)


def read_stated_colours(
    kind: str, data: bytes, image: Image.Image, depth: int, path: Path
) -> tuple[Profile | None, bool]:
    """The profile that a file states, None where there is none or its ICC profile counts, and whether its values are of
    the narrow range.

    Args:
        depth: Bits a channel.
    """
    if image.mode in ("CMYK", "LAB"):
        return None, False
    try:
        if kind == "PNG":
            return read_png_colours(data, image.info)
        return (None if image.info.get("icc_profile") else _read_colours(kind, data, image, depth)), False
    except DECODER_ERRORS as error:
        log.warning("%s: the colour space that it states cannot be used (%s) and is ignored", path, one_line(error))
        return None, False


def _read_colours(kind: str, data: bytes, image: Image.Image, depth: int) -> Profile | None:
    if kind == "HEIC":
        found = image.info.get("nclx_profile") or {}
        return read_code_points(found.get("color_primaries", 2), found.get("transfer_characteristics", 2))
    if kind == "AVIF":
        at = data.find(b"colrnclx", 0, PHOTOGRAPH_HEAD_BYTES)
        points = data[at + 8 : at + 12] if at >= 0 else b""
        return read_code_points(int.from_bytes(points[:2]), int.from_bytes(points[2:]))
    if isinstance(image, TiffImagePlugin.TiffImageFile):
        profile = read_tiff_colours(image.tag_v2, depth)
        if profile is not None:
            return profile
    return read_adobe_rgb() if kind in ("JPEG", "TIFF", "WebP") and _says_adobe_rgb(image) else None


def _says_adobe_rgb(image: Image.Image) -> bool:
    with contextlib.suppress(*DECODER_ERRORS):  # of EXIF alone
        exif = image.getexif()
        space = exif.get_ifd(EXIF_PHOTO_IFD).get(EXIF_COLOUR_SPACE_TAG)
        index = exif.get_ifd(EXIF_INTEROP_IFD).get(EXIF_INTEROP_INDEX_TAG) if space == EXIF_UNCALIBRATED else None
        return space == EXIF_ADOBE_RGB or str(index).strip("\0 ") == EXIF_ADOBE_INDEX
    return False
