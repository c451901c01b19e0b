"""Photographs from files of every kind, at their full depth, turned upright, in sRGB.

8 bit is decoded by Pillow, and JPEG by simplejpeg; deeper PNG, TIFF and AVIF, which Pillow would cut to 8, by OpenCV
from the same bytes. Pillow's plug-ins for HEIC and JPEG XL are wheels of their own.
"""

from __future__ import annotations

import io
import logging
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import AvifImagePlugin, Image, ImageCms, JpegImagePlugin, PngImagePlugin, TiffImagePlugin, WebPImagePlugin

from eigenfield.capture.photographs.colour import Profile, encode_srgb
from eigenfield.capture.photographs.exr import EXR_MAGIC, decode_exr, read_exr_header
from eigenfield.capture.photographs.header import (
    DECODER_ERRORS,
    EXIF_ORIENTATION_TAG,
    PHOTOGRAPH_HEAD_BYTES,
    Header,
    decoder_error,
    missing_module_error,
    one_line,
    open_error,
    read_at,
    refuse_size,
    unreadable_error,
)
from eigenfield.capture.photographs.icc import BrokenProfileError, read_profile
from eigenfield.capture.photographs.jpeg import decode_jpeg
from eigenfield.capture.photographs.jxl import JXL_CODESTREAM, JXL_CONTAINER, read_jxl_header
from eigenfield.capture.photographs.kinds import PHOTOS_REMEDY, RAW_EXTENSIONS
from eigenfield.capture.photographs.png import PNG_SIGNATURE, read_png_orientation, without_notes
from eigenfield.capture.photographs.raw import decode_raw, read_raw_header
from eigenfield.capture.photographs.stated import read_stated_colours
from eigenfield.capture.photographs.tiff import (
    TIFF_DEPTH_TAG,
    TIFF_EXTRA_TAG,
    TIFF_PHOTOMETRIC_TAG,
    TIFF_PLANES_TAG,
    read_tiff_tags,
    refuse_tiff_damage,
    refuse_tiff_kind,
)
from eigenfield.core.errors import CaptureError

log = logging.getLogger(__name__)

FORMAT_HEAD_BYTES = 64  # by which a format is recognised
AVIF_BRANDS = (b"avif", b"avis")
HEIF_BRANDS = (b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"hevm", b"hevs", b"mif1", b"msf1", b"miaf")
PANORAMA_MARKS = (b"GPano:ProjectionType", b"GPano:FullPanoWidthPixels", b"GPano:CroppedAreaImageWidthPixels")
LOW_DEPTHS = (8, 10, 12)  # of values that a photograph of 16 bit has only by mistake
MASK_MIN_BRIGHTEST_FRACTION = 0.5  # of white, which the brightest pixel of a mask must reach


def read_header(path: Path) -> Header:
    """Format, size, depth and orientation of a photograph, without decoding it.

    Raises CaptureError: `image-missing`, `image-unreadable`, `image-kind` (no format or pixel type that is read),
    `image-too-large` (more than PHOTOGRAPH_MAX_PIXELS pixels).
    """
    try:
        with path.open("rb") as file:
            name = format_of(path, read_at(file, 0, FORMAT_HEAD_BYTES))
            if name == "RAW":
                return read_raw_header(path)
            if name == "EXR":
                return read_exr_header(path)
            if name == "JPEG XL":
                return _jxl_header(file, path)
            name, image = open_picture(file, path)
            return _make_header(name, image, file, path)
    except OSError as error:
        raise open_error(path, error) from error


def decode(
    path: Path, upright: bool = True, exposure: float | None = None
) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
    """A photograph as (H, W, 3) float32 sRGB-coded values in 0..1, and its alpha (H, W) or None.

    Args:
        upright: Apply the EXIF orientation.
        exposure: Factor of linear values (OpenEXR) before the sRGB curve; None for 1.

    Raises:
        CaptureError: As `read_header` does, and `image-truncated`.
    """
    values, profile, is_linear = _decode_values(path, upright)
    colours = values[..., :3] if values.shape[2] >= 3 else np.repeat(values[..., :1], 3, axis=2)
    alpha = np.ascontiguousarray(values[..., -1]) if values.shape[2] in (2, 4) else None
    if is_linear:
        colours = encode_srgb(colours * np.float32(1.0 if exposure is None else exposure))
    elif isinstance(profile, Profile):
        colours = profile.apply(colours)
    elif profile is not None:
        colours = _to_srgb(colours, profile, values.shape[2] < 3, path)
    return np.ascontiguousarray(colours), alpha


