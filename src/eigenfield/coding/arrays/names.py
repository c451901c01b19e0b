"""Names of cameras in few bytes where they follow no pattern: numbers that jitter, as measured positions do."""

from __future__ import annotations

import zlib
from collections.abc import Sequence

from eigenfield.coding import limits
from eigenfield.core.errors import FormatError

NAME_MAX_BYTES = 4 * limits.MAX_NAME  # in UTF-8


def code_names(names: Sequence[str]) -> bytes | None:
    """The names' first bytes, then their second ones and so on, deflated; None where they have no UTF-8, hold a byte 0,
    or are too many. Digits of the same place then stand side by side, which takes 40 % less than name after name."""
    try:
        texts = [name.encode() for name in names]
    except UnicodeEncodeError:
        return None
    longest = max(map(len, texts))
    if not longest or longest * len(texts) > limits.MAX_NAMES or any(0 in text for text in texts):
        return None
    padded = [text.ljust(longest, b"\0") for text in texts]
    return zlib.compress(b"".join(bytes(column) for column in zip(*padded, strict=True)), 9)


def decode_names(data: bytes, count: int, where: str = "names") -> list[str]:
    """`count` names. FormatError `coded-truncated`, `coded-size`, `coded-damaged`."""
    most = min(limits.MAX_NAMES, NAME_MAX_BYTES * count)
    inflater = zlib.decompressobj()
    try:
        columns = inflater.decompress(data, most + 1)
    except zlib.error as error:
        raise FormatError("coded-damaged", f"names that do not inflate: {error}", where=where) from None
    if len(columns) > most:
        raise FormatError("coded-size", f"more than {most} bytes of names", where=where)
    if not inflater.eof:
        raise FormatError("coded-truncated", "names are cut off", where=where)
    if not columns or len(columns) % count or inflater.unused_data:
        raise FormatError("coded-damaged", f"{len(columns)} bytes are not {count} names of one length", where=where)
    try:
        return [columns[i::count].rstrip(b"\0").decode() for i in range(count)]
    except UnicodeDecodeError:
        raise FormatError("coded-damaged", "names that are not UTF-8", where=where) from None
