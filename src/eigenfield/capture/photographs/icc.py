"""ICC profiles (ICC.1:2022) to sRGB, in floating point, for profiles that are a matrix and curves.

    linear = curve(value);  xyz = [rXYZ gXYZ bXYZ] linear;  srgb = encode(M^-1 xyz)

Both matrices are for the profile connection space (D50), so no further adaptation is needed; colours outside sRGB are
clipped. Profiles with tables (A2B0) are left to littleCMS, at 8 bit.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

ICC_MAX_TAGS = 200
ICC_SRGB_TOLERANCE = 1 / 255  # a profile that moves no colour of a 9^3 grid by more than this is sRGB itself
ICC_CURVE_PARAMETERS = (1, 3, 4, 5, 7)  # of parametric curves, by type
ICC_CURVE_STEPS = 65535  # values are looked up in curves of this many steps: exact for 8 and 16 bit

# IEC 61966-2-1 primaries adapted to D50 by Bradford, columns r, g, b (as in every sRGB profile)
ICC_SRGB_TO_XYZ = np.array(
    [[0.4360747, 0.3850649, 0.1430804], [0.2225045, 0.7168786, 0.0606169], [0.0139322, 0.0971045, 0.7141733]]
)


class BrokenProfileError(ValueError):
    """Bytes that are no ICC profile; who reads photographs warns and goes on without."""


@dataclass(frozen=True, eq=False)
class Profile:
    """A transform from a profile's colours to sRGB.

    Attributes:
        kind: "none" (it is sRGB), "matrix", "grey" (one curve), or "tables" (not done here).
        space: The profile's colour space, four letters ("RGB ", "GRAY", "CMYK").
        curves: (3, 65536) or (1, 65536) float32, from values to linear light.
        matrix: (3, 3) float32, from the profile's linear light to sRGB's.
    """

    kind: Literal["none", "matrix", "grey", "tables"]
    space: str
    curves: NDArray[np.float32]
    matrix: NDArray[np.float32]

    def apply(self, values: NDArray[np.float32]) -> NDArray[np.float32]:
        """(..., 3) values in 0..1 to sRGB-coded values in 0..1."""
        if self.kind == "none":
            return values
        index = np.rint(np.clip(values, 0, 1) * np.float32(ICC_CURVE_STEPS)).astype(np.int32)
        linear = np.empty_like(values)
        for channel in range(3):
            linear[..., channel] = self.curves[channel % len(self.curves)][index[..., channel]]
        if self.kind == "matrix":
            linear = linear @ self.matrix.T
        return encode_srgb(linear)


def encode_srgb(linear: NDArray[np.float32]) -> NDArray[np.float32]:
    """Linear light to sRGB-coded values, clipped to 0..1 (IEC 61966-2-1)."""
    light = np.clip(linear, 0, 1)
    coded: NDArray[np.float32] = np.where(
        light <= 0.0031308,
        light * np.float32(12.92),
        np.float32(1.055) * light ** np.float32(1 / 2.4) - np.float32(0.055),
    )
    return coded


@lru_cache(maxsize=8)
def read_profile(data: bytes) -> Profile:
    """A profile from its bytes; raises BrokenProfileError."""
    try:
        space, tags = _read_tags(data)
        identity = np.eye(3, dtype=np.float32)
        if "A2B0" in tags or space not in ("RGB ", "GRAY"):
            return Profile("tables", space, np.zeros((0, 0), np.float32), identity)
        if space == "GRAY":
            return _skip_if_srgb(Profile("grey", space, _read_curve(tags["kTRC"])[None], identity))
        columns = np.stack([_read_xyz(tags[name]) for name in ("rXYZ", "gXYZ", "bXYZ")], axis=1)
        curves = np.stack([_read_curve(tags[name]) for name in ("rTRC", "gTRC", "bTRC")])
    except (KeyError, struct.error, IndexError, OverflowError) as error:
        raise BrokenProfileError(f"{type(error).__name__}: {error}") from error
    return _skip_if_srgb(
        Profile("matrix", space, curves, (np.linalg.inv(ICC_SRGB_TO_XYZ) @ columns).astype(np.float32))
    )


def _skip_if_srgb(profile: Profile) -> Profile:
    steps = np.linspace(0, 1, 9, dtype=np.float32)
    grid = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1)
    if profile.kind == "grey":
        grid = np.repeat(steps[:, None], 3, axis=1)
    if np.abs(profile.apply(grid) - grid).max() > ICC_SRGB_TOLERANCE:
        return profile
    return Profile("none", profile.space, profile.curves[:, :0], profile.matrix)


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
    x = np.arange(ICC_CURVE_STEPS + 1) / ICC_CURVE_STEPS
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