def decode_mask(path: Path) -> NDArray[np.float32]:
    """A mask as (H, W) float32: 1 (white) where the photograph counts; transparent parts do not.

    Raises CaptureError as `decode`, and `mask-dark` where nothing is white though something is not black.
    """
    values = np.clip(_decode_values(path, True)[0], 0, 1)
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


def open_picture(file: Any, path: Path) -> tuple[str, Image.Image]:
    """Format by content, not by name, and Pillow's image, not decoded but for JPEG XL, whose plug-in decodes at once.

    The plug-ins are called directly: `Image.open` has a limit of its own, a global that is the caller's to set.

    Raises CaptureError: `image-unreadable`, `image-truncated`, `image-kind`, `image-too-large`.
    """
    name = format_of(path, read_at(file, 0, FORMAT_HEAD_BYTES))
    try:
        if name == "PNG":
            return name, _open_png(file)
        if name == "JPEG":
            return name, JpegImagePlugin.JpegImageFile(file)
        if name == "WebP":
            return name, WebPImagePlugin.WebPImageFile(file)
        if name == "TIFF":
            return name, _open_tiff(file, path)
        if name == "AVIF":
            return name, AvifImagePlugin.AvifImageFile(file)
        if name == "HEIC":
            return name, _open_heic(file, path)
        if name == "JPEG XL":
            return name, _open_jxl(file, path)
    except DECODER_ERRORS as error:
        raise decoder_error(path, error) from error
    if not read_at(file, 0, 1):
        raise unreadable_error(path, "it is empty")
    raise CaptureError(
        "image-kind",
        "is no PNG, JPEG, WebP, TIFF, AVIF, HEIC, JPEG XL, RAW or OpenEXR",
        path=path,
        remedy="convert it, or take it out of the capture",
    )


