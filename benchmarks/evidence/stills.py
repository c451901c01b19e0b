"""Each view as a picture of its own: AVIF and JPEG XL. The peer that can be reached into."""

from __future__ import annotations

import functools
import importlib
import io
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from PIL import Image, features

from eigenfield.runtime.parallel import parallel_map, parallel_stream
from evidence import rates
from evidence.codecs import evict
from evidence.colour import Picture


@dataclass(frozen=True)
class StillCodec:
    """One way to code single pictures. rates: AVIF's quality or JPEG XL's distance, from large files to small ones."""

    name: Literal["avif", "jpeg-xl"]
    label: str
    rates: tuple[float, float, float, float]


STILLS = (
    StillCodec("avif", "AVIF a view, 4:4:4", (50, 35, 20, 10)),
    StillCodec("jpeg-xl", "JPEG XL a view", (2.0, 4.0, 7.0, 12.0)),
)
EFFORT = 5  # of JPEG XL, 1 to 9


@functools.cache
def missing(codec: StillCodec) -> str | None:
    """Why the codec cannot run here, in words; None when it can."""
    if codec.name == "avif":
        return None if features.check("avif") else "Pillow was built without AVIF"
    try:
        available = bool(importlib.import_module("imagecodecs").JPEGXL.available)
    except ImportError:
        return "the package imagecodecs is not installed"
    return None if available else "imagecodecs was built without JPEG XL"


def encode(picture: Picture, codec: StillCodec, rate: float) -> bytes:
    """The file of one (H, W, 3) uint8 picture, made by one thread."""
    if codec.name == "jpeg-xl":
        jxl = importlib.import_module("imagecodecs")
        return bytes(jxl.jpegxl_encode(np.ascontiguousarray(picture), distance=rate, effort=EFFORT, numthreads=1))
    buffer = io.BytesIO()
    Image.fromarray(picture).save(
        buffer, "AVIF", quality=round(rate), subsampling="4:4:4", speed=6, max_threads=1,
        advanced={"tune": "psnr", "deltaq-mode": "0"},  # the default tunes for the eye
    )  # fmt: skip
    return buffer.getvalue()


def decode(data: bytes, codec: StillCodec) -> Picture:
    """(H, W, 3) uint8."""
    if codec.name == "jpeg-xl":
        return np.asarray(importlib.import_module("imagecodecs").jpegxl_decode(data, numthreads=1))
    with Image.open(io.BytesIO(data)) as image:
        return np.asarray(image.convert("RGB"))


def access(path: Path, codec: StillCodec) -> tuple[float, Picture]:
    """Seconds from a closed, cold file to its RGB picture, and that picture."""
    evict(path)
    start = time.perf_counter()
    picture = decode(path.read_bytes(), codec)
    return time.perf_counter() - start, picture


def measure_stills(
    codec: StillCodec,
    rate: float,
    pictures: Sequence[Picture],
    names: Sequence[str],
    covered: Sequence[NDArray[np.bool_]],
    folder: Path,
) -> dict[str, Any]:
    """One point of a codec's curve, as `codecs.measure_video`; bytes are the sum of all files.

    encode_seconds are of the clock, with a picture to each thread. The middle view's file is left in `folder`.
    """
    start = time.perf_counter()
    files = parallel_map(lambda picture: encode(picture, codec, rate), pictures)
    seconds = time.perf_counter() - start
    reached = {}
    for place, position in (("middle", (len(files) - 1) // 2), ("last", len(files) - 1)):
        path = folder / f"{codec.name}-{rate:g}-{place}.{'avif' if codec.name == 'avif' else 'jxl'}"
        path.write_bytes(files[position])
        reached[place] = round(access(path, codec)[0], 4)
    decoded = parallel_stream(lambda data: decode(data, codec), files)
    return {
        "parameter": rate,
        "bytes": sum(map(len, files)),
        "encode_seconds": round(seconds, 2),
        "access_seconds": reached,
        **rates.point(decoded, pictures, covered, names),
    }
