"""Films of 10-bit codes (`film-1`): a frame is a temporal unit of AV1, which shows it and nothing else.

The first unit is a key picture with the sequence header; no later one has either. Units come in the order in which
their frames are shown, also where the encoder codes frames in another order: a unit then holds hidden frames before the
one that it shows. So a decoder that is given a unit hands out a frame, and nothing is to be sorted.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.av1_units import SEQUENCE_HEADER, frame_size, picture_units, units
from eigenfield.coding.pictures.pictures_10bit import (
    MIDDLE_CODE,
    PICTURE_BITS,
    PIXEL_FORMAT,
    decoder_errors,
    samples_of,
)
from eigenfield.coding.video.av1 import Planes, encode_units
from eigenfield.core.errors import FormatError

# SVT-AV1's: random access with three levels of prediction takes 5 % fewer bytes than its own choice of levels, and 30 %
# fewer than prediction from earlier frames alone, whose quality also pulses more: decision 45
STRUCTURE = "scd=0:pred-struct=2:hierarchical-levels=3"


def encode_film(frames: Iterable[NDArray[np.uint16]], size: tuple[int, int], crf: int, preset: int) -> list[bytes]:
    """The temporal unit of each frame, without its delimiter; the same bytes each time.

    Args:
        frames: (rows, columns) codes 0..1023, one taken after the other.
        size: Rows and columns, multiples of 64.
        crf: 1..63, the coarser the higher.
        preset: SVT-AV1's, 0 the slowest.
    """
    flat = np.full((size[0] // 2, size[1] // 2), MIDDLE_CODE, np.uint16)
    count = 0

    def planes() -> Iterator[Planes]:
        nonlocal count
        for codes in frames:
            count += 1
            yield codes, flat, flat
        if count % 2 == 0:  # a last frame of its own would be 1 to 2 dB worse than the others: decision 45
            yield codes, flat, flat

    made = list(encode_units(planes(), size, crf, preset, STRUCTURE))
    return [picture_units(unit) for unit in made[:count]]


def decode_film(data: Iterable[bytes], size: tuple[int, int], where: str) -> Iterator[NDArray[np.uint16]]:
    """(rows, columns) codes of each frame, from the temporal units of a film.

    Args:
        data: From the first unit on; each is taken when its frame is asked for.
        size: (rows, columns); no larger frame takes memory.

    Raises:
        FormatError: `film-damaged`; `film-size`, its frames are of another size or kind; `film-frames`, a unit shows
            none, or several, or another than the first begins with a sequence header.
    """
    import av

    context: Any = av.CodecContext.create("libdav1d", "r")
    context.options = {"max_pixels": str(size[0] * size[1])}
    context.thread_count = 1  # with one, a frame is there as soon as its unit is
    for number, unit in enumerate(data):
        _check_header(unit, number, size, where)
        yield _shown_frame(context, unit, number, size, where)


def _check_header(unit: bytes, number: int, size: tuple[int, int], where: str) -> None:
    """Check what is known before the unit is decoded."""
    kinds = [kind for kind, *_ in units(unit)]
    if kinds.count(SEQUENCE_HEADER) != (number == 0):
        words = "the first unit has no sequence header" if number == 0 else f"unit {number} begins anew"
        raise FormatError("film-frames", f"the film cannot be decoded: {words}", where=where)
    if number == 0:
        try:
            found = frame_size(memoryview(unit), where)
        except FormatError as error:
            message = "the film cannot be decoded: no AV1 sequence header"
            raise FormatError("film-damaged", message, where=where) from error
        if found != (size[1], size[0]):
            message = f"a film of {found[0]}x{found[1]}, {size[1]}x{size[0]} is announced"
            raise FormatError("film-size", message, where=where)


def _shown_frame(context: Any, unit: bytes, number: int, size: tuple[int, int], where: str) -> NDArray[np.uint16]:
    import av

    shown = None
    for _, start, _, end in units(unit):  # one at a time: more frames than one take no memory
        with decoder_errors("film", where):
            frames = context.decode(av.Packet(unit[start:end]))
        if frames and (shown is not None or len(frames) > 1):
            raise FormatError("film-frames", f"unit {number} of the film shows several frames", where=where)
        shown = frames[0] if frames else shown
    if shown is None:
        raise FormatError("film-frames", f"unit {number} of the film shows no frame", where=where)
    if (shown.height, shown.width) != size or shown.format.name != PIXEL_FORMAT:
        found = f"{shown.width}x{shown.height}, {shown.format.name}"
        message = f"a frame of {found}; {size[1]}x{size[0]} of {PICTURE_BITS} bits announced"
        raise FormatError("film-size", message, where=where)
    return samples_of(shown.planes[0])
