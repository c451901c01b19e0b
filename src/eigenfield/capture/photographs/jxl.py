"""The header of JPEG XL, whose plug-in decodes a picture to learn its size (ISO/IEC 18181-1, D.2 and D.3; -2, 3)."""

from __future__ import annotations

import contextlib
import struct
from dataclasses import dataclass
from typing import Any

from PIL import Image

from eigenfield.capture.photographs.header import DECODER_ERRORS, EXIF_ORIENTATION_TAG, read_at

JXL_CODESTREAM = b"\xff\x0a"
JXL_CONTAINER = b"\0\0\0\x0cJXL \r\n\x87\n"
JXL_RATIOS = ((1, 1), (12, 10), (4, 3), (3, 2), (16, 9), (5, 4), (2, 1))  # width over height
JXL_SIDE_BITS = (9, 13, 18, 30)
JXL_HEAD_BYTES = 32  # of the codestream, which hold all that is read
JXL_MAX_BOXES = 1000
JXL_MAX_EXIF_BYTES = 1 << 20


@dataclass(frozen=True)
class JxlHeader:
    """What the first bytes of a JPEG XL file say.

    Attributes:
        width: As stored, pixels.
        orientation: As in EXIF, which does not count here.
        jpeg: Whether it holds a whole JPEG file, which the plug-in decodes without turning it.
    """

    width: int
    height: int
    orientation: int
    jpeg: bool
    exif: Image.Exif


def read_jxl_header(file: Any) -> JxlHeader:
    """The header of an open file. Raises ValueError where it is damaged."""
    exif = Image.Exif()
    if read_at(file, 0, 2) == JXL_CODESTREAM:
        return JxlHeader(*_read_codestream(read_at(file, 0, JXL_HEAD_BYTES)), False, exif)
    at, jpeg, found = 0, False, None
    for _ in range(JXL_MAX_BOXES):
        head = read_at(file, at, 16)
        if len(head) < 8:
            break
        size, kind = struct.unpack(">I4s", head[:8])
        inner = 8
        if size == 1 and len(head) == 16:
            size, inner = struct.unpack(">Q", head[8:])[0], 16
        if kind in (b"jxlc", b"jxlp") and found is None:
            found = read_at(file, at + inner + (4 if kind == b"jxlp" else 0), JXL_HEAD_BYTES)
        elif kind == b"Exif" and inner + 4 < size < JXL_MAX_EXIF_BYTES:
            exif = _read_exif(read_at(file, at + inner, size - inner))
        jpeg = jpeg or kind == b"jbrd"
        if size < inner:  # 0: to the end of the file
            break
        at += size
    if found is None:
        raise ValueError("no codestream")
    width, height, orientation = _read_codestream(found)
    if jpeg and EXIF_ORIENTATION_TAG in exif:
        orientation = exif[EXIF_ORIENTATION_TAG]
    return JxlHeader(width, height, orientation, jpeg, exif)


def _read_exif(data: bytes) -> Image.Exif:
    """The content of an Exif box: four bytes, which some writers leave out, before the TIFF header."""
    exif = Image.Exif()
    with contextlib.suppress(*DECODER_ERRORS):
        exif.load(b"Exif\0\0" + data[4 if data[4:8] in (b"II*\0", b"MM\0*") else 0 :])
    return exif


class _Bits:
    """Numbers of a few bits each, the lowest bit of a byte first."""

    def __init__(self, data: bytes) -> None:
        self.value, self.left = int.from_bytes(data, "little"), 8 * len(data)

    def take(self, count: int) -> int:
        if count > self.left:
            raise ValueError("truncated")
        number = self.value & ((1 << count) - 1)
        self.value >>= count
        self.left -= count
        return number

    def side(self, small: int) -> int:
        if small:
            return 8 * (1 + self.take(5))
        return 1 + self.take(JXL_SIDE_BITS[self.take(2)])


def _read_codestream(data: bytes) -> tuple[int, int, int]:
    """Width, height and orientation: SizeHeader, and the first fields of ImageMetadata."""
    if not data.startswith(JXL_CODESTREAM):
        raise ValueError("no codestream")
    bits = _Bits(data[2:])
    small = bits.take(1)
    height = bits.side(small)
    ratio = bits.take(3)
    if ratio:
        over, under = JXL_RATIOS[ratio - 1]
        width = height * over // under
    else:
        width = bits.side(small)
    plain = bits.take(1) or not bits.take(1)  # all_default, extra_fields
    return width, height, 1 if plain else 1 + bits.take(3)
