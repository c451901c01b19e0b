"""PSNR and SSIM against scikit-image, plain NumPy, and answers that can be worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from skimage.metrics import peak_signal_noise_ratio, structural_similarity

from eigenfield.imaging.metrics import PSNR_MAX_DECIBELS, psnr, psnr_luma, ssim, to_codes

FLAT = 2e-5  # what float32 leaves of the variances of flat, bright pictures, as SSIM


def noise(height, width, seed=0, spread=12.0):
    """A picture with edges and ramps, and the same with noise, both uint8."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:height, 0:width]
    base = 120 + 90 * np.sin(x / 7.0) * np.cos(y / 5.0) + 30 * ((x // 9 + y // 6) % 2)
    picture = np.stack([base, base[::-1], 255 - base], axis=-1)
    return tuple(
        np.clip(p, 0, 255).astype(np.uint8) for p in (picture, picture + random.normal(0, spread, picture.shape))
    )


def reference_map(drawn, photograph):
    """scikit-image's SSIM map with the parameters of Wang et al. 2004."""
    _, structure = structural_similarity(
        drawn, photograph, gaussian_weights=True, use_sample_covariance=False, sigma=1.5, data_range=255,
        channel_axis=2, full=True,
    )  # fmt: skip
    return structure


def test_identical_pictures_reach_the_cap_and_one():
    picture, _ = noise(20, 30)
    assert psnr(picture, picture) == psnr_luma(picture, picture) == PSNR_MAX_DECIBELS
    assert ssim(picture, picture) == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize("offset", [1, 10, 255])
def test_a_constant_offset_has_a_known_psnr(offset):
    dark = np.zeros((16, 16, 3), np.uint8)
    light = dark + np.uint8(offset)
    expected = 20 * math.log10(255 / offset)
    assert psnr(light, dark) == pytest.approx(expected, abs=1e-9)
    assert psnr_luma(light, dark) == pytest.approx(expected, abs=1e-4)


def test_a_constant_offset_of_flat_pictures_has_a_known_ssim():
    dark, light = np.full((24, 24, 3), 100, np.uint8), np.full((24, 24, 3), 110, np.uint8)
    c1 = (0.01 * 255) ** 2
    assert ssim(light, dark) == pytest.approx((2 * 100 * 110 + c1) / (100**2 + 110**2 + c1), abs=FLAT)


def test_a_constant_offset_changes_the_luminance_term_of_ssim_only():
    dark, _ = noise(40, 50)
    dark = dark // 2
    c1 = (0.01 * 255) ** 2
    mean = np.stack([gaussian(dark[..., c].astype(float)) for c in range(3)], axis=-1)[5:-5, 5:-5]
    known = (2 * mean * (mean + 20) + c1) / (mean**2 + (mean + 20) ** 2 + c1)
    assert ssim(dark + np.uint8(20), dark) == pytest.approx(known.mean(), abs=1e-5)


def test_noise_of_two_levels_on_a_flat_picture_has_a_known_ssim():
    """Without structure to share, covariance is 0: SSIM is c2 / (σ² + c2), σ² lessened by what the mean takes of it."""
    signs = np.random.default_rng(4).choice([-2, 2], (300, 300, 3))
    flat = np.full(signs.shape, 100, np.uint8)
    variance, c2 = 4 * (1 - np.square(window()).sum()), (0.03 * 255) ** 2
    assert ssim((flat + signs).astype(np.uint8), flat) == pytest.approx(c2 / (variance + c2), abs=1e-3)


def window():
    """The 11 x 11 Gaussian of docs/measures.md."""
    y, x = np.mgrid[-5:6, -5:6]
    weights = np.exp(-(x**2 + y**2) / (2 * 1.5**2))
    return weights / weights.sum()


def gaussian(plane):
    """Weighted means under `window`, the border mirrored with its edge pixel repeated, by plain sums."""
    padded = np.pad(plane, 5, mode="symmetric")
    return np.einsum("hwij,ij->hw", np.lib.stride_tricks.sliding_window_view(padded, (11, 11)), window())


def test_masked_ssim_is_what_the_documentation_defines():
    photograph, drawn = noise(31, 26, 3)
    covered = np.random.default_rng(5).random((31, 26)) < 0.6
    covered[:, 20:] = False
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    values = []
    for channel in range(3):
        y = photograph[..., channel].astype(float)
        x = np.where(covered, drawn[..., channel], y)
        mx, my = gaussian(x), gaussian(y)
        vx, vy, vxy = gaussian(x * x) - mx**2, gaussian(y * y) - my**2, gaussian(x * y) - mx * my
        s = (2 * mx * my + c1) * (2 * vxy + c2) / ((mx**2 + my**2 + c1) * (vx + vy + c2))
        values.append(s[covered].mean())
    assert ssim(drawn, photograph, covered) == pytest.approx(np.mean(values), abs=5e-6)
    assert abs(ssim(drawn, photograph) - np.mean(values)) > 0.01  # unlike the whole frame


def test_luma_weighs_the_channels_by_bt709():
    black = np.zeros((8, 8, 3), np.uint8)
    for channel, weight in enumerate((0.2126, 0.7152, 0.0722)):
        lit = black.copy()
        lit[..., channel] = 200
        assert psnr_luma(lit, black) == pytest.approx(20 * math.log10(255 / (200 * weight)), abs=1e-4)


def test_noise_of_known_variance():
    random = np.random.default_rng(1)
    grey = np.full((256, 256, 3), 0.5, np.float32)
    noisy = grey + random.normal(0, 8 / 255, grey.shape).astype(np.float32)
    assert psnr(noisy, grey) == pytest.approx(20 * math.log10(255 / 8), abs=0.05)


def test_values_are_rounded_and_clipped_before_they_are_compared():
    picture = np.full((4, 4, 3), 100 / 255, np.float32)
    assert psnr(picture + np.float32(0.49 / 255), picture) == PSNR_MAX_DECIBELS
    assert psnr(np.full_like(picture, 1.7), np.ones_like(picture)) == PSNR_MAX_DECIBELS
    assert psnr(np.full_like(picture, -0.3), np.zeros_like(picture)) == PSNR_MAX_DECIBELS
    assert to_codes(np.array([[[0.5 / 255, 1.5 / 255, 2.0]]], np.float32)).tolist() == [[[0, 2, 255]]]  # half to even


@settings(max_examples=25)
@given(height=st.integers(11, 150), width=st.integers(11, 90), seed=st.integers(0, 9), spread=st.floats(0.1, 80))
def test_whole_frame_agrees_with_scikit_image(height, width, seed, spread):
    photograph, drawn = noise(height, width, seed, spread)
    inner = reference_map(drawn, photograph)[5:-5, 5:-5]
    if inner.size:
        assert ssim(drawn, photograph) == pytest.approx(inner.mean(), abs=1e-6)
    if (drawn != photograph).any():
        assert psnr(drawn, photograph) == pytest.approx(
            min(PSNR_MAX_DECIBELS, peak_signal_noise_ratio(photograph, drawn, data_range=255)), abs=1e-9
        )


@settings(max_examples=25)
@given(seed=st.integers(0, 99), height=st.integers(11, 140), width=st.integers(11, 80), share=st.floats(0.005, 1))
def test_masked_figures_agree_with_their_definition(seed, height, width, share):
    photograph, drawn = noise(height, width, seed % 7)
    random = np.random.default_rng(seed)
    top, left = random.integers(0, height // 2), random.integers(0, width // 2)
    covered = random.random((height, width)) < share
    covered[:top], covered[:, :left] = False, False
    if not covered.any():
        assert psnr(drawn, photograph, covered) is ssim(drawn, photograph, covered) is None
        assert psnr_luma(drawn, photograph, covered) is None
        return
    replaced = np.where(covered[..., None], drawn, photograph)
    assert ssim(drawn, photograph, covered) == pytest.approx(
        reference_map(replaced, photograph)[covered].mean(), abs=5e-6
    )
    error = drawn.astype(float)[covered] - photograph[covered]
    for figure, deviations in ((psnr, error), (psnr_luma, error @ [0.2126, 0.7152, 0.0722])):
        mean = np.square(deviations).mean()
        expected = PSNR_MAX_DECIBELS if mean == 0 else min(PSNR_MAX_DECIBELS, 10 * math.log10(255**2 / mean))
        assert figure(drawn, photograph, covered) == pytest.approx(expected, abs=1e-4)


def test_what_is_not_covered_does_not_count():
    photograph, drawn = noise(70, 60)
    covered = np.zeros((70, 60), bool)
    covered[20:50, 10:40] = True
    other = np.where(covered[..., None], drawn, 255 - drawn)
    for figure in (psnr, psnr_luma, ssim):
        assert figure(drawn, photograph, covered) == figure(other, photograph, covered)
        assert figure(drawn, photograph) != figure(other, photograph)


@pytest.mark.parametrize("shape", [(1, 1), (3, 40), (10, 10)])
def test_pictures_smaller_than_the_window(shape):
    photograph, drawn = noise(*shape)
    assert ssim(photograph, photograph) == pytest.approx(1, abs=1e-6)
    assert -1 <= ssim(drawn, photograph) <= 1


def test_small_variances_on_bright_pictures_survive_float32():
    random = np.random.default_rng(2)
    photograph = np.full((80, 80, 3), 250, np.uint8)
    drawn = photograph + random.integers(0, 2, photograph.shape).astype(np.uint8)
    assert ssim(drawn, photograph) == pytest.approx(reference_map(drawn, photograph)[5:-5, 5:-5].mean(), abs=FLAT)
