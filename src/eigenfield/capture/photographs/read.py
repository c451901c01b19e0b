"""Photographs from files: PNG, JPEG, WebP, TIFF and AVIF, at their full depth, turned upright, in sRGB.

8 bit is decoded by Pillow; deeper PNG, TIFF and AVIF, which Pillow would cut to 8, by OpenCV from the same bytes.
"""

from __future__ import annotations

import io
import logging
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import AvifImagePlugin, Image, ImageCms, JpegImagePlugin, PngImagePlugin, TiffImagePlugin, WebPImagePlugin

from eigenfield.capture.photographs.icc import BrokenProfileError, read_profile
from eigenfield.core.errors import CaptureError

log = logging.getLogger(__name__)

PHOTOGRAPH_EXTENSIONS = (".png", ".jpg", ".jpeg", ".webp", ".tif", ".tiff", ".avif")
PHOTOGRAPH_MAX_PIXELS = 400_000_000  # a photograph of more pixels is refused before it is decoded
PHOTOGRAPH_HEAD_BYTES = 64 * 1024  # in which AVIF states its depth
EXIF_ORIENTATION_TAG = 0x0112
TIFF_DEPTH_TAG, TIFF_PHOTOMETRIC_TAG, TIFF_PLANES_TAG, TIFF_EXTRA_TAG = 258, 262, 284, 338
MASK_MIN_BRIGHTEST_FRACTION = 0.5  # of white, which the brightest pixel of a mask must reach

# what Pillow's decoders are known to raise on damaged bytes
DECODER_ERRORS = (
    OSError, SyntaxError, ValueError, EOFError, IndexError, KeyError, TypeError, RuntimeError, struct.error, zlib.error,
    Image.DecompressionBombError,
)  # fmt: skip


@dataclass(frozen=True)
class Header:
    """Properties of a photograph that are known without decoding it.

    Attributes:
        format: "PNG", "JPEG", "WebP", "TIFF" or "AVIF".
        width: As stored, before the orientation is applied, pixels.
        height: Likewise.
        depth: Bits a channel, 8, 10, 12 or 16.
        orientation: EXIF's, 1 to 8; 1 is as stored.
        alpha: Whether there is transparency.
    """

    format: str
    width: int
    height: int
    depth: int
    orientation: int
    alpha: bool

    @property
    def stored_size(self) -> tuple[int, int]:
        """Width and height as stored."""
        return self.width, self.height

    @property
    def upright_size(self) -> tuple[int, int]:
        """Width and height once the orientation is applied."""
        return (self.height, self.width) if self.orientation >= 5 else (self.width, self.height)


def read_header(path: Path) -> Header:
    """Format, size, depth and orientation of a photograph, without decoding it.

    Raises CaptureError: `image-missing`, `image-unreadable`, `image-kind` (no format or pixel type that is read),
    `image-too-large` (more than PIXEL_LIMIT pixels).
    """
    try:
        with path.open("rb") as file:
            name, image = _identify(file, path)
            return _make_header(name, image, file, path)
    except OSError as error:
        raise _open_error(path, error) from error


def decode(path: Path, upright: bool = True) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
    """A photograph as (H, W, 3) float32 sRGB-coded values in 0..1, and its alpha (H, W) or None.

    Args:
        path: The file.
        upright: Apply the EXIF orientation.

    Raises:
        CaptureError: As `read_header` does, and `image-truncated`.
    """
    values, profile = _decode_values(path, upright)
    colours = values[..., :3] if values.shape[2] >= 3 else np.repeat(values[..., :1], 3, axis=2)
    alpha = np.ascontiguousarray(values[..., -1]) if values.shape[2] in (2, 4) else None
    if profile is not None:
        colours = _to_srgb(colours, profile, values.shape[2] < 3, path)
    return np.ascontiguousarray(colours), alpha


