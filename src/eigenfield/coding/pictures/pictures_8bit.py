"""Pictures of 8-bit codes: PNG and WebP (lossless), AVIF (lossy; of 10 bits in `deep`); a JPEG for viewers that know
nothing of us.

Codes of one channel are a grey picture, of three an RGB one; any other number is a grey picture in which the channels
lie one below the other, the first on top. No profile, no orientation: the stored numbers are the codes.
"""

from __future__ import annotations

import io
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import AvifImagePlugin, Image, ImageFile, JpegImagePlugin, PngImagePlugin, WebPImagePlugin, features

from eigenfield.coding import limits
from eigenfield.coding.pictures import pictures_10bit as deep
from eigenfield.core.errors import FormatError, OptionError

Codes = NDArray[np.uint8]

MIME_TYPES = {"png": "image/png", "webp": "image/webp", "avif": "image/avif"}
DEFAULT_CODEC = "avif"
LOSSLESS = ("png", "webp")
AVIF_SPEED = 6  # Tarot, 16 pictures of 1024 x 1024: 3 s; 5 saves 8 % of the bytes and takes 13 s, 4 saves no more
PREVIEW_SIDE = 512
PREVIEW_QUALITY = 85
_WEBP_SIDE = 16_383
_MODES = {1: ("L",), 3: ("RGB",)}
_READERS: dict[str, type[ImageFile.ImageFile]] = {
    "image/png": PngImagePlugin.PngImageFile,
    "image/jpeg": JpegImagePlugin.JpegImageFile,
    "image/webp": WebPImagePlugin.WebPImageFile,
    "image/avif": AvifImagePlugin.AvifImageFile,
}


def check_codec(codec: str, quality: int | None) -> None:
    """Raises OptionError for a codec or a quality that cannot be: `codec`, `codec-missing`, `quality`."""
    if codec not in MIME_TYPES:
        raise OptionError("codec", f"there is no codec {codec!r}", remedy=f"use {', '.join(MIME_TYPES)}")
    if codec in ("avif", "webp") and not features.check(codec):
        raise OptionError(
            "codec-missing", f"this Pillow has no {codec}", remedy="install a wheel of pillow 11.3 or later"
        )
    if quality is not None and codec in LOSSLESS:
        raise OptionError("quality", f"{codec} is lossless and takes no quality", remedy="leave it out or use avif")
    if quality is not None and not 0 <= quality <= 100:
        raise OptionError("quality", f"a quality of {quality}", remedy="use 0 to 100")


def stacked(codes: Codes) -> Codes:
    """(H, W, C) codes as a picture: (H, W) for one channel, (H, W, 3) for three, else (C H, W)."""
    height, width, channels = codes.shape
    if channels == 3:
        return codes
    return np.ascontiguousarray(codes.transpose(2, 0, 1)).reshape(channels * height, width)


def picture_size(width: int, height: int, channels: int, count: int = 1, bits: int = 8) -> tuple[int, int]:
    """Width and height of the picture that holds `count` textures of `channels` of `width` x `height`; one of 10 bits
    is always grey."""
    return (width, height * count) if channels == 3 and bits == 8 else (width, height * channels * count)


def encode(codes: Codes, codec: str, quality: int) -> bytes:
    """(H, W, C) uint8 codes as a picture file; one thread, the same bytes each time.

    quality: 0..100, for avif only.
    """
    image = Image.fromarray(stacked(codes))
    buffer = io.BytesIO()
    if codec == "png":
        image.save(buffer, "PNG", compress_level=9)
    elif codec == "webp":
        if max(image.size) > _WEBP_SIDE:
            raise OptionError(
                "codec-side", f"webp holds {_WEBP_SIDE} texels a side, {max(image.size)} needed", remedy="use png"
            )
        image.save(buffer, "WEBP", lossless=True, quality=80, method=4)
    else:
        image.save(
            buffer,
            "AVIF",
            quality=quality,
            speed=AVIF_SPEED,
            subsampling="4:4:4" if image.mode == "RGB" else "4:0:0",
            range="full",
            max_threads=1,
            autotiling=False,  # tiles would follow the threads
            advanced={"tune": "psnr", "deltaq-mode": "0"},  # squared error, not looks: textures are summed
        )
    return buffer.getvalue()


def encode_preview(codes: Codes, side: int = PREVIEW_SIDE, quality: int = PREVIEW_QUALITY) -> bytes:
    """(H, W, 1 or 3) uint8 as a JPEG of at most `side` texels on the longer side."""
    image = Image.fromarray(stacked(codes))
    scale = min(1.0, side / max(image.size))
    size = (max(1, round(image.width * scale)), max(1, round(image.height * scale)))
    if size != image.size:
        image = image.resize(size, Image.Resampling.LANCZOS)
    buffer = io.BytesIO()
    image.save(buffer, "JPEG", quality=quality, optimize=True)
    return buffer.getvalue()


