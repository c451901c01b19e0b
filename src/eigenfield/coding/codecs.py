"""Every codec of a stream in a scene file, by the name that the file may give it.

A new codec is a module that encodes and decodes, and an entry here: readers then know it, `needs` may name it, and
docs/coding.md describes its bytes. What a codec's functions take and return is that of its kind:

    kind       encode                                    decode
    mesh       (mesh, lattice, *, uv_bits, fine)         (data, where)
               -> bytes, the Mesh that is decoded        -> Mesh
    cameras    (cameras, *, steps, grid)                 (data, where)
               -> bytes, intrinsics, poses               -> intrinsics (Nc, 5), poses (Nc, 3, 4)
    names      (names) -> bytes | None                   (data, count, where) -> names
    triangles  (triangles) -> bytes                      (data, where) -> triangles (T, 3)
    weights    (weights, step, grid)                    (data, where) -> weights (Ne, N)
               -> bytes, the weights that are decoded
    picture    (codes, quality or crf) -> bytes          (data, colour, where) -> codes (H, W) or (H, W, 3)
    video      (frames, size, crf, preset,               (data, size, count, where, name)
               key_interval) -> bytes                    -> frames, one after the other
    film       (frames, size, crf, preset)               (units, size, where)
               -> units, one for each frame              -> frames, one after the other
    motion     (places, faces, frames) -> bytes          (data, places, faces, where)
                                                         -> vertices that move, their places

`where` is the place that a FormatError names, and `name` what it says is damaged. `codes` are those of a whole picture
(`stacking`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any

from eigenfield.coding.arrays.names import code_names, decode_names
from eigenfield.coding.pictures import pictures_8bit as eight
from eigenfield.coding.pictures import pictures_10bit as ten
from eigenfield.coding.pictures.av1_units import frame_size
from eigenfield.coding.video.av1 import decode_video, encode_video
from eigenfield.coding.video.film import decode_film, encode_film

AVIF = "image/avif"
AV1 = "video/AV1"


@dataclass(frozen=True)
class Codec:
    """How streams of one kind are coded.

    Attributes:
        encode: From values to bytes; None: it is read only.
        decode: From bytes to values. Raises FormatError.
        needs: The feature that a file with such a stream names in `needs`; None: readers that do not know it can go
            without, or know it since 1.0.
        since: The version of the format that brought it.
        limits: The names of limits (`coding.limits`) that its decoder checks before it takes memory.
    """

    kind: str
    encode: Callable[..., Any] | None
    decode: Callable[..., Any]
    needs: str | None
    since: str
    limits: tuple[str, ...]


@dataclass(frozen=True)
class PictureCodec(Codec):
    """How pictures are coded.

    Attributes:
        size: (data, where) -> width, height, from the header alone.
        mime: The `mimeType` of its files.
    """

    size: Callable[[memoryview, str], tuple[int, int]]
    mime: str
    bits: int = 8
    lossless: bool = False


def _later(module: str, name: str) -> Callable[..., Any]:
    """A function of a module of this room, imported when it is called: numba is heavy, and most files need none."""

    def call(*given: Any, **named: Any) -> Any:
        return getattr(import_module(f"eigenfield.coding.{module}"), name)(*given, **named)

    return call


def encoder(codec: str) -> Callable[..., Any]:
    """The encoder of a codec that has one."""
    found = CODECS[codec].encode
    assert found is not None
    return found


def _picture_8bit(mime: str, encode: Callable[..., bytes] | None, lossless: bool) -> PictureCodec:
    decode, size = partial(eight.decode_picture, mime=mime), partial(eight.header_size, mime=mime)
    return PictureCodec("picture", encode, decode, None, "1.0", PICTURE_LIMITS, size, mime, 8, lossless)


PICTURE_LIMITS = ("MAX_SIDE", "MAX_STACKED", "MAX_TEXELS")
CODECS: dict[str, Codec] = {
    "mesh-1": Codec(
        "mesh", None, partial(_later("mesh.coder", "decode_mesh"), version=1),
        "codedMesh", "1.2", ("MAX_VERTICES", "MAX_TRIANGLES"),
    ),
    "mesh-2": Codec(
        "mesh", _later("mesh.coder", "encode_mesh"), _later("mesh.coder", "decode_mesh"),
        "mesh-2", "1.8", ("MAX_VERTICES", "MAX_TRIANGLES"),
    ),
    "cameras-1": Codec(
        "cameras", _later("arrays.cameras", "code_cameras"), _later("arrays.cameras", "decode_cameras"),
        "codedCameras", "1.2", ("MAX_CAMERAS",),
    ),
    "cameras-2": Codec(
        "cameras", _later("arrays.cameras", "code_deflated"), _later("arrays.cameras", "decode_deflated"),
        "cameras-2", "1.8", ("MAX_CAMERAS",),
    ),
    "names-1": Codec("names", code_names, decode_names, "codedNames", "1.6", ("MAX_NAMES", "MAX_CAMERAS")),
    "triangles-1": Codec(
        "triangles", _later("arrays.triangles", "code_triangles"), _later("arrays.triangles", "decode_triangles"),
        "codedTriangles", "1.2", ("MAX_CAMERAS",),
    ),
    "weights-1": Codec(
        "weights", _later("arrays.weights", "code_weights"), _later("arrays.weights", "decode_weights"),
        "codedWeights", "1.2", ("MAX_WEIGHTS",),
    ),
    "png": _picture_8bit("image/png", eight.encode_png, True),
    "webp": _picture_8bit("image/webp", eight.encode_webp, True),
    "avif": _picture_8bit(AVIF, eight.encode_avif, False),
    "jpeg": _picture_8bit("image/jpeg", None, False),
    "av1-10bit-1": PictureCodec(
        "picture", None, ten.decode_avif_10bit, "bits", "1.2", PICTURE_LIMITS,
        partial(eight.header_size, mime=AVIF), AVIF, ten.PICTURE_BITS,
    ),
    "av1-10bit-2": PictureCodec(
        "picture", ten.encode_10bit, ten.decode_10bit, "av1-10bit-2", "1.8", PICTURE_LIMITS,
        frame_size, AV1, ten.PICTURE_BITS,
    ),
    "film-1": Codec("film", encode_film, decode_film, "film-1", "1.11", ("MAX_FILM_SIDE", "MAX_FILM_PIXELS")),
    "motion-1": Codec(
        "motion", _later("mesh.motion", "encode_motion"), _later("mesh.motion", "decode_motion"),
        "motion-1", "1.11", ("MAX_GROUP_FRAMES", "MAX_MOTION"),
    ),
    "video-1": Codec("video", encode_video, decode_video, None, "1.3", ("MAX_TEXELS", "MAX_VIDEO")),
}  # fmt: skip
