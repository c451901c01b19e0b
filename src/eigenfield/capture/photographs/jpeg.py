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
JPEG_SCAN_END = re.compile(rb"\xff+[^\0\xff\xd0-\xd7]")
JPEG_RESTARTS, JPEG_END, JPEG_SCAN, JPEG_TABLES = range(0xD0, 0xD8), 0xD9, 0xDA, 0xC4
JPEG_BASELINE = 0xC0, 0xC1  # Huffman-coded and sequential
JPEG_ZEROS = bytes(32)  # more than a block of coefficients that are coded by nothing but zero bits


def decode_jpeg(data: bytes, mode: str, size: tuple[int, int], path: Path) -> NDArray[np.uint8] | None:
    """(H, W, 1 or 3) values; None where Pillow has to decide, and for CMYK, whose inks it turns.

    Args:
        data: A whole file, or its first picture with anything behind.
        size: Width and height, pixels.

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
    if _zeros_in_a_scan(data):
        raise unreadable_error(path, "a run of zeros in its data")
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


def _zeros_in_a_scan(data: bytes) -> bool:
    """Whether a sequential scan holds a run of zeros that no encoder writes, as bad cards and failed copies leave it.

    Huffman codes fall into step again behind it, often after as many blocks as were lost, and libjpeg then has nothing
    to warn of. Zeros would be a block of coefficients that are all alike, unless the code of zeros ends a block.
    """
    first = data.find(JPEG_ZEROS)
    at, ends_block, baseline = 2, {}, False
    while first >= 0 and at + 4 <= len(data) and data[at] == 0xFF:
        kind, end = data[at + 1], at + 2 + int.from_bytes(data[at + 2 : at + 4])
        segment = data[at + 4 : end]
        if kind == JPEG_TABLES:
            while len(segment) > 17:
                ends_block[segment[0]] = segment[17] == 0  # the first symbol has the code of zeros; 0 ends a block
                segment = segment[17 + sum(segment[1:17]) :]
        elif kind == JPEG_SCAN:
            codes = [ends_block.get(0x10 | tables & 0xF, True) for tables in segment[2 : 1 + 2 * segment[0] : 2]]
            zeros = data.find(JPEG_ZEROS, end)
            if not baseline or zeros < 0 or all(codes) or JPEG_SCAN_END.search(data, end, zeros):
                return False
            behind = len(data) - len(data[zeros:].lstrip(b"\0"))
            return not JPEG_SCAN_END.match(data, behind)  # that would be padding
        baseline = baseline or kind in JPEG_BASELINE
        at = end
    return False


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
