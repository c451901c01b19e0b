"""Numbers to 8-bit codes and back: value = (code - zero) * scale.

One quantiser step for all components of a basis is least-squares optimal when every column of the weights has unit
variance: a step in texture k then moves the pictures as much as one in texture 0, and late, faint textures use few
codes and few bytes. The 127 codes on either side force a coarser step on the strongest textures; the others have at
least MIN_STEP_RATIO of it. Tarot, 15 textures of 1024 x 1024, AVIF, noise of all textures together:

    step                              about 140 kB    about 208 kB
    the strongest texture's for all      43.4 dB         44.0 dB
    0.5 of it, if the range allows       43.6 dB         44.5 dB
    each stretched to the full range     43.5 dB         44.3 dB

A mean may have a precision, place by place, as a small grey picture. A texel that few cameras see answers for few
pixels, and is coded coarser: the mean is multiplied by its precision, 0..1, before it is coded, and the decoded numbers
are divided by it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.appearance import Basis
from eigenfield.core.payloads import Affine

ZERO_CODE = 128  # code of the value 0, so that 0 stays 0
MAX_OFFSET_CODES = 127  # codes on either side of it
CONSTANT_STEP_RATIO = 1e-6  # of its value, of a channel without range: an error of a few codes must not show
MIN_STEP_RATIO = 0.5  # of the strongest texture's step
FILTER_OVERSHOOT = 0.125  # of bicubic and Lanczos filters beyond 0..1: 0.03 on Tarot's mean


def is_unit_range(mean: NDArray[np.float32]) -> bool:
    """Whether a mean lies in 0..1, where code / 255 is its value."""
    return bool(mean.min() >= 0 and mean.max() <= 1)


def is_photographic(mean: NDArray[np.float32]) -> bool:
    """Three channels in 0..1 but for the overshoot of a resampling filter: R, G and B, which share a unit."""
    return bool(mean.shape[2] == 3 and mean.min() >= -FILTER_OVERSHOOT and mean.max() <= 1 + FILTER_OVERSHOOT)


def mean_codes(mean: NDArray[np.float32], keep: bool = False) -> tuple[NDArray[np.uint8], Affine | None]:
    """Codes of a mean, and the scale and zero (C,) that decode them; None for code / 255.

    None is for means that lie in 0..1 or are photographic, whose overshoot is clipped. Otherwise the codes 0..255 span
    each channel's range.

    Args:
        mean: (H, W, C).
        keep: Clip nothing even if it is photographic; one range for all channels.
    """
    if not np.isfinite(mean).all():
        raise ValueError("a mean that is not finite")
    if is_unit_range(mean) or (is_photographic(mean) and not keep):
        return np.rint(mean.clip(0, 1) * np.float32(255)).astype(np.uint8), None
    flat = mean.reshape(-1, mean.shape[2]).astype(np.float64)
    low, high = flat.min(axis=0), flat.max(axis=0)
    if keep:
        low, high = np.full_like(low, min(low.min(), 0)), np.full_like(high, max(high.max(), 1))
    scale = np.where(high > low, (high - low) / 255, np.maximum(np.abs(low), 1) * CONSTANT_STEP_RATIO)
    affine = Affine(scale, -low / scale)
    return np.rint(mean / affine.scale + affine.zero).clip(0, 255).astype(np.uint8), affine


def mean_values(codes: NDArray[np.uint8] | NDArray[np.uint16], affine: Affine | None) -> NDArray[np.float32]:
    """(H, W, C) codes of a mean back to float32 numbers."""
    if affine is None:
        return codes.astype(np.float32) / np.float32(255)
    return ((codes - affine.zero) * affine.scale).astype(np.float32)


def opacity_codes(opacity: NDArray[np.float32]) -> NDArray[np.uint8]:
    """(H, W) opacity in 0..1 as codes of 8 bits (H, W, 1)."""
    return np.rint(opacity * np.float32(255)).astype(np.uint8)[..., None]


def opacity_values(codes: NDArray[np.uint8] | NDArray[np.uint16]) -> NDArray[np.float32]:
    """Codes of an opacity, of 8 or (uint16) 10 bits, as float32 numbers in 0..1."""
    return codes.astype(np.float32) / np.float32(255 if codes.dtype == np.uint8 else 1023)


def basis_scale(basis: Basis, one_unit: bool) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(N, C) scale and zero for the codes of a basis; those it has if its textures are codes already.

    A texture's largest value always has a code: nothing is ever clipped.

    Args:
        one_unit: Whether the channels share a unit (R, G, B), and so a step.
    """
    if basis.textures.dtype == np.uint8:
        return basis.scale, basis.zero
    count, _, _, channels = basis.textures.shape
    largest = np.zeros((count, channels))
    for k, (texture, scale, zero) in enumerate(zip(basis.textures, basis.scale, basis.zero, strict=True)):
        extremes = np.stack([texture.min(axis=(0, 1)), texture.max(axis=(0, 1))])
        largest[k] = np.abs((extremes - zero) * scale).max(axis=0)
    if not np.isfinite(largest).all():
        raise ValueError("eigen textures that are not finite")
    if one_unit:
        largest[:] = largest.max(axis=1, keepdims=True)
    step = np.maximum(largest, MIN_STEP_RATIO * largest.max(axis=0, initial=0)) / MAX_OFFSET_CODES
    return np.where(step > 0, step, 1).astype(np.float32), np.full((count, channels), ZERO_CODE, np.float32)


def texture_codes(basis: Basis, index: int, scale: NDArray[np.float32], zero: NDArray[np.float32]) -> NDArray[np.uint8]:
    """(H, W, C) uint8 codes of texture `index` under scale and zero (N, C) from `basis_scale`."""
    texture = basis.textures[index]
    if texture.dtype == np.uint8:
        return texture
    value = basis.values(index, index + 1)[0]
    return np.rint(value / scale[index] + zero[index]).clip(0, 255).astype(np.uint8)


def precision_codes(precision: NDArray[np.float32]) -> NDArray[np.uint8]:
    """(h, w) numbers in 0..1 as the codes of a grey picture, each the nearest of 1/256 to 1."""
    return np.rint(256 * precision - 1).clip(0, 255).astype(np.uint8)


def spread_precision(codes: NDArray[np.uint8], height: int, width: int) -> NDArray[np.float32]:
    """(height, width, 1): the precision at each texel of a mean, between the middles of the (h, w) codes linearly."""
    import cv2  # most files need none

    values = (codes.astype(np.float32) + 1) / 256
    return np.asarray(cv2.resize(values, (width, height), interpolation=cv2.INTER_LINEAR), np.float32)[..., None]