def decode_mask(path: Path) -> NDArray[np.float32]:
    """A mask as (H, W) float32: 1 (white) where the photograph counts; transparent parts do not.

    Raises CaptureError as `decode`, and `mask-dark` where nothing is white though something is not black.
    """
    values, _ = _decode_values(path, True)
    grey = values[..., :3].mean(axis=2) if values.shape[2] >= 3 else values[..., 0]
    if values.shape[2] in (2, 4):
        grey = grey * values[..., -1]
    brightest = float(grey.max())
    if 0 < brightest < MASK_MIN_BRIGHTEST_FRACTION:
        raise CaptureError(
            "mask-dark",
            f"the mask's brightest value is {brightest * 255:.3g} of 255, so nothing would count",
            path=path,
            remedy="save it with 255 where the photograph counts and 0 elsewhere",
        )
    return np.ascontiguousarray(grey, dtype=np.float32)


def _open_error(path: Path, error: OSError) -> CaptureError:
    code = "image-missing" if isinstance(error, FileNotFoundError) else "image-unreadable"
    return CaptureError(
        code, error.strerror or "cannot be read", path=path, remedy="check the path and its permissions"
    )


def _unreadable_error(path: Path, why: str) -> CaptureError:
    return CaptureError(
        "image-unreadable", f"is damaged ({why})", path=path, remedy="copy it again, or take it out of the capture"
    )


def _decoder_error(path: Path, error: Exception) -> CaptureError:
    """The error for an exception of one of Pillow's decoders."""
    if isinstance(error, Image.DecompressionBombError):  # some plug-ins ask for Pillow's own limit all the same
        return CaptureError("image-too-large", _one_line(error), path=path, remedy="make it smaller")
    if "truncated" in str(error).lower():
        return CaptureError(
            "image-truncated", "is cut short", path=path, remedy="copy it again, or take it out of the capture"
        )
    return _unreadable_error(path, _one_line(error))


def _identify(file: Any, path: Path) -> tuple[str, Image.Image]:
    """Format by content, not by name, and Pillow's image, not decoded.

    The plug-ins are called directly: `Image.open` has a limit of its own, a global that is the caller's to set.
    """
    start = file.read(32)
    file.seek(0)
    try:
        if start.startswith(b"\x89PNG\r\n\x1a\n"):
            return "PNG", PngImagePlugin.PngImageFile(file)
        if start.startswith(b"\xff\xd8\xff"):
            return "JPEG", JpegImagePlugin.JpegImageFile(file)
        if start[:4] == b"RIFF" and start[8:12] == b"WEBP":
            return "WebP", WebPImagePlugin.WebPImageFile(file)
        if start[:4] in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"):
            return "TIFF", TiffImagePlugin.TiffImageFile(file)
        if start[4:8] == b"ftyp" and start[8:12] in (b"avif", b"avis", b"mif1", b"miaf"):
            return "AVIF", AvifImagePlugin.AvifImageFile(file)
    except DECODER_ERRORS as error:
        raise _decoder_error(path, error) from error
    if not start:
        raise _unreadable_error(path, "it is empty")
    raise CaptureError(
        "image-kind",
        "is no PNG, JPEG, WebP, TIFF or AVIF",
        path=path,
        remedy="convert it, or take it out of the capture",
    )


def _one_line(error: BaseException) -> str:
    text = str(error) or type(error).__name__
    return text.splitlines()[0][:120]


def _make_header(name: str, image: Image.Image, file: Any, path: Path) -> Header:
    """From an image that is not decoded yet: Pillow turns a TIFF, and forgets its orientation, on decoding."""
    width, height = image.size
    if width * height > PHOTOGRAPH_MAX_PIXELS:
        raise CaptureError(
            "image-too-large",
            f"is {width}x{height}, more than the {PHOTOGRAPH_MAX_PIXELS // 10**6} million pixels that are read",
            path=path,
            remedy="make it smaller",
        )
    if width < 1 or height < 1:
        raise _unreadable_error(path, f"its size is {width}x{height}")
    try:
        depth = 8
        if isinstance(image, TiffImagePlugin.TiffImageFile):
            depth = max(np.atleast_1d(image.tag_v2.get(TIFF_DEPTH_TAG, 1)).tolist())
            orientation = image.tag_v2.get(EXIF_ORIENTATION_TAG, 1)
        elif name == "PNG":
            depth = _read_at(file, 24, 1)[0]
            orientation = _png_orientation(file)
        else:
            orientation = image.getexif().get(EXIF_ORIENTATION_TAG, 1)
        if name == "AVIF":
            depth = _avif_depth(_read_at(file, 0, PHOTOGRAPH_HEAD_BYTES))
    except DECODER_ERRORS as error:
        raise _decoder_error(path, error) from error
    if orientation not in range(1, 9):
        orientation = 1
    if name == "TIFF" and orientation >= 5:
        width, height = height, width  # Pillow says the turned size
    return Header(name, width, height, max(8, depth), int(orientation), image.has_transparency_data)


