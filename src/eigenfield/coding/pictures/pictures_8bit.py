"""Pictures of 8-bit codes: PNG and WebP (lossless), AVIF (lossy); a JPEG for viewers that know nothing of us.

No profile, no orientation: the stored numbers are the codes. `stacking` lays out channels and textures in a picture.
"""

from __future__ import annotations

import io
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import AvifImagePlugin, Image, ImageFile, JpegImagePlugin, PngImagePlugin, WebPImagePlugin, features

from eigenfield.coding.pictures.pictures_10bit import decoder_errors
from eigenfield.core.errors import FormatError, OptionError

Codes = NDArray[np.uint8]

AVIF_SPEED = 6  # Tarot, 16 pictures of 1024 x 1024: 3 s; 5 saves 8 % of the bytes and takes 13 s, 4 saves no more
PREVIEW_MAX_SIDE_TEXELS = 512
PREVIEW_QUALITY = 85
JFIF_BYTES = 18  # of the header that a JPEG need not have
_WEBP_MAX_SIDE_TEXELS = 16_383
_READERS: dict[str, type[ImageFile.ImageFile]] = {
    "image/png": PngImagePlugin.PngImageFile,
    "image/jpeg": JpegImagePlugin.JpegImageFile,
    "image/webp": WebPImagePlugin.WebPImageFile,
    "image/avif": AvifImagePlugin.AvifImageFile,
}


def encode_png(picture: Codes, quality: int) -> bytes:
    """A PNG by one thread, the same bytes each time.

    Args:
        picture: (H, W) or (H, W, 3) codes.
        quality: Not used: a PNG is lossless.
    """
    return _image_bytes(Image.fromarray(picture), "PNG", compress_level=9)


def encode_webp(picture: Codes, quality: int) -> bytes:
    """As `encode_png`. OptionError `codec-side`, a side is longer than WebP's."""
    image = Image.fromarray(picture)
    if max(image.size) > _WEBP_MAX_SIDE_TEXELS:
        message = f"webp holds {_WEBP_MAX_SIDE_TEXELS} texels a side, {max(image.size)} needed"
        raise OptionError("codec-side", message, remedy="use png")
    return _image_bytes(image, "WEBP", lossless=True, quality=80, method=4)


def encode_avif(picture: Codes, quality: int) -> bytes:
    """As `encode_png`, lossy, of a quality of 0 to 100."""
    image = Image.fromarray(picture)
    return _image_bytes(
        image,
        "AVIF",
        quality=quality,
        speed=AVIF_SPEED,
        subsampling="4:4:4" if image.mode == "RGB" else "4:0:0",
        range="full",
        max_threads=1,
        autotiling=False,  # tiles would follow the threads
        advanced={"tune": "psnr", "deltaq-mode": "0"},  # squared error, not looks: textures are summed
    )


def encode_preview(picture: Codes) -> bytes:
    """(H, W) or (H, W, 3) codes as a JPEG of at most PREVIEW_MAX_SIDE_TEXELS on the longer side."""
    image = _shrunk(Image.fromarray(picture), PREVIEW_MAX_SIDE_TEXELS)
    return _image_bytes(image, "JPEG", quality=PREVIEW_QUALITY, optimize=True)


def encode_small_preview(picture: Codes, side: int, quality: int) -> bytes:
    """As `encode_preview`, of at most `side` texels, with one table for luma and chroma and no JFIF header: both take
    87 bytes."""
    image = _shrunk(Image.fromarray(picture), side)
    sample = JpegImagePlugin.JpegImageFile(io.BytesIO(_image_bytes(Image.new("L", (8, 8)), "JPEG", quality=quality)))
    data = _image_bytes(image, "JPEG", qtables=[sample.quantization[0]], optimize=True)
    return data[:2] + data[2 + JFIF_BYTES :]


def encode_masked_preview(picture: Codes, opacity: Codes, side: int, colours: int) -> bytes:
    """A PNG of at most `side` texels on the longer side: fully transparent where less than half opaque, else opaque.

    Args:
        picture: (H, W) or (H, W, 3) codes.
        opacity: (h, w) codes.
        colours: In its palette, that of transparent texels among them.
    """
    alpha = Image.fromarray(opacity).resize(picture.shape[1::-1], Image.Resampling.BILINEAR)
    image = Image.fromarray(picture).convert("RGBA")
    image.putalpha(alpha)
    pixels = np.asarray(_shrunk(image, side))
    opaque = pixels[..., 3] >= 128
    middle = pixels[opaque, :3].mean(axis=0) if opaque.any() else np.zeros(3)
    filled = np.where(opaque[..., None], pixels[..., :3], np.rint(middle).astype(np.uint8))
    reduced = Image.fromarray(filled).quantize(colours - 1, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    paletted = Image.fromarray(np.where(opaque, np.asarray(reduced) + 1, 0).astype(np.uint8), "P")
    paletted.putpalette([*map(int, np.rint(middle)), *(reduced.getpalette() or [])[: 3 * (colours - 1)]])
    return _image_bytes(paletted, "PNG", transparency=0, optimize=True)


def _shrunk(image: Image.Image, side: int) -> Image.Image:
    """At most `side` texels on the longer side."""
    scale = min(1.0, side / max(image.size))
    size = (max(1, round(image.width * scale)), max(1, round(image.height * scale)))
    if size != image.size:
        image = image.resize(size, Image.Resampling.LANCZOS)
    return image


def _image_bytes(image: Image.Image, format: str, **options: Any) -> bytes:
    buffer = io.BytesIO()
    image.save(buffer, format, **options)
    return buffer.getvalue()


def header_size(data: memoryview, where: str, *, mime: str) -> tuple[int, int]:
    """Width and height from a picture's header alone; nothing is decoded or allocated. FormatError `codec-missing`,
    `picture-damaged`."""
    return _webp_size(bytes(data[:30]), where) if mime == "image/webp" else _open(data, mime, where).size


def decode_picture(data: memoryview, colour: bool, where: str, *, mime: str) -> Codes:
    """(H, W, 3) codes of a picture of colours, (H, W) of a grey one.

    Raises:
        FormatError: As `header_size`, and `picture-channels`.
    """
    image = _open(data, mime, where)
    grey_in_colour = mime in ("image/avif", "image/webp")  # they may decode grey to RGB
    modes = ("RGB",) if colour else ("L", "RGB") if grey_in_colour else ("L",)
    if image.mode not in modes:
        raise FormatError("picture-channels", f"a picture of mode {image.mode}, {modes[0]} expected", where=where)
    with decoder_errors("picture", where):
        pixels = np.asarray(image)
    return pixels if colour or pixels.ndim == 2 else pixels[..., 0]


def check_preview(data: memoryview, mime: str, where: str) -> None:
    """Decode a picture for other viewers, which may be grey and have a palette and alpha."""
    image = _open(data, mime, where)
    if image.mode not in ("L", "LA", "P", "RGB", "RGBA"):
        raise FormatError("picture-channels", f"a picture of mode {image.mode}, RGB expected", where=where)
    with decoder_errors("picture", where):
        image.load()


def _open(data: memoryview, mime: str, where: str) -> ImageFile.ImageFile:
    """Parse a header with the one reader that `mime` names: Image.open would guess, and warn of large sizes."""
    if mime in ("image/avif", "image/webp") and not features.check(mime.removeprefix("image/")):
        remedy = "install a wheel of pillow 11.3 or later"
        raise FormatError("codec-missing", f"this Pillow cannot read {mime}", where=where, remedy=remedy)
    with decoder_errors("picture", where):
        image = _READERS[mime](io.BytesIO(data))
    return image


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
