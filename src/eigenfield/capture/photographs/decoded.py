"""A decoded photograph and its mask, held against the size that its capture was opened with."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.read import decode, decode_mask
from eigenfield.core.errors import CaptureError


@dataclass(frozen=True, eq=False)
class Photograph:
    """One decoded photograph, lens removed.

    pixels: (H, W, 3) float32, 0..1, sRGB-coded.
    mask: (H, W) float32, 0..1, 1 where the photograph counts; None when all of it does.
    """

    pixels: NDArray[np.float32]
    mask: NDArray[np.float32] | None

    @staticmethod
    def of(pixels: NDArray[np.float32], mask: NDArray[np.float32] | None) -> Photograph:
        """The photograph, without a mask that leaves nothing out."""
        return Photograph(pixels, None if mask is not None and mask.min() >= 1 else mask)


def decode_masked(
    path: Path, upright: bool, width: int, height: int, mask: Path | None
) -> tuple[NDArray[np.float32], NDArray[np.float32] | None]:
    """(H, W, 3) pixels of a photograph, and (H, W) alpha and mask file together; None where there is neither.

    Raises CaptureError as `LightField.photograph` does.
    """
    pixels, alpha = decode(path, upright)
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
    """Bytes of a file; CaptureError `image-missing` where it is gone."""
    try:
        return path.stat().st_size
    except OSError as error:
        raise CaptureError(
            "image-missing",
            error.strerror or "cannot be read",
            path=path,
            remedy="put it back, or open the capture again",
        ) from error
