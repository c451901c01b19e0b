"""Means and eigen textures to 10-bit codes and picture files, and what those files hold.

One step for all eigen textures of a basis: with weights of unit variance a step in one moves the pictures as much as in
any other, and the encoder, tuned for squared error, then spends its bytes where they gain as much for all. Several
textures share a picture, one below the other: a picture's headers cost as much as a faint texture. Codes are as fine as
a picture's values allow, so that a decoder of 8 bits loses next to nothing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_10bit import MAX_CODE, Coder, crf_of, decode_10bit
from eigenfield.coding.pictures.quantise import opacity_values, precision_codes, spread_precision
from eigenfield.coding.stacking import encode
from eigenfield.core.appearance import Basis, Plane
from eigenfield.core.payloads import (
    Affine,
    Coded,
    Payload,
    Payloads,
    PicturePayload,
    mean_key,
    opacity_key,
    payloads_of,
)
from eigenfield.runtime.parallel import parallel_map

CODE_MIN_UNIT = 1e-4  # what a code stands for, in the photographs' range
# Code of the value 0, and of most of a texture: 85 of 255 in 8 bits, exactly. Near the middle no code is exact, and
# what every texture is off by adds up to grey levels.
ZERO_CODE = 341
PICTURE_MAX_ROWS = 4096  # of a picture of several textures
PICTURES_CODEC = "av1-10bit-2"  # of means and textures
PRECISION_CODEC = "png"


@dataclass(frozen=True, eq=False)
class CodedBasis:
    """A basis as its file gives it back, and what it was coded to.

    Attributes:
        basis: The basis, with the decoded textures, uint16.
        pictures: The pictures of its textures, by rank.
        weights: Its coded weights; None: they are not coded yet.
    """

    basis: Basis
    pictures: tuple[PicturePayload, ...]
    weights: Payload | None = None

    @property
    def count(self) -> int:
        """Its eigen textures."""
        return self.basis.count

    @property
    def payloads(self) -> Payloads:
        """By the keys of a scene."""
        return payloads_of(self.basis, self.pictures, self.weights)


def code_mean(
    mean: NDArray[np.float32],
    step: float,
    coder: Coder,
    precision: NDArray[np.float32] | None = None,
    white: float = 1.0,
) -> tuple[NDArray[np.float32], PicturePayload]:
    """(H, W, C) float32 as its file gives it back, and the picture.

    One step for all channels. A photograph's means have the codes 0..MAX_CODE for 0..white, as far as they go. The
    overshoot of a filter is clipped, for codes twice as coarse need 2 to 3 % more bytes.

    Args:
        step: Of the quantiser, in the values' unit, where the precision is 1.
        precision: (h, w) in 0..1, how finely each place is coded; None: all alike.
        white: Value of the brightest that a photograph shows, 1 or more.
    """
    picture: Payload | None = None
    share = np.ones((1, 1, 1), np.float32)
    if precision is not None:
        fineness = precision_codes(precision)
        picture = Payload(PRECISION_CODEC, encode(fineness[..., None], PRECISION_CODEC, 0))
        share = spread_precision(fineness, *mean.shape[:2])
        mean = mean * share
    if mean.shape[2] in (1, 3):
        top = min(white, float(mean.max()))
        unit = 1 / MAX_CODE if top <= 1 else math.ceil(top / MAX_CODE * 1e6) / 1e6
        affine = Affine(np.full(mean.shape[2], unit), np.zeros(mean.shape[2]))
    else:  # differences of colours, to both sides of 0
        unit = code_unit(float(mean.min()), float(mean.max()))
        affine = Affine(np.full(mean.shape[2], unit), np.full(mean.shape[2], float(ZERO_CODE)))
    codes = np.rint(mean / affine.scale + affine.zero).clip(0, MAX_CODE).astype(np.uint16)
    data = coder(_stack_channels(codes[None]), crf_of(step / float(affine.scale[0])))
    stored = _split_channels(decode_10bit(data, False, "mean"), codes[None].shape)[0]
    values = ((stored - affine.zero) * affine.scale).astype(np.float32) / share
    return values, PicturePayload(PICTURES_CODEC, data, 1, affine, picture)


def code_opacity(opacity: NDArray[np.float32], step: float, coder: Coder) -> Coded[NDArray[np.float32]]:
    """The opacity of sheets, (H, W) in 0..1, as its file gives it back.

    Args:
        opacity: Sides even, and at least 64.
        step: Of the quantiser, in units of opacity.
    """
    data = coder(np.rint(opacity * np.float32(MAX_CODE)).astype(np.uint16), crf_of(step * MAX_CODE))
    values = opacity_values(decode_10bit(data, False, "opacity"))
    return Coded(values, Payloads({opacity_key(values): [PicturePayload(PICTURES_CODEC, data)]}))


def code_basis(basis: Basis, step: float, coder: Coder) -> CodedBasis:
    """A basis with its textures coded.

    Args:
        basis: Of float textures (N, H, W, C).
        step: Of the quantiser, in the values' unit.
    """
    count, height, _, channels = basis.textures.shape
    values = basis.values()
    stored, scale = np.empty(values.shape, np.uint16), np.empty((count, channels), np.float32)
    each = max(1, min(PICTURE_MAX_ROWS // (height * channels), count))

    def code(first: int) -> PicturePayload:
        part = slice(first, first + each)
        unit = code_unit(float(values[part].min()), float(values[part].max()))
        codes = np.rint(values[part] / np.float32(unit) + ZERO_CODE).clip(0, MAX_CODE).astype(np.uint16)
        data = coder(_stack_channels(codes), crf_of(step / unit))
        stored[part], scale[part] = _split_channels(decode_10bit(data, False, "textures"), codes.shape), unit
        numbers = len(codes) * channels
        affine = Affine(np.full(numbers, unit), np.full(numbers, float(ZERO_CODE)))
        return PicturePayload(PICTURES_CODEC, data, len(codes), affine)

    pictures = tuple(parallel_map(code, range(0, count, each)))
    coded = Basis(stored, scale, np.full_like(scale, ZERO_CODE), basis.weights, basis.grid, basis.corner)
    return CodedBasis(coded, pictures)


def with_weights(coded: CodedBasis, weights: NDArray[np.float32], payload: Payload) -> CodedBasis:
    """The same coded textures with other weights (Ne, N), and their coded form."""
    return replace(coded, basis=replace(coded.basis, weights=weights), weights=payload)


def coded_plane(
    mean: NDArray[np.float32],
    bases: Sequence[CodedBasis],
    step: float,
    coder: Coder,
    precision: NDArray[np.float32] | None = None,
    white: float = 1.0,
) -> Coded[Plane]:
    """A plane of coded bases with its mean, (H, W, C) float32, coded; as its files give it back."""
    values, picture = code_mean(mean, step, coder, precision, white)
    payloads = Payloads.merge(coded.payloads for coded in bases) | {mean_key(values): [picture]}
    return Coded(Plane(values, tuple(coded.basis for coded in bases)), payloads)


def code_unit(low: float, high: float) -> float:
    """What a code stands for, so that low..high have codes; of few digits."""
    return math.ceil(max(CODE_MIN_UNIT, -low / ZERO_CODE, high / (MAX_CODE - ZERO_CODE)) * 1e6) / 1e6


def _stack_channels(codes: NDArray[np.uint16]) -> NDArray[np.uint16]:
    """(n, H, W, C) as one grey picture: channel below channel, texture below texture."""
    count, height, width, channels = codes.shape
    return np.ascontiguousarray(codes.transpose(0, 3, 1, 2)).reshape(count * channels * height, width)


def _split_channels(picture: NDArray[np.uint16], shape: tuple[int, ...]) -> NDArray[np.uint16]:
    count, height, width, channels = shape
    return np.ascontiguousarray(picture.reshape(count, channels, height, width).transpose(0, 2, 3, 1))
