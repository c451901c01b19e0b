"""ICC profiles (ICC.1:2022) to sRGB, in floating point, for profiles that are a matrix and curves.

    linear = curve(value);  xyz = [rXYZ gXYZ bXYZ] linear;  srgb = encode(M^-1 xyz)

Both matrices are for the profile connection space (D50), so no further adaptation is needed; colours outside sRGB are
clipped. Profiles with tables (A2B0) are left to littleCMS, at 8 bit.
"""

from __future__ import annotations

import struct
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.colour import (
    COLOUR_CURVE_STEPS,
    COLOUR_HDR_CURVES,
    COLOUR_SRGB_TO_XYZ,
    Profile,
    read_code_points,
    skip_if_srgb,
)

ICC_MAX_TAGS = 200
ICC_CURVE_PARAMETERS = (1, 3, 4, 5, 7)  # of parametric curves, by type


class BrokenProfileError(ValueError):
    """Bytes that are no ICC profile; who reads photographs warns and goes on without."""


@lru_cache(maxsize=8)
def read_profile(data: bytes) -> Profile:
    """A profile from its bytes; raises BrokenProfileError."""
    try:
        space, tags = _read_tags(data)
        identity = np.eye(3, dtype=np.float32)
        if "cicp" in tags and tags["cicp"][9] in COLOUR_HDR_CURVES:  # its tables bring the light to another range
            return read_code_points(tags["cicp"][8], tags["cicp"][9])
        if "A2B0" in tags or space not in ("RGB ", "GRAY"):
            return Profile("tables", space, np.zeros((0, 0), np.float32), identity)
        if space == "GRAY":
            return skip_if_srgb(Profile("grey", space, _read_curve(tags["kTRC"])[None], identity))
        columns = np.stack([_read_xyz(tags[name]) for name in ("rXYZ", "gXYZ", "bXYZ")], axis=1)
        curves = np.stack([_read_curve(tags[name]) for name in ("rTRC", "gTRC", "bTRC")])
    except (KeyError, struct.error, IndexError, OverflowError) as error:
        raise BrokenProfileError(f"{type(error).__name__}: {error}") from error
    return skip_if_srgb(
        Profile("matrix", space, curves, (np.linalg.inv(COLOUR_SRGB_TO_XYZ) @ columns).astype(np.float32))
    )


def _read_tags(data: bytes) -> tuple[str, dict[str, bytes]]:
    if len(data) < 132 or data[36:40] != b"acsp":
        raise BrokenProfileError("not an ICC profile")
    (count,) = struct.unpack_from(">I", data, 128)
    if count > ICC_MAX_TAGS or 132 + 12 * count > len(data):
        raise BrokenProfileError(f"{count} tags in {len(data)} bytes")
    tags = {}
    for i in range(count):
        name, offset, size = struct.unpack_from(">4sII", data, 132 + 12 * i)
        if offset + size > len(data):
            raise BrokenProfileError("a tag reaches beyond the end")
        tags[name.decode("latin-1")] = data[offset : offset + size]
    return data[16:20].decode("latin-1"), tags


def _read_xyz(tag: bytes) -> NDArray[np.float64]:
    if tag[:4] != b"XYZ ":
        raise BrokenProfileError("a colorant that is no XYZ")
    return np.array(struct.unpack_from(">3i", tag, 8)) / 65536


def _read_curve(tag: bytes) -> NDArray[np.float32]:
    """A `curv` or `para` tag as a table of linear light over STEPS + 1 values."""
    x = np.arange(COLOUR_CURVE_STEPS + 1) / COLOUR_CURVE_STEPS
    if tag[:4] == b"para":
        return _read_parametric_curve(tag, x)
    if tag[:4] != b"curv":
        raise BrokenProfileError(f"a curve of type {tag[:4]!r}")
    (count,) = struct.unpack_from(">I", tag, 8)
    if count == 0:
        return _as_table(x)
    if count == 1:
        return _as_table(x ** (struct.unpack_from(">H", tag, 12)[0] / 256))
    if 12 + 2 * count > len(tag):
        raise BrokenProfileError("a curve reaches beyond its tag")
    return _as_table(np.interp(x, np.linspace(0, 1, count), np.frombuffer(tag, ">u2", count, 12) / 65535))


def _read_parametric_curve(tag: bytes, x: NDArray[np.float64]) -> NDArray[np.float32]:
    """ICC.1 table 68: y = (a x + b)^g + e where x >= d, else c x + f; simpler types leave parameters out."""
    (kind,) = struct.unpack_from(">H", tag, 8)
    if kind >= len(ICC_CURVE_PARAMETERS):
        raise BrokenProfileError(f"a parametric curve of type {kind}")
    count = ICC_CURVE_PARAMETERS[kind]
    numbers: list[float] = [v / 65536 for v in struct.unpack_from(f">{count}i", tag, 12)]
    g, a, b, c, d, e, f = numbers + [0.0] * (7 - count)
    if g <= 0 or (kind in (1, 2) and a == 0):
        raise BrokenProfileError("a parametric curve without slope")
    if kind == 0:
        return _as_table(x**g)
    if kind <= 2:  # a constant below the point where a x + b is zero: 0 or c
        c, d, e, f = 0.0, -b / a, c, c
    return _as_table(np.where(x >= d, np.maximum(a * x + b, 0) ** g + e, c * x + f))


def _as_table(values: NDArray[np.float64]) -> NDArray[np.float32]:
    return np.asarray(np.clip(values, 0, 1), dtype=np.float32)