def _png_orientation(file: Any) -> Any:
    """From the eXIf chunk, which may follow the pixels: Pillow would decode them to find it."""
    at = 8
    while len(start := _read_at(file, at, 8)) == 8:
        size, kind = struct.unpack(">I4s", start)
        if kind == b"eXIf" and size <= PHOTOGRAPH_HEAD_BYTES:
            exif = Image.Exif()
            exif.load(b"Exif\0\0" + _read_at(file, at + 8, size))
            return exif.get(EXIF_ORIENTATION_TAG, 1)
        at += 12 + size
    return 1


def _read_at(file: Any, offset: int, size: int) -> bytes:
    """Bytes of the file; its position is restored, since Pillow is reading it too."""
    place = file.tell()
    file.seek(offset)
    data: bytes = file.read(size)
    file.seek(place)
    return data


def _avif_depth(head: bytes) -> int:
    """The deepest of the AV1 configurations (av1C: third byte, bits 6 and 5 are high_bitdepth and twelve_bit)."""
    depth, at = 8, head.find(b"av1C")
    while 0 <= at <= len(head) - 8:
        flags = head[at + 6]
        depth = max(depth, 8 if not flags & 0x40 else 12 if flags & 0x20 else 10)
        at = head.find(b"av1C", at + 4)
    return depth


