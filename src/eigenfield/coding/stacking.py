"""The layout of textures in pictures: channels and textures one below the other, checked against the announced size.

Codes of one channel are a grey picture, of three an RGB one of 8 bits; any other number, and any of 10 bits, is a grey
picture in which the channels lie one below the other, the first on top.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import features

from eigenfield.coding import limits
from eigenfield.coding.codecs import CODECS, PictureCodec, encoder
from eigenfield.core.errors import FormatError, OptionError

PICTURES = {name: codec for name, codec in CODECS.items() if isinstance(codec, PictureCodec)}
SAVE_CODECS = tuple(name for name, codec in PICTURES.items() if codec.bits == 8 and codec.encode is not None)
DEFAULT_CODEC = "avif"


def check_codec(codec: str, quality: int | None) -> None:
    """Check the codec and quality of `save`. OptionError `codec`, `codec-missing`, `quality`."""
    if codec not in SAVE_CODECS:
        raise OptionError("codec", f"there is no codec {codec!r}", remedy=f"use {', '.join(SAVE_CODECS)}")
    if codec in ("avif", "webp") and not features.check(codec):
        remedy = "install a wheel of pillow 11.3 or later"
        raise OptionError("codec-missing", f"this Pillow has no {codec}", remedy=remedy)
    if quality is not None and PICTURES[codec].lossless:
        raise OptionError("quality", f"{codec} is lossless and takes no quality", remedy="leave it out or use avif")
    if quality is not None and not 0 <= quality <= 100:
        raise OptionError("quality", f"a quality of {quality}", remedy="use 0 to 100")


def codec_of(mime: str, bits: int = 8) -> str | None:
    """The default codec of pictures of this type and depth by name; None: there is none."""
    return next((name for name, codec in PICTURES.items() if (codec.mime, codec.bits) == (mime, bits)), None)


def stacked_picture(codes: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """(H, W, C) codes as a picture: (H, W) for one channel, (H, W, 3) for three, else (C H, W)."""
    height, width, channels = codes.shape
    if channels == 3:
        return codes
    return np.ascontiguousarray(codes.transpose(2, 0, 1)).reshape(channels * height, width)


def picture_size(width: int, height: int, channels: int, count: int = 1, bits: int = 8) -> tuple[int, int]:
    """Width and height of the picture that holds `count` textures of `channels` of `width` x `height`."""
    return (width, height * count) if channels == 3 and bits == 8 else (width, height * channels * count)


def encode(codes: NDArray[np.uint8], codec: str, quality: int) -> bytes:
    """A picture by one thread, the same bytes each time.

    Args:
        codes: (H, W, C) uint8.
        codec: One of SAVE_CODECS.
        quality: 0..100, for lossy ones.
    """
    return encoder(codec)(stacked_picture(codes), quality)


def dimensions(data: memoryview, codec: str, where: str) -> tuple[int, int]:
    """Width and height from a picture's header alone; nothing is decoded or allocated. FormatError `codec-missing`,
    `picture-damaged`, `picture-limit`."""
    width, height = PICTURES[codec].size(data, where)
    if width > limits.MAX_SIDE or height > limits.MAX_STACKED or width * height > limits.MAX_TEXELS:
        raise FormatError("picture-limit", f"{width}x{height}, {limits.MAX_TEXELS} texels are allowed", where=where)
    return width, height


def check_picture(
    data: memoryview, codec: str, width: int, height: int, channels: int, where: str, count: int = 1
) -> None:
    """Compare a picture's header with the announced size.

    Raises:
        FormatError: As `dimensions`, and `picture-size`.
    """
    found, expected = dimensions(data, codec, where), picture_size(width, height, channels, count, PICTURES[codec].bits)
    if found != expected:
        shown, asked = (f"{columns}x{rows}" for columns, rows in (found, expected))
        raise FormatError("picture-size", f"the picture is {shown}, {asked} are announced", where=where)


def decode(
    data: memoryview, codec: str, width: int, height: int, channels: int, where: str, count: int = 1
) -> NDArray[Any]:
    """(count, height, width, channels) codes, uint8 or of 10 bits uint16, of a picture of `count` textures.

    Raises:
        FormatError: As `check_picture`, and `picture-channels`, `picture-damaged`.
    """
    check_picture(data, codec, width, height, channels, where, count)
    bits = PICTURES[codec].bits
    colour = channels == 3 and bits == 8
    pixels: NDArray[Any] = PICTURES[codec].decode(data, colour, where)
    if pixels.shape[:2] != picture_size(width, height, channels, count, bits)[::-1]:
        raise FormatError("picture-damaged", "decodes to another size than its header says", where=where)
    if colour:
        return pixels.reshape(count, height, width, 3)
    return np.ascontiguousarray(pixels.reshape(count, channels, height, width).transpose(0, 2, 3, 1))
