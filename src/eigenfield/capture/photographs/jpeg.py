"""JPEG (ISO/IEC 10918-1), decoded by libjpeg-turbo with its warnings, which Pillow does not pass on.

A file that draws a warning of damage is refused. One that draws another is left to Pillow, which finds what is cut
short.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import simplejpeg
from numpy.typing import NDArray

from eigenfield.capture.photographs.header import unreadable_error

JPEG_SPACES = {"L": "GRAY", "RGB": "RGB", "CMYK": "CMYK"}  # of Pillow's modes
# what libjpeg says of damage, which Pillow does not see once it has all rows
JPEG_DAMAGE = (
    "Corrupt JPEG data", "Inconsistent progression sequence", "Unsupported marker type", "Unsupported JPEG process",
    "Bogus",
)  # fmt: skip
JPEG_EXTRANEOUS = re.compile(r"Corrupt JPEG data: (\d+) extraneous bytes before marker 0x([0-9a-f]{2})")
JPEG_MAX_PADDING = 64  # bytes of one value before a marker, as some encoders leave to end on a multiple
JPEG_MARKER = re.compile(rb"\xff+([^\0\xff])")
JPEG_RESTARTS, JPEG_END, JPEG_SCAN = range(0xD0, 0xD8), 0xD9, 0xDA


def decode_jpeg(data: bytes, mode: str, size: tuple[int, int], path: Path) -> NDArray[np.uint8] | None:
    """(H, W, 1 or 3) values; None where Pillow has to decide, and for CMYK, whose inks it turns.

    Args:
        data: A whole file, or its first picture with anything behind.
        mode: Pillow's.
        size: Width and height, pixels.
        path: For messages.

    Raises:
        CaptureError: `image-unreadable`.
    """
    try:
        found: NDArray[np.uint8] = simplejpeg.decode_jpeg(data, colorspace=JPEG_SPACES[mode], strict=True)
    except (KeyError, ValueError) as error:
        said = str(error)
        if said.startswith(JPEG_DAMAGE) and not _says_padding(said, data):
            raise unreadable_error(path, said) from error
        return None
    return found if found.shape[1::-1] == size and mode != "CMYK" else None


def _says_padding(said: str, data: bytes) -> bool:
    """Whether a warning is of bytes between segments, or of a short padding behind a scan: no pixel depends on them."""
    match = JPEG_EXTRANEOUS.fullmatch(said)
    if match is None:
        return False
    count, code = int(match[1]), int(match[2], 16)
    return any(
        len(set(gap[-count:])) == 1 and count <= JPEG_MAX_PADDING if in_scan else len(gap) == count
        for gap, in_scan in _gaps(data, code)
    )


def _gaps(data: bytes, code: int) -> Iterator[tuple[bytes, bool]]:
    """What lies before each marker of a code, from the end of the segment before, and whether that is of a scan."""
    at, in_scan = 2, False
    while marker := JPEG_MARKER.search(data, at):
        found = marker[1][0]
        if found == code:
            yield data[at : marker.start()], in_scan
        if found == JPEG_END:
            return
        at, in_scan = marker.end(), in_scan or found == JPEG_SCAN
        if found not in JPEG_RESTARTS:
            at += max(2, int.from_bytes(data[at : at + 2]))
