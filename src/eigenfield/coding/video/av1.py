"""Videos of 10-bit Y'CbCr, 4:2:0: AV1 as a bare stream of its own units.

SVT-AV1 codes them, tuned for squared error; dav1d decodes them, a frame at a time.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.av1_units import units
from eigenfield.coding.pictures.pictures_10bit import PICTURE_BITS, PIXEL_FORMAT, decoder_errors, frame_of, samples_of
from eigenfield.core.errors import FormatError
from eigenfield.runtime.parallel import ordinary_scheduling

Planes = tuple[NDArray[np.uint16], NDArray[np.uint16], NDArray[np.uint16]]

FRAME_RATE_HZ = 25  # without meaning here, but a video has one
SVT_PARALLELISM = 1  # SVT-AV1's level, fixed: the next takes 1.6 times the memory for the same bytes
ENDLESS_INTERVAL = 99999  # frames: no key frame follows the first


def encode_video(
    frames: Iterable[Planes], size: tuple[int, int], crf: int, preset: int, key_interval: int | None = None
) -> bytes:
    """A video, the same bytes each time. One frame after the other is taken of the iterator.

    Args:
        frames: Luma (rows, columns) and both chroma planes of half that, each way; codes 0..1023.
        size: Rows and columns, even and at least `MIN_SIDE_TEXELS`.
        crf: 1..63, the coarser the higher.
        preset: SVT-AV1's, 0 the slowest.
        key_interval: Frames from one key frame to the next; None: the first is the only one.
    """
    return b"".join(encode_units(frames, size, crf, preset, "scd=0", key_interval))


def encode_units(
    frames: Iterable[Planes], size: tuple[int, int], crf: int, preset: int, more: str, key_interval: int | None = None
) -> Iterator[bytes]:
    """The temporal units of a video, with their delimiters: as many as frames, in the order in which they are shown.

    Args:
        more: Parameters of SVT-AV1.
    """
    os.environ.setdefault("SVT_LOG", "1")  # errors alone: its settings go to stderr otherwise
    import av

    context: Any = av.CodecContext.create("libsvtav1", "w")
    context.height, context.width = size
    context.pix_fmt = PIXEL_FORMAT
    context.framerate, context.time_base = Fraction(FRAME_RATE_HZ), Fraction(1, FRAME_RATE_HZ)
    context.gop_size = key_interval or ENDLESS_INTERVAL
    context.color_range, context.colorspace = 2, 1  # full, BT.709
    context.options = {
        "crf": str(crf), "preset": str(preset),
        "svtav1-params": f"keyint={key_interval or -1}:tune=1:lp={SVT_PARALLELISM}:{more}",
    }  # fmt: skip
    with ordinary_scheduling():
        context.open()
    for number, planes in enumerate(frames):
        frame = frame_of(planes)
        frame.pts, frame.time_base = number, Fraction(1, FRAME_RATE_HZ)
        yield from map(bytes, context.encode(frame))
    yield from map(bytes, context.encode(None))


def decode_video(data: bytes, size: tuple[int, int], count: int, where: str, name: str) -> Iterator[Planes]:
    """The frames of a video one after the other, as they were given to `encode_video`.

    Args:
        size: (rows, columns); no larger frame takes memory.
        count: Frames; none beyond these is decoded.
        name: What the video is of, for errors.

    Raises:
        FormatError: `NAME-damaged`, the video is damaged, ends early, or has frames of another size or kind.
    """
    import av

    def damage_error(what: str) -> FormatError:
        return FormatError(f"{name}-damaged", f"the {name} cannot be decoded: {what}", where=where)

    context: Any = av.CodecContext.create("libdav1d", "r")
    context.options = {"max_pixels": str(size[0] * size[1])}
    context.thread_count = 1  # with more, dav1d's threads may wait for each other for ever on a damaged video
    number = 0
    # a unit shows one frame at most, so that a decoder that is given one at a time never has more to hand out
    for unit in chain((data[start:end] for _, start, _, end in units(data)), [None]):
        with decoder_errors(name, where):
            frames = context.decode(None if unit is None else av.Packet(unit))
        for frame in frames:
            if (frame.height, frame.width) != size or frame.format.name != PIXEL_FORMAT:
                found = f"{frame.width}x{frame.height}, {frame.format.name}"
                raise damage_error(f"a frame of {found}; {size[1]}x{size[0]} of {PICTURE_BITS} bits announced")
            luma, blue, red = map(samples_of, frame.planes)
            yield luma, blue, red
            number += 1
            if number == count:
                return
    raise damage_error(f"ends after {number} of {count} frames")
