"""What is known of a photograph without decoding it, and the errors of reading one."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PIL import Image

from eigenfield.core.errors import CaptureError

EXIF_ORIENTATION_TAG = 0x0112
PHOTOGRAPH_HEAD_BYTES = 64 * 1024  # in which AVIF and HEIC state their depth, sizes and colours
PHOTOGRAPH_MAX_PIXELS = 400_000_000  # a photograph of more pixels is refused before it is decoded

# what Pillow's decoders are known to raise on damaged bytes
DECODER_ERRORS = (
    OSError, SyntaxError, ValueError, EOFError, IndexError, KeyError, TypeError, RuntimeError, struct.error, zlib.error,
    Image.DecompressionBombError,
)  # fmt: skip


@dataclass(frozen=True)
class Header:
    """Properties of a photograph that are known without decoding it.

    Attributes:
        format: "PNG", "JPEG", "WebP", "TIFF", "AVIF", "HEIC" or "JPEG XL".
        width: As stored, before the orientation is applied, pixels.
        depth: Bits a channel, 8, 10, 12 or 16.
        orientation: EXIF's, 1 to 8; 1 is as stored.
        alpha: Whether there is transparency.
        panorama: Whether its metadata say that it is a panorama.
    """

    format: str
    width: int
    height: int
    depth: int
    orientation: int
    alpha: bool
    panorama: bool = False

    @property
    def stored_size(self) -> tuple[int, int]:
        """Width and height as stored."""
        return self.width, self.height

    @property
    def upright_size(self) -> tuple[int, int]:
        """Width and height once the orientation is applied."""
        return (self.height, self.width) if self.orientation >= 5 else (self.width, self.height)


def refuse_size(width: int, height: int, path: Path) -> None:
    """Raise CaptureError for a size that no photograph has: `image-too-large`, `image-unreadable`."""
    if width * height > PHOTOGRAPH_MAX_PIXELS:
        raise CaptureError(
            "image-too-large",
            f"is {width}x{height}, more than the {PHOTOGRAPH_MAX_PIXELS // 10**6} million pixels that are read",
            path=path,
            remedy="make it smaller",
        )
    if width < 1 or height < 1:
        raise unreadable_error(path, f"its size is {width}x{height}")


def open_error(path: Path, error: OSError) -> CaptureError:
    """The error for a file that cannot be opened: `image-missing`, `image-unreadable`."""
    code = "image-missing" if isinstance(error, FileNotFoundError) else "image-unreadable"
    return CaptureError(
        code, error.strerror or "cannot be read", path=path, remedy="check the path and its permissions"
    )


def unreadable_error(path: Path, why: str) -> CaptureError:
    """The error `image-unreadable` for damaged bytes."""
    return CaptureError(
        "image-unreadable", f"is damaged ({why})", path=path, remedy="copy it again, or take it out of the capture"
    )


def decoder_error(path: Path, error: Exception) -> CaptureError:
    """The error for an exception of a decoder."""
    if isinstance(error, Image.DecompressionBombError):  # some plug-ins ask for Pillow's own limit all the same
        return CaptureError("image-too-large", one_line(error), path=path, remedy="make it smaller")
    if "truncated" in str(error).lower():
        return truncated_error(path)
    return unreadable_error(path, one_line(error))


def truncated_error(path: Path) -> CaptureError:
    """The error `image-truncated`."""
    return CaptureError(
        "image-truncated", "is cut short", path=path, remedy="copy it again, or take it out of the capture"
    )


def missing_module_error(path: Path, what: str, remedy: str) -> CaptureError:
    """The error `image-kind` for a photograph that needs a module which is not installed."""
    return CaptureError("image-kind", f"is {what}, which is not read without another package", path=path, remedy=remedy)


def one_line(error: BaseException) -> str:
    """The first line of what an exception says."""
    text = str(error) or type(error).__name__
    return text.splitlines()[0][:120]


def read_at(file: Any, offset: int, size: int) -> bytes:
    """Bytes of the file; its position is restored, since a decoder is reading it too."""
    place = file.tell()
    file.seek(offset)
    data: bytes = file.read(size)
    file.seek(place)
    return data
