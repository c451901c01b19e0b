"""Grey pictures of 10-bit codes as AV1: eigen textures and means as a fit leaves them.

SVT-AV1 codes them as 4:2:0 with flat chroma, full range, tuned for squared error; dav1d decodes them. A picture is the
bare sequence header and frame (`av1-10bit-2`), or an AVIF file (`av1-10bit-1`, which is read only). AVIF's boxes take
289 bytes of each picture. A reader of 8 bits (a browser) finds the same picture in codes of 8 bits.
"""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.pictures.av1_units import picture_units, units
from eigenfield.core.errors import FormatError
from eigenfield.runtime.parallel import ordinary_scheduling

Coder = Callable[[NDArray[np.uint16], int], bytes]  # as `encode_10bit`, from codes and crf

PICTURE_BITS = 10
MAX_CODE = 2**PICTURE_BITS - 1
MIDDLE_CODE = 2 ** (PICTURE_BITS - 1)
MIN_SIDE_TEXELS = 64  # that the encoder takes
# Quantiser steps of AV1 at 10 bits, in codes, at every fourth crf from 0 (its table of AC steps over 8, rounded)
_STEPS = (0.5, 7, 14, 21, 28, 36, 43, 50, 58, 67, 79, 95, 116, 150, 206, 312, 668)
CRFS = (*range(0, 61, 4), 63)
QUANTISERS_PER_CRF = 4  # AV1 has 256 quantisers
LAST_EVEN_CRF = 60  # up to which a crf is four quantisers more than the one before
# A picture is the key frame of a film of a coarser crf: with it the encoder looks for better ways (decision 55)
ANNOUNCED_CRF_OFFSET = 15
# lambda is 3/4 of the usual, and the step a tenth more, for the same error in fewer bytes
STEP_RATIO = 1.1
_KEY_FRAME_OPTIONS = (
    "tune=1:keyint=64:aq-mode=0:lp=1:pred-struct=1:hierarchical-levels=2:lookahead=0:use-fixed-qindex-offsets=1"
    ":lambda-scale-factors=96,128,128,128,128,128,128"
)
PIXEL_FORMAT = "yuv420p10le"  # chroma is flat


def encoder_step(crf: float) -> float:
    """The encoder's quantiser step at a crf of 0..63, in codes; near enough to say how finely to code."""
    return float(np.interp(crf, CRFS, _STEPS))


def crf_of(step: float) -> int:
    """The crf, 1..63, whose quantiser step is nearest `step` codes."""
    return int(np.clip(np.rint(np.interp(step, _STEPS, CRFS)), 1, 63))


def svt_coder(preset: int) -> Coder:
    """SVT-AV1 at a preset, 0 the slowest."""
    return partial(encode_10bit, preset=preset)


def encode_10bit(codes: NDArray[np.uint16], crf: int, preset: int) -> bytes:
    """A picture as bare AV1, by one thread, the same bytes each time.

    Args:
        codes: (H, W) 0..MAX_CODE, sides even and at least MIN_SIDE_TEXELS.
        crf: 0..63, the coarser the higher.
        preset: SVT-AV1's, 0 the slowest.
    """
    os.environ.setdefault("SVT_LOG", "1")  # errors alone: its settings go to stderr otherwise
    import av

    height, width = codes.shape
    context: Any = av.CodecContext.create("libsvtav1", "w")
    context.width, context.height, context.pix_fmt = width, height, PIXEL_FORMAT
    context.framerate = context.time_base = Fraction(1)
    context.color_range = 2  # full
    context.thread_count = 1
    announced = max(crf, min(crf + ANNOUNCED_CRF_OFFSET, LAST_EVEN_CRF))
    quantiser = QUANTISERS_PER_CRF * np.interp(STEP_RATIO * encoder_step(crf), _STEPS, CRFS)
    offset = round(float(quantiser)) - QUANTISERS_PER_CRF * announced
    context.options = {
        "crf": str(announced), "preset": str(preset),
        "svtav1-params": f"{_KEY_FRAME_OPTIONS}:key-frame-qindex-offset={offset}",
    }  # fmt: skip
    with ordinary_scheduling():
        context.open()
    flat = np.full((height // 2, width // 2), MIDDLE_CODE, np.uint16)
    frame = frame_of((codes, flat, flat))
    frame.pts = 0
    return picture_units(b"".join(bytes(packet) for packet in [*context.encode(frame), *context.encode()]))


# Two presets on take half as long and 4 % more bytes; one back takes twice as long and 3 % fewer (Tarot)
CODER, PATIENT_CODER, TRIAL_CODER = svt_coder(2), svt_coder(1), svt_coder(4)


def decode_10bit(data: bytes | memoryview, colour: bool, where: str) -> NDArray[np.uint16]:
    """(H, W) codes 0..MAX_CODE of the first channel of a bare AV1 picture.

    Args:
        colour: Not used: all are grey.

    Raises:
        FormatError: `picture-damaged`; `picture-channels`, the picture has 8 bits.
    """
    import av

    context: Any = av.CodecContext.create("libdav1d", "r")
    context.options = {"max_pixels": str(limits.MAX_TEXELS)}
    context.thread_count = 1
    whole = bytes(data)
    with decoder_errors("picture", where):  # unit by unit: more frames than one take no memory
        packets = [*(av.Packet(whole[start:end]) for _, start, _, end in units(whole)), None]
        frame = next(frame for packet in packets for frame in context.decode(packet))
    return _codes(frame, where)


def decode_avif_10bit(data: bytes | memoryview, colour: bool, where: str) -> NDArray[np.uint16]:
    """As `decode_10bit`, of an AVIF file."""
    import av

    with decoder_errors("picture", where), av.open(io.BytesIO(data), format="mov") as container:
        stream = container.streams.video[0]
        stream.codec_context.options = {"max_pixels": str(limits.MAX_TEXELS)}
        stream.codec_context.thread_count = 1
        frame = next(container.decode(stream))
    return _codes(frame, where)


def _codes(frame: Any, where: str) -> NDArray[np.uint16]:
    """The first channel of a frame. FormatError `picture-channels`."""
    if frame.format.components[0].bits != PICTURE_BITS:
        bits = frame.format.components[0].bits
        raise FormatError("picture-channels", f"a picture of {bits} bits, {PICTURE_BITS} are announced", where=where)
    return samples_of(frame.planes[0])


@contextlib.contextmanager
def decoder_errors(kind: str, where: str) -> Iterator[None]:
    """Turn whatever a decoder raises on damaged bytes, which is not our bug, into FormatError `KIND-damaged`."""
    try:
        yield
    except MemoryError:
        raise
    except Exception as error:
        reason = " ".join(str(error).split())[:80] or type(error).__name__
        raise FormatError(f"{kind}-damaged", f"the {kind} cannot be decoded: {reason}", where=where) from error


def frame_of(planes: Sequence[NDArray[np.uint16]]) -> Any:
    """A frame of a video of PIXEL_FORMAT, from luma (rows, columns) and both chroma planes of half that, each way."""
    import av

    height, width = planes[0].shape
    frame = av.VideoFrame(width, height, PIXEL_FORMAT)
    for target, plane in zip(frame.planes, planes, strict=True):
        values = np.zeros((target.height, target.line_size // 2), "<u2")
        values[:, : plane.shape[1]] = plane
        target.update(values.tobytes())
    return frame


def samples_of(plane: Any) -> NDArray[np.uint16]:
    """(rows, columns) of a plane of a decoded frame."""
    values = np.frombuffer(plane, "<u2").reshape(-1, plane.line_size // 2)
    return np.ascontiguousarray(values[: plane.height, : plane.width], np.uint16)
