"""Colour spaces as a curve a channel and a matrix to sRGB, and those that a file states by other means than a profile.

    linear = curve(value);  srgb = encode(matrix linear)

Code points are those of ITU-T H.273: cICP of PNG, nclx of AVIF and HEIC, tags of videos. Of the HDR curves (ITU-R
BT.2100), white is BT.2408's reference, 203 cd/m2 by PQ and 75 % by HLG, and what is brighter is clipped. HLG is taken
as the light of the scene, without the system gamma of a display.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.colour import linear_of_srgb

COLOUR_SRGB_TOLERANCE = 1 / 255  # a profile that moves no colour of a 9^3 grid by more than this is sRGB itself
COLOUR_CURVE_STEPS = 65535  # values are looked up in curves of this many steps: exact for 8 and 16 bit

# IEC 61966-2-1 primaries adapted to D50 by Bradford, columns r, g, b (as in every sRGB profile)
COLOUR_SRGB_TO_XYZ = np.array(
    [[0.4360747, 0.3850649, 0.1430804], [0.2225045, 0.7168786, 0.0606169], [0.0139322, 0.0971045, 0.7141733]]
)
COLOUR_BRADFORD = np.array([[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
COLOUR_D50 = COLOUR_SRGB_TO_XYZ.sum(axis=1)  # of the profile connection space
_D65 = (0.3127, 0.3290)
# x, y of red, green, blue and white, by code point
COLOUR_PRIMARIES = {
    1: ((0.640, 0.330), (0.300, 0.600), (0.150, 0.060), _D65),  # BT.709 and sRGB
    4: ((0.670, 0.330), (0.210, 0.710), (0.140, 0.080), (0.310, 0.316)),  # NTSC of 1953
    5: ((0.640, 0.330), (0.290, 0.600), (0.150, 0.060), _D65),  # BT.601 of 625 lines
    6: ((0.630, 0.340), (0.310, 0.595), (0.155, 0.070), _D65),  # BT.601 of 525 lines
    7: ((0.630, 0.340), (0.310, 0.595), (0.155, 0.070), _D65),  # SMPTE 240M
    8: ((0.681, 0.319), (0.243, 0.692), (0.145, 0.049), (0.310, 0.316)),  # film
    9: ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), _D65),  # BT.2020
    10: ((1.0, 0.0), (0.0, 1.0), (0.0, 0.0), (1 / 3, 1 / 3)),  # XYZ
    11: ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), (0.314, 0.351)),  # DCI-P3
    12: ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), _D65),  # Display P3
    22: ((0.630, 0.340), (0.295, 0.605), (0.155, 0.077), _D65),  # EBU 3213
}
COLOUR_UNSPECIFIED = 2, 2  # primaries and transfer characteristics
COLOUR_ADOBE_RGB = ((0.640, 0.330), (0.210, 0.710), (0.150, 0.060), _D65)  # Adobe RGB (1998)
COLOUR_ADOBE_GAMMA = 563 / 256
COLOUR_GAMMA_TOLERANCE = 0.05  # of 2.2, in which libpng takes a power for the curve of sRGB
COLOUR_HDR_CURVES = {16: "PQ", 18: "HLG"}
COLOUR_PQ_WHITE, COLOUR_HLG_WHITE = 203.0, 0.75  # the reference white: cd/m2, and of full scale


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
        index = np.rint(np.clip(values, 0, 1) * np.float32(COLOUR_CURVE_STEPS)).astype(np.int32)
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


def skip_if_srgb(profile: Profile) -> Profile:
    """The profile, of the kind "none" where it is sRGB but for COLOUR_SRGB_TOLERANCE."""
    steps = np.linspace(0, 1, 9, dtype=np.float32)
    grid = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1)
    if profile.kind == "grey":
        grid = np.repeat(steps[:, None], 3, axis=1)
    if np.abs(profile.apply(grid) - grid).max() > COLOUR_SRGB_TOLERANCE:
        return profile
    return Profile("none", profile.space, profile.curves[:, :0], profile.matrix)


def make_profile(primaries: Sequence[Sequence[float]], curves: NDArray[np.float64]) -> Profile:
    """A profile from chromaticities, relative colorimetric: white becomes white.

    Args:
        primaries: x, y of red, green, blue and white.
        curves: (1 or 3, COLOUR_CURVE_STEPS + 1) linear light, 1 for white.

    Raises:
        ValueError: Where no colours have such chromaticities.
    """
    x, y = np.array(primaries, np.float64).T
    if not (np.isfinite(x).all() and np.isfinite(y).all() and y[3] > 0):
        raise ValueError("chromaticities of no colour")
    columns = np.stack([x, y, 1 - x - y])
    try:
        with np.errstate(all="ignore"):
            white = columns[:, 3] / y[3]
            adapted = np.diag((COLOUR_BRADFORD @ COLOUR_D50) / (COLOUR_BRADFORD @ white)) @ COLOUR_BRADFORD
            scaled = columns[:, :3] * np.linalg.solve(columns[:, :3], white)
            matrix = np.linalg.inv(COLOUR_BRADFORD @ COLOUR_SRGB_TO_XYZ) @ adapted @ scaled
    except np.linalg.LinAlgError as error:
        raise ValueError("chromaticities of no colour") from error
    if not np.isfinite(matrix).all():
        raise ValueError("chromaticities of no colour")
    return skip_if_srgb(Profile("matrix", "RGB ", curves.astype(np.float32), matrix.astype(np.float32)))


def gamma_curve(gamma: float) -> NDArray[np.float64]:
    """The table of a power."""
    return np.asarray(_steps() ** gamma)[None]


def srgb_curve() -> NDArray[np.float64]:
    """The table of IEC 61966-2-1."""
    return np.asarray(linear_of_srgb(_steps()))[None]


@cache
def read_adobe_rgb() -> Profile:
    """The profile of Adobe RGB (1998)."""
    return make_profile(COLOUR_ADOBE_RGB, gamma_curve(COLOUR_ADOBE_GAMMA))


@lru_cache(maxsize=8)
def read_gamma(primaries: tuple[tuple[float, float], ...], gamma: float | None) -> Profile:
    """The profile of chromaticities and a power; None for the curve of sRGB, which 1/2.2 with its primaries means, too.

    Raises ValueError as `make_profile`.
    """
    profile = make_profile(primaries, srgb_curve())
    if gamma is None or (profile.kind == "none" and abs(gamma / 2.2 - 1) < COLOUR_GAMMA_TOLERANCE):
        return profile
    return make_profile(primaries, gamma_curve(gamma))


@lru_cache(maxsize=8)
def read_code_points(primaries: int, transfer: int) -> Profile:
    """The profile of colour primaries and transfer characteristics.

    Those that are unknown or not stated are sRGB's. So are the curves of SDR cameras (BT.709, BT.601, BT.2020): they
    are shown by the curve of the display, as browsers do.
    """
    curves = {4: gamma_curve(2.2), 5: gamma_curve(2.8), 8: gamma_curve(1.0), 17: gamma_curve(2.6) * 52.37 / 48}
    if transfer == 16:
        curves[16] = _pq_curve()
    elif transfer == 18:
        curves[18] = _hlg_curve()
    return make_profile(COLOUR_PRIMARIES.get(primaries, COLOUR_PRIMARIES[1]), curves.get(transfer, srgb_curve()))


def _steps() -> NDArray[np.float64]:
    return np.arange(COLOUR_CURVE_STEPS + 1) / COLOUR_CURVE_STEPS


def _pq_curve() -> NDArray[np.float64]:
    """BT.2100, table 4: the EOTF, over the reference white."""
    power = _steps() ** (4096 / (2523 * 128))
    light = np.maximum(power - 3424 / 4096, 0) / (2413 / 128 - 2392 / 128 * power)
    return np.asarray(10000 / COLOUR_PQ_WHITE * light ** (16384 / 2610))[None]


def _hlg_curve() -> NDArray[np.float64]:
    """BT.2100, table 5: the inverse OETF, over the reference white."""
    a, b, c = 0.17883277, 0.28466892, 0.55991073

    def light(coded: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.where(coded <= 0.5, coded**2 / 3, (np.exp((coded - c) / a) + b) / 12)

    return np.asarray(light(_steps()) / light(np.array(COLOUR_HLG_WHITE)))[None]
