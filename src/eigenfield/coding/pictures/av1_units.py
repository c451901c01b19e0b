"""The open bitstream units of AV1: a picture is a sequence header and a frame, and nothing else."""

from __future__ import annotations

from collections.abc import Iterator

from eigenfield.core.errors import FormatError

SEQUENCE_HEADER, TEMPORAL_DELIMITER = 1, 2  # types of units
_MAX_LENGTH_SHIFT = 28  # of a unit's length, which has 7 bits a byte


def units(data: bytes) -> Iterator[tuple[int, int, int, int]]:
    """Type, start, start of the payload and end of each unit, as far as they are whole."""
    start = 0
    while start < len(data):
        header = data[start]
        at = start + (2 if header & 4 else 1)  # an extension's byte
        length = shift = 0
        if not header & 2:  # no length: to the end
            yield header >> 3 & 15, start, at, len(data)
            return
        while True:  # little-endian, 7 bits a byte
            if at >= len(data) or shift > _MAX_LENGTH_SHIFT:
                return
            length |= (data[at] & 127) << shift
            shift, at = shift + 7, at + 1
            if data[at - 1] < 128:
                break
        if at + length > len(data):
            return
        yield header >> 3 & 15, start, at, at + length
        start = at + length


def picture_units(data: bytes) -> bytes:
    """What a decoder needs of a stream of one frame: all but the temporal delimiters."""
    return b"".join(data[start:end] for kind, start, _, end in units(data) if kind != TEMPORAL_DELIMITER)


def frame_size(data: memoryview, where: str) -> tuple[int, int]:
    """Width and height of a picture from its sequence header, which comes first (AV1, section 5.5.1). FormatError
    `picture-damaged`, it does not begin with one of a single operating point, without timing."""
    kind, _, at, end = next(units(bytes(data[:64])), (0, 0, 0, 0))
    bits = _Bits(bytes(data[at:end]))
    bits.take(4)  # profile, still picture
    if bits.take(1):  # a reduced header
        bits.take(5)  # level
    elif kind == SEQUENCE_HEADER and bits.take(1 + 1 + 5) == 0:  # no timing, no display delay, one operating point
        bits.take(12)  # operating point
        if bits.take(5) > 7:  # level
            bits.take(1)  # tier
    else:
        kind = 0
    wide, high = bits.take(4) + 1, bits.take(4) + 1
    width, height = bits.take(wide) + 1, bits.take(high) + 1
    if kind != SEQUENCE_HEADER or bits.left < 0:
        raise FormatError("picture-damaged", "the picture cannot be decoded: no AV1 sequence header", where=where)
    return width, height


class _Bits:
    """Bits of some bytes, the highest of each first; beyond the end they are zero."""

    def __init__(self, data: bytes) -> None:
        self.left = 8 * len(data)
        self._value = int.from_bytes(data)

    def take(self, count: int) -> int:
        """The next `count` bits as a number."""
        self.left -= count
        taken = self._value >> self.left if self.left >= 0 else 0
        return taken & ((1 << count) - 1)
