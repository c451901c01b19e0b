"""RAW files of cameras, developed by LibRaw: alike for all photographs, without anything that depends on a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.header import (
    DECODER_ERRORS,
    Header,
    missing_module_error,
    one_line,
    refuse_size,
    unreadable_error,
)
from eigenfield.capture.photographs.kinds import RAW_REMEDY
from eigenfield.core.errors import CaptureError

RAW_ORIENTATIONS = {0: 1, 3: 3, 5: 8, 6: 6}  # of LibRaw's flips
RAW_GAMMA = (2.4, 12.92)  # sRGB's curve: the power, and the slope near black


def read_raw_header(path: Path) -> Header:
    """Size and orientation; nothing is unpacked. Raises CaptureError: `image-unreadable`, `image-kind`,
    `image-too-large`."""
    with _open(path) as raw:
        return _header(raw, path)


def decode_raw(path: Path) -> tuple[NDArray[np.float32], Header]:
    """(H, W, 3) sRGB-coded values in 0..1, not turned, and the header.

    White balance is the camera's, white its sensor's: LibRaw's own brightness and its white from a picture's maximum
    would differ from photograph to photograph.
    """
    with _open(path) as raw:
        import rawpy

        header = _header(raw, path)
        try:
            pixels = raw.postprocess(
                use_camera_wb=True,
                no_auto_bright=True,
                adjust_maximum_thr=0.0,
                output_color=rawpy.ColorSpace.sRGB,
                gamma=RAW_GAMMA,
                output_bps=16,
                user_flip=0,
            )
        except (rawpy.LibRawError, *DECODER_ERRORS) as error:
            raise _error(path, error) from error
    return pixels.astype(np.float32) / np.float32(65535), header


def _open(path: Path) -> Any:
    try:
        import rawpy
    except ImportError as error:
        raise missing_module_error(path, "a camera's RAW", RAW_REMEDY) from error
    try:
        return rawpy.imread(str(path))
    except (rawpy.LibRawError, *DECODER_ERRORS) as error:
        raise _error(path, error) from error


def _error(path: Path, error: Exception) -> CaptureError:
    """LibRaw says what is wrong in bytes."""
    said = error.args[0] if error.args else ""
    return unreadable_error(path, said.decode(errors="replace") if isinstance(said, bytes) else one_line(error))


def _header(raw: Any, path: Path) -> Header:
    sizes = raw.sizes
    refuse_size(max(sizes.width, sizes.raw_width), max(sizes.height, sizes.raw_height), path)
    return Header("RAW", sizes.width, sizes.height, 16, RAW_ORIENTATIONS.get(sizes.flip, 1), False)
