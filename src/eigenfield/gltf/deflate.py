"""JSON in few bytes: raw deflate, inflated within a bound."""

from __future__ import annotations

import zlib

from eigenfield.core.errors import FormatError


def deflate(text: bytes, dictionary: bytes = b"") -> bytes:
    """The bytes that `inflate` takes."""
    coder = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS, 9, zlib.Z_DEFAULT_STRATEGY, dictionary)
    return coder.compress(text) + coder.flush()


def inflate(data: memoryview | bytes, most: int, where: str, dictionary: bytes = b"") -> bytes:
    """The text, of which no more than a byte beyond `most` is made. FormatError `coded-damaged`."""
    decoder = zlib.decompressobj(-zlib.MAX_WBITS, zdict=dictionary)
    try:
        text = decoder.decompress(data, most + 1)
    except zlib.error as error:
        raise FormatError("coded-damaged", "the packed JSON does not inflate", where=where) from error
    if len(text) <= most and (not decoder.eof or decoder.unused_data):
        raise FormatError("coded-damaged", "the packed JSON does not end where it should", where=where)
    return text
