"""Pixels and mask of a photograph, whose size must be that with which its capture was opened."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.read import decode, decode_mask
from eigenfield.core.errors import CaptureError


def decode_with_mask(
    path: Path, upright: bool, width: int, height: int, mask: Path | None, exposure: float | None = None
) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
    """Decode a photograph with its mask.

    Args:
        path: The photograph.
        upright: Apply the EXIF orientation.
        width: As the capture was opened, pixels.
        height: Likewise.
        mask: The mask's file, or None.
        exposure: As for `decode`.

    Returns:
        (H, W, 3) pixels, and (H, W) the lesser of alpha and mask; None where there is neither.

    Raises:
        CaptureError: As `LightField.photograph` does.
    """
    pixels, alpha = decode(path, upright, exposure)
    if pixels.shape[:2] != (height, width):
        raise CaptureError(
            "image-size",
            f"is {pixels.shape[1]}x{pixels.shape[0]} now, but was {width}x{height} when the capture was opened",
            path=path,
            remedy="open the capture again",
        )
    if mask is None:
        return pixels, alpha
    other = decode_mask(mask)
    if other.shape != pixels.shape[:2]:
        raise CaptureError(
            "mask-size",
            f"the mask is {other.shape[1]}x{other.shape[0]}, its photograph {width}x{height}",
            path=mask,
            remedy="a mask has the size of its photograph: make it anew",
        )
    return pixels, other if alpha is None else np.minimum(alpha, other)


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
