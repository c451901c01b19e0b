"""The focal length that a camera wrote into a photograph."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from PIL import AvifImagePlugin, JpegImagePlugin, TiffImagePlugin, WebPImagePlugin

from eigenfield.capture.photographs.read import DAMAGE, Header

READERS: dict[str, Any] = {
    "JPEG": JpegImagePlugin.JpegImageFile,
    "WebP": WebPImagePlugin.WebPImageFile,
    "TIFF": TiffImagePlugin.TiffImageFile,
    "AVIF": AvifImagePlugin.AvifImageFile,
}
PHOTO = 0x8769  # the IFD of the tags below
FOCAL, FOCAL_35MM, PLANE_X, PLANE_UNIT, PIXELS_X = 0x920A, 0xA405, 0xA20E, 0xA210, 0xA002
UNITS = {2: 25.4, 3: 10.0, 4: 1.0, 5: 0.001}  # mm
DIAGONAL = math.hypot(36, 24)  # of 35 mm film, which the equivalent focal length is defined by (CIPA DCG-001)
PLAUSIBLE = (0.2, 50.0)  # focal length over the longer side


def focal_of(path: Path, header: Header) -> float | None:
    """Focal length in pixels from EXIF: FocalLengthIn35mmFilm, else FocalLength with FocalPlaneXResolution.

    None where neither is there, or what is there cannot be. A crop is not known to EXIF, and makes it too short.
    """
    if header.format not in READERS:
        return None
    try:
        with path.open("rb") as file:
            tags = dict(READERS[header.format](file).getexif().get_ifd(PHOTO))
    except (*DAMAGE, ZeroDivisionError, OverflowError):
        return None
    equivalent, plane, millimetres = (_number(tags, tag) for tag in (FOCAL_35MM, PLANE_X, FOCAL))
    focal = None
    if equivalent:
        focal = equivalent / DIAGONAL * math.hypot(*header.stored)
    elif plane and millimetres:
        unit = UNITS.get(tags.get(PLANE_UNIT, 2), 25.4)
        # the resolution is that of the picture as taken: a smaller copy keeps the tag
        focal = millimetres * plane / unit * header.width / (_number(tags, PIXELS_X) or header.width)
    low, high = (bound * max(header.stored) for bound in PLAUSIBLE)
    return focal if focal is not None and low <= focal <= high else None


def _number(tags: dict[int, Any], tag: int) -> float | None:
    try:
        value = float(tags[tag])
    except (KeyError, TypeError, ValueError, ZeroDivisionError, OverflowError):
        return None
    return value if math.isfinite(value) and value > 0 else None
