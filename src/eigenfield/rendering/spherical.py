"""What tells players that a video is stereo, or half a sphere: boxes of Google's Spherical Video V2 in an .mp4.

`st3d` says where the second eye's picture is; `sv3d` that pictures are equirectangular, and which part of the sphere
they cover (https://github.com/google/spatial-media/blob/master/docs/spherical-video-v2-rfc.md).
"""

from __future__ import annotations

import struct

TOP_BOTTOM, LEFT_RIGHT = 1, 2  # modes of `st3d`
QUARTER = 1 << 30  # of the sphere's width, which is left out on either side: a fraction of 32 bits
SAMPLE_ENTRY_BYTES = 8 + 78  # of a picture's entry before the boxes in it (ISO 14496-12, VisualSampleEntry)
WAY = ((b"moov", 0), (b"trak", 0), (b"mdia", 0), (b"minf", 0), (b"stbl", 0), (b"stsd", 8))  # and bytes before the boxes


def vr_boxes(layout: str) -> bytes:
    """The boxes for a layout of `STEREO_LAYOUTS`, the left eye first."""
    mode = TOP_BOTTOM if layout == "top-bottom" else LEFT_RIGHT
    stereo = _full(b"st3d", struct.pack(">B", mode))
    if layout != "vr180":
        return stereo
    head = _full(b"prhd", struct.pack(">iii", 0, 0, 0))
    equirectangular = _full(b"equi", struct.pack(">IIII", 0, 0, QUARTER, QUARTER))
    return stereo + _box(b"sv3d", _full(b"svhd", b"eigenfield\0") + _box(b"proj", head + equirectangular))


def with_boxes(film: bytes, boxes: bytes) -> bytes:
    """An .mp4 of one video track, before any other, whose description of pictures ends with these boxes.

    The film's index is its last box, as the muxer writes it, so that no offset in it changes.
    """
    made = bytearray(film)
    start, end, sizes = 0, len(made), []
    for name, skipped in WAY:
        at = _find(made, name, start, end)
        sizes.append(at)
        start, end = at + 8 + skipped, at + _size(made, at)
    sizes.append(start)  # the entry itself
    place = start + _size(made, start)
    assert sizes[0] + _size(made, sizes[0]) == len(made) and place >= start + SAMPLE_ENTRY_BYTES
    for at in sizes:
        made[at : at + 4] = struct.pack(">I", _size(made, at) + len(boxes))
    made[place:place] = boxes
    return bytes(made)


def _size(data: bytearray, at: int) -> int:
    return int(struct.unpack_from(">I", data, at)[0])


def _find(data: bytearray, name: bytes, start: int, end: int) -> int:
    """Where the first box of a name begins."""
    while data[start + 4 : start + 8] != name:
        size = _size(data, start)
        start += size if size != 1 else struct.unpack_from(">Q", data, start + 8)[0]  # a large one has 64 bits
        assert start < end
    return start


def _box(name: bytes, content: bytes) -> bytes:
    return struct.pack(">I", 8 + len(content)) + name + content


def _full(name: bytes, content: bytes) -> bytes:
    """A box with a version and flags, all 0."""
    return _box(name, bytes(4) + content)
