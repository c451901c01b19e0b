"""Pixels and mask of a photograph, whose size must be that with which its capture was opened."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photographs.read import decode, decode_mask
from eigenfield.core.errors import CaptureError


class PixelSource(Protocol):
    """Pixels that are not simply those of a file: of a film, or of a frame that stands in for another."""

    def decode(self) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
        """(H, W, 3) sRGB-coded pixels of 0..1, and (H, W) how far they count; None where all do."""

    def identity(self) -> list[int]:
        """Which they are of what the source's file holds."""


class PhotographSource(Protocol):
    """What a photograph is read from, whether or not its camera is known: a `View` or a `Shot`.

    Attributes:
        name: Unique in the capture: the file's name, or its relative path where file names alone are not unique.
        path: The picture's file.
        lens: The distortion that is removed on reading; None where there is none.
        mask: A mask's file, white where the photograph counts.
        upright: Whether the photograph's EXIF orientation is applied on reading.
        exposure: Factor of linear values before the sRGB curve; None where the file's values are coded.
        reduction: A pixel is the mean of this many by this many pixels of the file.
        picture: What gives the pixels; None: the file.
    """

    @property
    def name(self) -> str: ...
    @property
    def path(self) -> Path: ...
    @property
    def lens(self) -> Lens | None: ...
    @property
    def mask(self) -> Path | None: ...
    @property
    def upright(self) -> bool: ...
    @property
    def exposure(self) -> float | None: ...
    @property
    def reduction(self) -> int: ...
    @property
    def picture(self) -> PixelSource | None: ...


def decode_with_mask(
    source: PhotographSource, width: int, height: int
) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
    """Decode a photograph with its mask.

    Args:
        width: As the capture was opened and reduced, pixels.

    Returns:
        (H, W, 3) pixels, and (H, W) the lesser of alpha and mask; None where there is neither.

    Raises:
        CaptureError: As `LightField.photograph` does.
    """
    if source.picture is None:
        pixels, alpha = decode(source.path, source.upright, source.exposure)
    else:
        pixels, alpha = source.picture.decode()
    stored = pixels.shape[1], pixels.shape[0]
    if (stored[0] // source.reduction, stored[1] // source.reduction) != (width, height):
        was = f"{width * source.reduction}x{height * source.reduction}"
        raise CaptureError(
            "image-size",
            f"is {stored[0]}x{stored[1]} now, but was {was} when the capture was opened",
            path=source.path,
            remedy="open the capture again",
        )
    counts = alpha
    if source.mask is not None:
        other = decode_mask(source.mask)
        if other.shape != pixels.shape[:2]:
            raise CaptureError(
                "mask-size",
                f"the mask is {other.shape[1]}x{other.shape[0]}, its photograph {stored[0]}x{stored[1]}",
                path=source.mask,
                remedy="a mask has the size of its photograph: make it anew",
            )
        counts = other if alpha is None else np.minimum(alpha, other)
    if source.reduction == 1:
        return pixels, counts
    return _reduced(pixels, source.reduction), None if counts is None else _reduced(counts, source.reduction)


def _reduced(values: NDArray[np.float32], factor: int) -> NDArray[np.float32]:
    """Means of squares of pixels; a last column or row that is no whole one is left out."""
    height, width = values.shape[0] // factor, values.shape[1] // factor
    whole = np.ascontiguousarray(values[: height * factor, : width * factor])
    return np.asarray(cv2.resize(whole, (width, height), interpolation=cv2.INTER_AREA), np.float32)


def size_on_disk(path: Path) -> int:
    """Bytes of a file; CaptureError `image-missing` where it no longer exists."""
    try:
        return path.stat().st_size
    except OSError as error:
        raise CaptureError(
            "image-missing",
            error.strerror or "cannot be read",
            path=path,
            remedy="put it back, or open the capture again",
        ) from error