def dimensions(data: memoryview, mime: str, where: str) -> tuple[int, int]:
    """Width and height from a picture's header alone; nothing is decoded or allocated.

    FormatError: `picture-type`, `codec-missing`, `picture-damaged`, `picture-limit`.
    """
    width, height = _webp_size(bytes(data[:30]), where) if mime == "image/webp" else _open(data, mime, where).size
    if width > limits.MAX_SIDE or height > limits.MAX_STACKED or width * height > limits.MAX_TEXELS:
        raise FormatError("picture-limit", f"{width}x{height}, {limits.MAX_TEXELS} texels are allowed", where=where)
    return int(width), int(height)


def check_header(
    data: memoryview, mime: str, width: int, height: int, channels: int, where: str, count: int = 1, bits: int = 8
) -> None:
    """Hold a picture's header against the announced size. FormatError: as `dimensions`, and `picture-size`."""
    found, expected = dimensions(data, mime, where), picture_size(width, height, channels, count, bits)
    if found != expected:
        raise FormatError(
            "picture-size",
            f"the picture is {found[0]}x{found[1]}, {expected[0]}x{expected[1]} are announced",
            where=where,
        )


def decode(data: memoryview, mime: str, width: int, height: int, channels: int, where: str) -> Codes:
    """(height, width, channels) uint8 codes of a picture.

    FormatError: as `check_header`, and `picture-channels`.
    """
    check_header(data, mime, width, height, channels, where)
    image = _open(data, mime, where)
    grey_in_colour = mime in ("image/avif", "image/webp") and channels != 3  # they may decode grey to RGB
    modes = ("L", "RGB") if grey_in_colour else _MODES.get(channels, ("L",))
    if image.mode not in modes:
        raise FormatError("picture-channels", f"a picture of mode {image.mode}, {modes[0]} expected", where=where)
    pixels = _load(image, where)
    if pixels.shape[:2] != picture_size(width, height, channels)[::-1]:
        raise FormatError("picture-damaged", "decodes to another size than its header says", where=where)
    if channels == 3:
        return pixels
    grey = pixels if pixels.ndim == 2 else pixels[..., 0]
    return np.ascontiguousarray(grey.reshape(channels, height, width).transpose(1, 2, 0))


def decode_stack(
    data: memoryview, mime: str, width: int, height: int, channels: int, count: int, bits: int, where: str
) -> NDArray[Any]:
    """(count, height, width, channels) codes, uint8 or of 10 bits uint16, of a picture of `count` textures.

    FormatError: as `decode`.
    """
    if bits == 8 and channels == 3:
        return decode(data, mime, width, height * count, 3, where).reshape(count, height, width, 3)
    flat: NDArray[Any]
    if bits == 8:
        flat = decode(data, mime, width, height * channels * count, 1, where)[..., 0]
    else:
        check_header(data, mime, width, height, channels, where, count, bits)
        flat = deep.decode_deep(data, where)
        if flat.shape != (height * channels * count, width):
            raise FormatError("picture-damaged", "decodes to another size than its header says", where=where)
    return np.ascontiguousarray(flat.reshape(count, channels, height, width).transpose(0, 2, 3, 1))


def _open(data: memoryview, mime: str, where: str) -> ImageFile.ImageFile:
    """Parse a header with the one reader that `mime` names: Image.open would guess, and warn of large sizes."""
    if mime not in _READERS:
        raise FormatError("picture-type", f"pictures of type {mime!r} are not read", where=where)
    if mime in ("image/avif", "image/webp") and not features.check(mime.removeprefix("image/")):
        raise FormatError(
            "codec-missing",
            f"this Pillow cannot read {mime}",
            where=where,
            remedy="install a wheel of pillow 11.3 or later",
        )
    try:
        return _READERS[mime](io.BytesIO(data))
    except MemoryError:
        raise
    except Exception as error:  # a decoder on damaged bytes: Pillow raises whatever comes, none of it our bug
        raise _damaged(error, where) from error


def _load(image: ImageFile.ImageFile, where: str) -> NDArray[Any]:
    try:
        return np.asarray(image)
    except MemoryError:
        raise
    except Exception as error:  # as in _open
        raise _damaged(error, where) from error


def _damaged(error: Exception, where: str) -> FormatError:
    reason = " ".join(str(error).split())[:80] or type(error).__name__
    return FormatError("picture-damaged", f"the picture cannot be decoded: {reason}", where=where)


def _webp_size(head: bytes, where: str) -> tuple[int, int]:
    """Canvas size of a WebP (RFC 9649); libwebp's own reader would allocate the canvas first."""
    if len(head) >= 30 and head[:4] == b"RIFF" and head[8:12] == b"WEBP":
        if head[12:16] == b"VP8X":
            return int.from_bytes(head[24:27], "little") + 1, int.from_bytes(head[27:30], "little") + 1
        if head[12:16] == b"VP8L" and head[20] == 0x2F:
            bits = int.from_bytes(head[21:25], "little")
            return (bits & 0x3FFF) + 1, (bits >> 14 & 0x3FFF) + 1
        if head[12:16] == b"VP8 " and head[23:26] == b"\x9d\x01\x2a":
            width, height = struct.unpack_from("<HH", head, 26)
            return width & 0x3FFF, height & 0x3FFF
    raise FormatError("picture-damaged", "the picture cannot be decoded: no WebP header", where=where)
