"""Sound in a file: Opus in Ogg (RFC 7845), which is kept as it is."""

from __future__ import annotations

OPUS_TYPE = "audio/ogg"
_PAGE, _PACKET = b"OggS", b"OpusHead"  # with which the file, and its first packet, begin
_FIRST_PACKET = 28  # byte of the file at which it begins, behind the head of a page of one segment


def is_opus(data: bytes | memoryview) -> bool:
    """Whether bytes begin as an Ogg file of Opus does."""
    head = bytes(data[: _FIRST_PACKET + len(_PACKET)])
    return head.startswith(_PAGE) and head[_FIRST_PACKET:] == _PACKET
