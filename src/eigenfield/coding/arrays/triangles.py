"""Triangles of the view plane in few bytes: sorted, each less the one before."""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.entropy import range_coder
from eigenfield.coding.entropy.table_kernels import CONTEXTS, MIXTURES, code_lines

VERSION = 1
HEADER = struct.Struct("<BI")  # version, triangles


def sorted_triangles(triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    """The same (T, 3), each with its sense but beginning with its least corner, in rising order."""
    first = triangles.argmin(axis=1)
    turned = np.take_along_axis(triangles, (first[:, None] + np.arange(3)) % 3, axis=1)
    return turned[np.lexsort(turned.T[::-1])]


def code_triangles(triangles: NDArray[np.int32]) -> bytes:
    """Triangles (T, 3), which a decoder finds sorted."""
    count = len(triangles)
    lines = _lines(sorted_triangles(triangles))
    body = range_coder.coded_bytes(
        lambda coder: code_lines(coder, lines.copy(), np.arange(count) - 1), CONTEXTS, MIXTURES, room=4 * count + 256
    )
    return range_coder.pad_bytes(HEADER.pack(VERSION, count) + body, 3 * count)


def decode_triangles(data: bytes, where: str = "triangles") -> NDArray[np.int32]:
    """(T, 3) indices of cameras. FormatError `coded-truncated`, `coded-version`, `coded-size`, `coded-damaged`."""
    range_coder.check_header(data, HEADER.size, VERSION, where)
    _, count = HEADER.unpack_from(data)
    range_coder.check_numbers(data, 3 * count, 6 * limits.MAX_CAMERAS, where)
    coder = range_coder.decoder(data[HEADER.size :], CONTEXTS, MIXTURES)
    lines = np.zeros((count, 3), np.int64)
    code_lines(coder, lines, np.arange(count) - 1)
    range_coder.check_end(coder, where)
    found = np.stack([lines[:, 0], lines[:, 0] + lines[:, 1], lines[:, 0] + lines[:, 2]], axis=1)
    if found.min(initial=0) < 0 or found.max(initial=0) >= limits.MAX_CAMERAS:
        raise range_coder.damaged_error("triangles of cameras that there cannot be", where)
    return found.astype(np.int32)


def _lines(triangles: NDArray[np.int32]) -> NDArray[np.int64]:
    """The least corner, and the others less that."""
    wide = triangles.astype(np.int64)
    return np.stack([wide[:, 0], wide[:, 1] - wide[:, 0], wide[:, 2] - wide[:, 0]], axis=1)