def _decode_values(path: Path, upright: bool) -> tuple[NDArray[np.float32], bytes | None]:
    """(H, W, 1 | 2 | 3 | 4) values in 0..1 as the file has them, and the ICC profile that is still to be applied."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise _open_error(path, error) from error
    file = io.BytesIO(data)
    name, image = _identify(file, path)
    header = _make_header(name, image, file, path)
    try:
        image.load()
        profile = image.info.get("icc_profile")
    except DECODER_ERRORS as error:
        raise _decoder_error(path, error) from error
    values = _decode_over_8bit(data, header, image, path) if header.depth > 8 else None
    if values is None:
        image, profile = _convert_8bit_mode(image, profile, path)
        values = np.asarray(image, dtype=np.float32) / np.float32(255)
    if values.ndim == 2:
        values = values[..., None]
    # TIFF comes turned already, from both decoders
    wanted = header.orientation if upright else 1
    if name == "TIFF":
        wanted = 1 if upright else {6: 8, 8: 6}.get(header.orientation, header.orientation)
    return _apply_orientation(values, wanted), profile


def _apply_orientation(values: NDArray[np.float32], orientation: int) -> NDArray[np.float32]:
    """EXIF orientation applied: 2 to 4 mirrored and upside down, 5 to 8 with rows and columns exchanged."""
    if orientation >= 5:
        values = values.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        values = values[:, ::-1]
    if orientation in (3, 4, 7, 8):
        values = values[::-1]
    return np.ascontiguousarray(values)


def _decode_over_8bit(data: bytes, header: Header, image: Image.Image, path: Path) -> NDArray[np.float32] | None:
    """More than 8 bit a channel, by OpenCV; None where OpenCV cannot, so that 8 bit are read."""
    tiff = image.tag_v2 if isinstance(image, TiffImagePlugin.TiffImageFile) else None
    if tiff is not None and (
        header.depth != 16 or tiff.get(TIFF_PLANES_TAG, 1) != 1 or tiff.get(TIFF_PHOTOMETRIC_TAG) not in (0, 1, 2)
    ):
        raise CaptureError(
            "image-kind",
            f"is a TIFF of {header.depth} bit with planes apart or of an unusual colour space",
            path=path,
            remedy="save it as RGB, 8 or 16 bit, chunky",
        )
    try:
        stored = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error as error:
        raise _unreadable_error(path, _one_line(error)) from error
    if stored is None or stored.dtype != np.uint16:
        log.warning("%s: its %d bits cannot be had here, read at 8 bit", path, header.depth)
        return None
    values = stored.astype(np.float32) / np.float32((1 << header.depth) - 1)
    if values.ndim == 3 and values.shape[2] >= 3:
        values[..., :3] = values[..., 2::-1]  # OpenCV has blue first
    if tiff is not None and tiff.get(TIFF_PHOTOMETRIC_TAG) == 0:  # white is zero
        values = 1 - values
    is_premultiplied = tiff is not None and 1 in np.atleast_1d(tiff.get(TIFF_EXTRA_TAG, 0))
    if is_premultiplied and values.shape[2] == 4:
        np.divide(values[..., :3], values[..., 3:], out=values[..., :3], where=values[..., 3:] > 0)
        np.clip(values, 0, 1, out=values)
    return values


def _convert_8bit_mode(image: Image.Image, profile: bytes | None, path: Path) -> tuple[Image.Image, bytes | None]:
    """Any 8-bit image as L, LA, RGB or RGBA, and the profile if it is still to be applied."""
    if image.mode in ("CMYK", "LAB"):
        return _print_colours_to_srgb(image, profile, path), None
    if image.mode in ("I", "F", "HSV") or image.mode.startswith("I;"):
        raise CaptureError(
            "image-kind",
            f"has pixels of a kind that is not read ({image.mode})",
            path=path,
            remedy="save it as 8- or 16-bit RGB",
        )
    if (image.mode in ("L", "RGB") and not image.has_transparency_data) or image.mode in ("LA", "RGBA"):
        return image, profile
    if image.mode == "1":
        return image.convert("L"), profile
    return image.convert("RGBA" if image.has_transparency_data else "RGB"), profile


def _print_colours_to_srgb(image: Image.Image, profile: bytes | None, path: Path) -> Image.Image:
    """CMYK (and Lab) to sRGB: through the profile if there is one that fits, else by the plain formula."""
    if image.mode == "LAB":
        return _apply_profile(image, ImageCms.createProfile("LAB"))
    if profile is not None:
        try:
            return _apply_profile(image, ImageCms.ImageCmsProfile(io.BytesIO(profile)))
        except (ImageCms.PyCMSError, OSError) as error:
            log.warning("%s: its colour profile cannot be used (%s): plain CMYK is taken", path, _one_line(error))
    return image.convert("RGB")


def _apply_profile(image: Image.Image, profile: Any) -> Image.Image:
    srgb = ImageCms.createProfile("sRGB")
    converted = ImageCms.profileToProfile(
        image, profile, srgb, renderingIntent=ImageCms.Intent.RELATIVE_COLORIMETRIC, outputMode="RGB"
    )
    assert converted is not None
    return converted


def _to_srgb(colours: NDArray[np.float32], data: bytes, grey: bool, path: Path) -> NDArray[np.float32]:
    """(H, W, 3) through an ICC profile; one that is broken or of another colour space is ignored, with a warning."""
    try:
        profile = read_profile(data)
    except BrokenProfileError as error:
        log.warning("%s: its colour profile is broken (%s) and ignored", path, error)
        return colours
    if profile.space not in (("GRAY", "RGB ") if grey else ("RGB ",)):
        log.warning("%s: its colour profile is for %s and ignored", path, profile.space.strip())
        return colours
    if profile.kind != "tables":
        return profile.apply(colours)
    return _apply_table_profile(colours, data, profile.space, path)


def _apply_table_profile(colours: NDArray[np.float32], data: bytes, space: str, path: Path) -> NDArray[np.float32]:
    eight = np.rint(colours * 255).astype(np.uint8)
    image = Image.fromarray(eight) if space == "RGB " else Image.fromarray(eight[..., 0])
    try:
        converted = _apply_profile(image, ImageCms.ImageCmsProfile(io.BytesIO(data)))
    except (ImageCms.PyCMSError, OSError) as error:
        log.warning("%s: its colour profile cannot be used (%s) and is ignored", path, _one_line(error))
        return colours
    if not np.array_equal(eight, colours * 255):
        log.warning("%s: its colour profile has tables: converted at 8 bit", path)
    return np.asarray(converted, dtype=np.float32) / np.float32(255)