def format_of(path: Path, start: bytes) -> str | None:
    """The format of a file that begins so; None for one that is not read. RAW is known by its name: most are TIFF with
    a small picture."""
    if start and path.suffix.lower() in RAW_EXTENSIONS:
        return "RAW"
    if start.startswith(EXR_MAGIC):
        return "EXR"
    if start.startswith(PNG_SIGNATURE):
        return "PNG"
    if start.startswith(b"\xff\xd8\xff"):
        return "JPEG"
    if start[:4] == b"RIFF" and start[8:12] == b"WEBP":
        return "WebP"
    if start[:4] in (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"):
        return "TIFF"
    if start.startswith((JXL_CODESTREAM, JXL_CONTAINER)):
        return "JPEG XL"
    if start[4:8] == b"ftyp":
        brands = start[8:12], *(start[at : at + 4] for at in range(16, min(start[3], 64), 4))
        if any(brand in AVIF_BRANDS for brand in brands):
            return "AVIF"
        if brands[0] in HEIF_BRANDS:
            return "HEIC"
    return None


def _open_png(file: Any) -> Image.Image:
    try:
        return PngImagePlugin.PngImageFile(file)
    except DECODER_ERRORS:
        file.seek(0)
        data = file.read()
        sound = without_notes(data)
        if sound is data:
            raise
        return PngImagePlugin.PngImageFile(io.BytesIO(sound))


def _open_tiff(file: Any, path: Path) -> Image.Image:
    try:
        image = TiffImagePlugin.TiffImageFile(file)
    except DECODER_ERRORS:  # Pillow takes a kind that it does not know for damage
        refuse_tiff_kind(read_tiff_tags(file), path)
        raise
    refuse_tiff_kind(image.tag_v2, path)
    return image


def _open_heic(file: Any, path: Path) -> Image.Image:
    """Pillow's image, turned by the decoder as HEIC's own properties say; EXIF's orientation does not count."""
    try:
        from pi_heif.as_plugin import HeifImageFile
    except ImportError as error:
        raise missing_module_error(path, "HEIC", PHOTOS_REMEDY) from error
    head = read_at(file, 0, PHOTOGRAPH_HEAD_BYTES)
    at = head.find(b"ispe")  # a box of each item's size: what is decoded may be larger than what is shown
    while 0 <= at <= len(head) - 16:
        width, height = struct.unpack(">II", head[at + 8 : at + 16])
        refuse_size(width, height, path)
        at = head.find(b"ispe", at + 4)
    image: Image.Image = HeifImageFile(file)
    return image


def _open_jxl(file: Any, path: Path) -> Image.Image:
    try:
        from pillow_jxl.JpegXLImagePlugin import JXLImageFile
    except ImportError as error:
        raise missing_module_error(path, "JPEG XL", PHOTOS_REMEDY) from error
    _jxl_header(file, path)
    image: Image.Image = JXLImageFile(file)
    return image


def _jxl_header(file: Any, path: Path) -> Header:
    """Whether there is transparency is not known before it is decoded."""
    try:
        found = read_jxl_header(file)
    except DECODER_ERRORS as error:
        raise decoder_error(path, error) from error
    refuse_size(found.width, found.height, path)
    header = Header("JPEG XL", found.width, found.height, 8, found.orientation, False)
    width, height = header.upright_size
    return header if found.jpeg else replace(header, width=width, height=height, orientation=1)  # turned by the decoder


def _make_header(name: str, image: Image.Image, file: Any, path: Path) -> Header:
    """From an image that is not decoded yet: Pillow turns a TIFF, and forgets its orientation, on decoding."""
    if name == "JPEG XL":
        return _jxl_header(file, path)
    width, height = image.size
    refuse_size(width, height, path)
    try:
        depth = 8
        if isinstance(image, TiffImagePlugin.TiffImageFile):
            depth = max(np.atleast_1d(image.tag_v2.get(TIFF_DEPTH_TAG, 1)).tolist())
            orientation = image.tag_v2.get(EXIF_ORIENTATION_TAG, 1)
        elif name == "PNG":
            depth = read_at(file, 24, 1)[0]
            orientation = read_png_orientation(file)
        else:
            orientation = image.getexif().get(EXIF_ORIENTATION_TAG, 1)
        if name == "AVIF":
            depth = _avif_depth(read_at(file, 0, PHOTOGRAPH_HEAD_BYTES))
        if name == "HEIC":
            depth = image.info.get("bit_depth", 8)
    except DECODER_ERRORS as error:
        raise decoder_error(path, error) from error
    if orientation not in range(1, 9):
        orientation = 1
    if name == "TIFF" and orientation >= 5:
        width, height = height, width  # Pillow says the turned size
    panorama = _says_panorama(image)
    return Header(name, width, height, max(8, depth), int(orientation), image.has_transparency_data, panorama)


def _says_panorama(image: Image.Image) -> bool:
    """Whether the XMP has Google's tags of a panorama, which phones, 360-degree cameras and stitchers write."""
    found = image.info.get("xmp") or image.info.get("XML:com.adobe.xmp") or b""
    text = found.encode("utf-8", "replace") if isinstance(found, str) else bytes(found)
    return any(mark in text for mark in PANORAMA_MARKS)


def _avif_depth(head: bytes) -> int:
    """The deepest of the AV1 configurations (av1C: third byte, bits 6 and 5 are high_bitdepth and twelve_bit)."""
    depth, at = 8, head.find(b"av1C")
    while 0 <= at <= len(head) - 8:
        flags = head[at + 6]
        depth = max(depth, 8 if not flags & 0x40 else 12 if flags & 0x20 else 10)
        at = head.find(b"av1C", at + 4)
    return depth


def _decode_values(path: Path, upright: bool) -> tuple[NDArray[np.float32], bytes | Profile | None, bool]:
    """(H, W, 1 | 2 | 3 | 4) values as the file has them, the profile that is still to be applied (ICC's bytes, or one
    stated otherwise), and whether they are linear; others are in 0..1."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise open_error(path, error) from error
    kind = format_of(path, data[:FORMAT_HEAD_BYTES])
    if kind == "EXR":
        return decode_exr(path), None, True
    if kind == "RAW":
        pixels, header = decode_raw(path)
        return _apply_orientation(pixels, header.orientation if upright else 1), None, False
    if kind == "PNG":
        data = without_notes(data)
    file = io.BytesIO(data)
    name, image = open_picture(file, path)
    header = _make_header(name, image, file, path)
    stated, narrow = read_stated_colours(name, data, image, header.depth, path)
    jpeg = decode_jpeg(data, image.mode, image.size, path) if name == "JPEG" else None
    try:
        if jpeg is None:
            image.load()
        icc: bytes | None = image.info.get("icc_profile")
    except DECODER_ERRORS as error:
        raise decoder_error(path, error) from error
    if isinstance(image, TiffImagePlugin.TiffImageFile):
        refuse_tiff_damage(data, image.tag_v2, image.mode, path)
    profile = icc if stated is None else stated
    if name == "HEIC" and image.size != (header.width, header.height):  # the decoder corrects what the file says
        raise unreadable_error(path, f"it says {header.width}x{header.height} pixels and has {image.size}")
    values = _decode_over_8bit(data, header, image, path) if header.depth > 8 else None
    if values is None:
        if image.mode in ("CMYK", "LAB"):
            image, profile = _print_colours_to_srgb(image, icc, path), None
        eight = _convert_8bit_mode(image, path) if jpeg is None else jpeg
        values = np.asarray(eight, dtype=np.float32) / np.float32(255)
    if values.ndim == 2:
        values = values[..., None]
    if narrow:
        colours = values[..., : 1 if values.shape[2] < 3 else 3]
        colours[...] = (colours * 255 - 16) / 219  # of 16 bit, too, but for 1/257 of a grey level
    # TIFF comes turned already, from both decoders
    wanted = header.orientation if upright else 1
    if name == "TIFF":
        wanted = 1 if upright else {6: 8, 8: 6}.get(header.orientation, header.orientation)
    return _apply_orientation(values, wanted), profile, False


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
    """More than 8 bit a channel, by OpenCV or libheif; None where OpenCV cannot, so that 8 bit are read."""
    if header.format == "HEIC":
        return _decode_deep_heic(data, header, path)
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
        raise unreadable_error(path, one_line(error)) from error
    if stored is None or stored.dtype != np.uint16:
        log.warning("%s: its %d bits cannot be had here, read at 8 bit", path, header.depth)
        return None
    if header.depth == 16:
        _name_low_values(stored, path)
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


def _name_low_values(stored: NDArray[Any], path: Path) -> None:
    """Say that 16 bit hold values of fewer, as cameras of machines store them, which viewers show as black."""
    top = int(stored[..., :3].max() if stored.ndim == 3 else stored.max())
    bits = next((bits for bits in LOW_DEPTHS if 0 < top < 1 << bits), 14 if top == (1 << 14) - 1 else None)
    if bits is not None:
        log.warning(
            "%s: its greatest value is %d of 65535, as where %d bit lie in 16: save it with its values times %d if so",
            path, top, bits, 1 << (16 - bits),
        )  # fmt: skip


def _decode_deep_heic(data: bytes, header: Header, path: Path) -> NDArray[np.float32]:
    import pi_heif

    try:
        found = pi_heif.open_heif(io.BytesIO(data), convert_hdr_to_8bit=False, hdr_to_16bit=False)
        return np.asarray(found).astype(np.float32) / np.float32((1 << header.depth) - 1)
    except DECODER_ERRORS as error:
        raise decoder_error(path, error) from error


def _convert_8bit_mode(image: Image.Image, path: Path) -> Image.Image:
    """Any 8-bit image as L, LA, RGB or RGBA."""
    if image.mode in ("I", "F", "HSV") or image.mode.startswith("I;"):
        raise CaptureError(
            "image-kind",
            f"has pixels of a kind that is not read ({image.mode})",
            path=path,
            remedy="save it as 8- or 16-bit RGB",
        )
    if (image.mode in ("L", "RGB") and not image.has_transparency_data) or image.mode in ("LA", "RGBA"):
        return image
    if image.mode == "1":
        return image.convert("L")
    return image.convert("RGBA" if image.has_transparency_data else "RGB")


def _print_colours_to_srgb(image: Image.Image, profile: bytes | None, path: Path) -> Image.Image:
    """CMYK (and Lab) to sRGB: through the profile if there is one that fits, else by the plain formula."""
    if image.mode == "LAB":
        return _apply_profile(image, ImageCms.createProfile("LAB"))
    if profile is not None:
        try:
            return _apply_profile(image, ImageCms.ImageCmsProfile(io.BytesIO(profile)))
        except (ImageCms.PyCMSError, OSError) as error:
            log.warning("%s: its colour profile cannot be used (%s): plain CMYK is taken", path, one_line(error))
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
        log.warning("%s: its colour profile cannot be used (%s) and is ignored", path, one_line(error))
        return colours
    if not np.array_equal(eight, colours * 255):
        log.warning("%s: its colour profile has tables: converted at 8 bit", path)
    return np.asarray(converted, dtype=np.float32) / np.float32(255)
