"""Chunks of PNG (ISO/IEC 15948; PNG 3): orientation, colour space, and what a damaged chunk may leave out."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from typing import Any, NamedTuple

from PIL import Image

from eigenfield.capture.photographs.colour import (
    COLOUR_PRIMARIES,
    COLOUR_UNSPECIFIED,
    Profile,
    read_code_points,
    read_gamma,
)
from eigenfield.capture.photographs.header import EXIF_ORIENTATION_TAG, read_at

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"
PNG_MAX_EXIF_BYTES = 64 * 1024
PNG_TEXT = (b"tEXt", b"zTXt", b"iTXt")  # no pixel depends on them


class _Chunk(NamedTuple):
    kind: bytes
    start: int  # of its length, before its data
    size: int  # of its data

    @property
    def is_critical(self) -> bool:
        return not self.kind[0] & 0x20


def _read_chunks(file: Any) -> Iterator[_Chunk]:
    at = len(PNG_SIGNATURE)
    while len(start := read_at(file, at, 8)) == 8:
        size, kind = struct.unpack(">I4s", start)
        yield _Chunk(kind, at, size)
        at += 12 + size


def read_png_orientation(file: Any) -> Any:
    """From the eXIf chunk, which may follow the pixels: Pillow would decode them to find it."""
    for chunk in _read_chunks(file):
        if chunk.kind == b"eXIf" and chunk.size <= PNG_MAX_EXIF_BYTES:
            exif = Image.Exif()
            exif.load(b"Exif\0\0" + read_at(file, chunk.start + 8, chunk.size))
            return exif.get(EXIF_ORIENTATION_TAG, 1)
    return 1


def without_notes(data: bytes) -> bytes:
    """The file without its texts and without what is damaged and not critical, which viewers leave out, too."""
    kept, start = [], 0
    for chunk in _read_chunks(io.BytesIO(data)):
        end = chunk.start + 12 + chunk.size
        if chunk.is_critical or end > len(data):
            continue
        body = data[chunk.start + 4 : end - 4]
        if chunk.kind in PNG_TEXT or zlib.crc32(body) != int.from_bytes(data[end - 4 : end]):
            kept.append(data[start : chunk.start])
            start = end
    return b"".join([*kept, data[start:]]) if start else data


def read_png_colours(data: bytes, info: dict[Any, Any]) -> tuple[Profile | None, bool]:
    """The profile that chunks state (cICP before iCCP and sRGB, and those before cHRM and gAMA), and whether values are
    of the narrow range.

    Raises:
        ValueError: Where it states no colours that there are.
    """
    for chunk in _read_chunks(io.BytesIO(data)):
        if chunk.kind == b"cICP" and chunk.size == 4:
            primaries, transfer, _, full = data[chunk.start + 8 : chunk.start + 12]
            if (primaries, transfer) != COLOUR_UNSPECIFIED:
                return read_code_points(primaries, transfer), not full
        if chunk.kind == b"IDAT":
            break
    gamma, chromaticity = info.get("gamma"), info.get("chromaticity")
    if info.get("icc_profile") or "srgb" in info or (gamma is None and chromaticity is None):
        return None, False
    corners: tuple[tuple[float, float], ...] = COLOUR_PRIMARIES[1]
    if chromaticity is not None:
        white, red, green, blue = zip(chromaticity[::2], chromaticity[1::2], strict=True)
        corners = red, green, blue, white
    return read_gamma(corners, 1 / gamma if gamma else None), False
