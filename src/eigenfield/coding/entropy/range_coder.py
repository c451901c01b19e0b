"""Bytes to and from the kernels' coder, and the checks that all coded parts share.

A part begins with a header that holds the count of its numbers. A decoder allocates in proportion to it, so a byte may
stand for at most MAX_NUMBERS_PER_BYTE of them: parts that would be shorter are padded with zeros, which a decoder reads
behind the end anyway.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.entropy.range_kernels import AT, finish, new_coder
from eigenfield.core.errors import FormatError

MAX_NUMBERS_PER_BYTE = 16  # or vertices, or faces
FREE_NUMBERS = 1024  # beyond these
READ_AHEAD_BYTES = 4  # by a decoder


def coded_bytes(run: Callable[[Any], None], contexts: int, mixtures: int, *, room: int) -> bytes:
    """The bytes that `run(coder)` writes.

    Args:
        room: Bytes to expect; where they do not suffice, it runs twice.
    """
    while True:
        coder = new_coder(np.zeros(room, np.uint8), True, contexts, mixtures)
        run(coder)
        finish(coder)
        size = int(coder.state[AT])
        if size <= room:
            return bytes(coder.data[:size])
        room = size


def decoder(data: bytes, contexts: int, mixtures: int) -> Any:
    """A coder that reads `data`."""
    return new_coder(np.frombuffer(data, np.uint8).copy(), False, contexts, mixtures)


def pad_bytes(data: bytes, numbers: int) -> bytes:
    """`data`, padded so that it may stand for that many numbers."""
    return data + bytes(max(0, -(-(numbers - FREE_NUMBERS) // MAX_NUMBERS_PER_BYTE) - len(data)))


def check_header(data: bytes, size: int, version: int, where: str) -> None:
    """Raise FormatError: `coded-truncated` if `data` is shorter than its header of `size` bytes, `coded-version` if it
    does not begin with the version of its codec."""
    if len(data) < size:
        raise FormatError("coded-truncated", f"{len(data)} bytes where a header has {size}", where=where)
    if data[0] != version:
        raise FormatError("coded-version", f"coded numbers of version {data[0]}, this reads {version}", where=where)


def check_numbers(data: bytes, numbers: int, most: int, where: str) -> None:
    """Raise FormatError `coded-size` if there are more than `most` numbers, or more than the bytes may stand for."""
    if numbers > most or numbers > MAX_NUMBERS_PER_BYTE * len(data) + FREE_NUMBERS:
        raise FormatError("coded-size", f"{numbers} numbers announced in {len(data)} bytes", where=where)


def float32_numbers(data: bytes, count: int, offset: int) -> NDArray[np.float64]:
    """(count,) float64 of the float32 numbers at a byte; NaN of any kind without a warning."""
    with np.errstate(invalid="ignore"):
        return np.frombuffer(data, "<f4", count, offset).astype(np.float64)


def check_end(coder: Any, where: str) -> None:
    """Raise FormatError `coded-truncated` if more was read than there is."""
    if coder.state[AT] > len(coder.data) + READ_AHEAD_BYTES:
        raise FormatError("coded-truncated", "coded numbers are cut off", where=where)


def damaged_error(what: str, where: str) -> FormatError:
    """The error `coded-damaged` for impossible numbers."""
    return FormatError("coded-damaged", what, where=where)
