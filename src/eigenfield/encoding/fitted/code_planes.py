"""Means and eigen textures to 10-bit codes and picture files, and what those files hold.

One step for all eigen textures of a basis: with weights of unit variance a step in one moves the pictures as much as in
any other, and the encoder, tuned for squared error, then spends its bytes where they gain as much for all. Several
textures share a picture, one below the other: a picture's headers cost as much as a faint texture. Codes are as fine as
a picture's values allow, so that a decoder of 8 bits loses next to nothing.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.pictures.pictures_8bit import encode
from eigenfield.coding.pictures.pictures_10bit import MIME, TOP, Coder, crf_of, decode_deep
from eigenfield.coding.pictures.precision import precision_codes, spread_precision
from eigenfield.core.payloads import Affine, PictureFile, files_of, keep_files, keep_stream
from eigenfield.core.scene import Basis, Plane
from eigenfield.runtime.parallel import parallel_map

FINEST = 1e-4  # of a code, in the photographs' range
# Code of the value 0, and of most of a texture: 85 of 255 in 8 bits, exactly. Near the middle no code is exact, and
# what every texture is off by adds up to grey levels.
ZERO = 341
ROWS = 4096  # of a picture of several textures, at most


def code_mean(
    mean: NDArray[np.float32], step: float, coder: Coder, precision: NDArray[np.float32] | None = None
) -> tuple[NDArray[np.float32], PictureFile]:
    """(H, W, C) float32 as its file gives it back, and the file. One step for all channels. A photograph's means have
    the codes 0..TOP for 0..1; what a filter overshoots is cut off, for codes twice as coarse need 2 to 3 % more bytes.
    step: of the quantiser, in the values' unit, where the precision is 1. precision: (h, w) in 0..1, how finely each
    place is coded; None: all alike."""
    picture: bytes | None = None
    share = np.ones((1, 1, 1), np.float32)
    if precision is not None:
        fineness = precision_codes(precision)
        picture = encode(fineness[..., None], "png", 0)
        share = spread_precision(fineness, *mean.shape[:2])
        mean = mean * share
    if mean.shape[2] in (1, 3):
        affine = Affine(np.full(mean.shape[2], 1 / TOP), np.zeros(mean.shape[2]))
    else:  # differences of colours, to both sides of 0
        unit = _unit(float(mean.min()), float(mean.max()))
        affine = Affine(np.full(mean.shape[2], unit), np.full(mean.shape[2], float(ZERO)))
    codes = np.rint(mean / affine.scale + affine.zero).clip(0, TOP).astype(np.uint16)
    data = coder(_stack(codes[None]), crf_of(step / float(affine.scale[0])))
    stored = _unstack(decode_deep(data, "mean"), codes[None].shape)[0]
    values = ((stored - affine.zero) * affine.scale).astype(np.float32) / share
    return values, PictureFile(data, MIME, 10, 1, affine, picture)


def code_basis(basis: Basis, step: float, coder: Coder) -> Basis:
    """A basis of float textures (N, H, W, C) as its files give it back, uint16, with the files kept beside it.

    step: of the quantiser, in the values' unit.
    """
    count, height, _, channels = basis.textures.shape
    values = basis.values()
    stored, scale = np.empty(values.shape, np.uint16), np.empty((count, channels), np.float32)
    each = max(1, min(ROWS // (height * channels), count))

    def code(first: int) -> PictureFile:
        part = slice(first, first + each)
        unit = _unit(float(values[part].min()), float(values[part].max()))
        codes = np.rint(values[part] / np.float32(unit) + ZERO).clip(0, TOP).astype(np.uint16)
        data = coder(_stack(codes), crf_of(step / unit))
        stored[part], scale[part] = _unstack(decode_deep(data, "textures"), codes.shape), unit
        numbers = len(codes) * channels
        affine = Affine(np.full(numbers, unit), np.full(numbers, float(ZERO)))
        return PictureFile(data, MIME, 10, len(codes), affine)

    files = parallel_map(code, range(0, count, each))
    made = Basis(stored, scale, np.full_like(scale, ZERO), basis.weights, basis.grid, basis.corner)
    keep_files(made, files)
    return made


def first_pictures(basis: Basis, count: int) -> Basis:
    """The coded textures of a basis's first `count` picture files, with those."""
    files = (files_of(basis) or ())[:count]
    made = basis.truncated(sum(file.count for file in files))
    keep_files(made, files)
    return made


def with_weights(basis: Basis, weights: NDArray[np.float32], stream: bytes) -> Basis:
    """The same coded textures with other weights (Ne, N), and their coded form."""
    made = replace(basis, weights=weights)
    keep_stream(made, stream)
    files = files_of(basis)
    if files is not None:
        keep_files(made, files)
    return made


def coded_plane(
    mean: NDArray[np.float32],
    bases: tuple[Basis, ...],
    step: float,
    coder: Coder,
    precision: NDArray[np.float32] | None = None,
) -> Plane:
    """A plane of coded bases with its mean coded, as its files give it back; see `code_mean`."""
    values, file = code_mean(mean, step, coder, precision)
    made = Plane(values, bases)
    keep_files(made, [file])
    return made


def _unit(low: float, high: float) -> float:
    """What a code stands for, so that low..high have codes; of few digits."""
    return math.ceil(max(FINEST, -low / ZERO, high / (TOP - ZERO)) * 1e6) / 1e6


def _stack(codes: NDArray[np.uint16]) -> NDArray[np.uint16]:
    """(n, H, W, C) as one grey picture: channel below channel, texture below texture."""
    count, height, width, channels = codes.shape
    return np.ascontiguousarray(codes.transpose(0, 3, 1, 2)).reshape(count * channels * height, width)


def _unstack(picture: NDArray[np.uint16], shape: tuple[int, ...]) -> NDArray[np.uint16]:
    count, height, width, channels = shape
    return np.ascontiguousarray(picture.reshape(count, channels, height, width).transpose(0, 2, 3, 1))
