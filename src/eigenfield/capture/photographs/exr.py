"""OpenEXR: linear light of rendered pictures, brought to sRGB-coded values by one exposure for a whole capture.

coded = f(clip(exposure * linear, 0, 1)), where f is the sRGB curve (IEC 61966-2-1). If EXR_PERCENTILE of the capture's
values lie below a number between EXR_MIN_WHITE and 1, the exposure is 1, as where a renderer saves 8 bit; otherwise
that number becomes 1.
"""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.header import (
    DECODER_ERRORS,
    Header,
    decoder_error,
    missing_module_error,
    refuse_size,
    truncated_error,
    unreadable_error,
)
from eigenfield.capture.photographs.kinds import RENDERS_REMEDY
from eigenfield.core.errors import CaptureError
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger(__name__)

EXR_MAGIC = b"\x76\x2f\x31\x01"
EXR_PERCENTILE = 99.5  # of the greatest of R, G and B
EXR_MIN_WHITE = 0.1
EXR_MAX_SAMPLES = 1 << 16  # of the values of a picture, evenly spread, that the percentile is of
EXR_MAX_CHANNELS = 1000
EXR_SRGB_PRIMARIES = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)  # x, y of red, green, blue and white
EXR_PRIMARIES_TOLERANCE = 2e-3


def read_exr_header(path: Path) -> Header:
    """Size, depth and alpha; no pixel is read. Raises CaptureError: `image-unreadable`, `image-kind`,
    `image-too-large`."""
    part = _open(path, header_only=True)
    names = _channel_names(part, path)
    width, height = _window(part, "displayWindow", path)[2:]
    return Header("EXR", width, height, 16, 1, "A" in names)


def decode_exr(path: Path) -> NDArray[np.float32]:
    """(H, W, 3 or 4) linear light as the file has it, finite and not negative, alpha not multiplied in.

    Raises CaptureError: as `read_exr_header`, and `image-truncated`.
    """
    names = _channel_names(_open(path, header_only=True), path)  # before anything is unpacked
    part = _open(path, header_only=False)
    channels = part.channels
    if any(name not in channels for name in names.values()):
        raise truncated_error(path)
    left, top, width, height = _window(part, "displayWindow", path)
    x, y, data_width, data_height = _window(part, "dataWindow", path)
    x, y = x - left, y - top
    values = np.zeros((height, width, 4 if "A" in names else 3), np.float32)
    rows, columns = slice(max(y, 0), min(y + data_height, height)), slice(max(x, 0), min(x + data_width, width))
    for place, name in enumerate("RGBA"[: values.shape[2]]):
        stored = channels[names[name]].pixels
        if stored.shape != (data_height, data_width):
            raise _kind_error(path, "subsampled channels")
        inner = stored[rows.start - y : max(rows.stop - y, 0), columns.start - x : max(columns.stop - x, 0)]
        values[rows, columns, place] = inner
    values[np.isnan(values)] = 0
    np.clip(values, 0, np.finfo(np.float32).max, out=values)
    if values.shape[2] == 4:
        np.divide(values[..., :3], values[..., 3:], out=values[..., :3], where=values[..., 3:] > 0)
    return values


def choose_exposure(paths: Sequence[Path]) -> float:
    """The factor of linear values that the photographs of a capture have in common.

    Photographs that cannot be decoded do not count. Raises no error.
    """

    def brightest(path: Path) -> NDArray[np.float32]:
        with contextlib.suppress(CaptureError):
            values = decode_exr(path)
            seen = values[values[..., 3] > 0] if values.shape[2] == 4 else values.reshape(-1, 3)
            found: NDArray[np.float32] = seen[:: -(-len(seen) // EXR_MAX_SAMPLES) or 1, :3].max(axis=1)
            return found
        return np.zeros(0, np.float32)

    values = np.concatenate(parallel_map(brightest, paths))
    white = float(np.percentile(values, EXR_PERCENTILE)) if len(values) else 0.0
    return 1.0 if white <= 0 or EXR_MIN_WHITE <= white <= 1 else 1 / white


def _open(path: Path, *, header_only: bool) -> Any:
    """The first part with colours."""
    try:
        import OpenEXR
    except ImportError as error:
        raise missing_module_error(path, "OpenEXR", RENDERS_REMEDY) from error
    try:
        parts = OpenEXR.File(str(path), separate_channels=True, header_only=header_only).parts
    except DECODER_ERRORS as error:
        raise decoder_error(path, error) from error
    if not parts:
        raise unreadable_error(path, "it has no picture") if header_only else truncated_error(path)
    return next((part for part in parts if _find_colours(_listed(part))), parts[0])


def _listed(part: Any) -> list[str]:
    return [channel.name for channel in part.header.get("channels", [])]


def _find_colours(names: Sequence[str]) -> dict[str, str]:
    """The channels of R, G, B, and A if there is one, by their letters: those without a layer, else of the layer named
    Combined, else of the first that has them; or one grey channel for all three. Empty where there is none."""
    layers = sorted(
        {name[:-1] for name in names if name[-1:] == "R"}, key=lambda layer: (layer != "", "Combined" not in layer)
    )
    for layer in layers:
        if {f"{layer}G", f"{layer}B"} <= set(names):
            return {letter: f"{layer}{letter}" for letter in "RGBA" if f"{layer}{letter}" in names}
    if "Y" in names and "RY" not in names:
        return dict.fromkeys("RGB", "Y") | ({"A": "A"} if "A" in names else {})
    return {}


def _channel_names(part: Any, path: Path) -> dict[str, str]:
    header = part.header
    listed = _listed(part)
    width, height = _window(part, "displayWindow", path)[2:]
    refuse_size(width, height, path)
    width, height = _window(part, "dataWindow", path)[2:]
    refuse_size(width, height, path)
    refuse_size(width * -(-len(listed) // 16), height, path)  # all channels are unpacked
    names = _find_colours(listed)
    if not names or len(listed) > EXR_MAX_CHANNELS:
        raise _kind_error(path, f"no channels R, G, B (it has {', '.join(listed)[:60]})")
    if "deep" in str(header.get("type", "")):
        raise _kind_error(path, "several samples a pixel (deep)")
    if str(header.get("envmap", "")).endswith("LATLONG"):
        raise _kind_error(path, "a picture of all directions (envmap)")
    primaries = header.get("chromaticities")
    if primaries is not None:
        off = np.abs(np.array(primaries, np.float64).ravel() - EXR_SRGB_PRIMARIES).max()
        if off > EXR_PRIMARIES_TOLERANCE:
            log.warning("%s: its primaries are not sRGB's, and are not converted", path)
    return names


def _window(part: Any, name: str, path: Path) -> tuple[int, int, int, int]:
    """Left, top, width and height."""
    low, high = (np.asarray(corner, np.int64) for corner in part.header[name])
    size = high - low + 1
    return int(low[0]), int(low[1]), int(size[0]), int(size[1])


def _kind_error(path: Path, what: str) -> CaptureError:
    return CaptureError(
        "image-kind",
        f"is an OpenEXR with {what}",
        path=path,
        remedy="save it with the channels R, G, B and, if need be, A",
    )
