"""Flicker has known answers: pictures whose changes over time are written down."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.evaluation.flicker import Flicker, StillPixels, border_step, luma_of, pool_flicker

ALL = np.ones((40, 48), bool)


def grey(values):
    return np.repeat(np.clip(np.rint(values), 0, 255).astype(np.uint8)[..., None], 3, axis=2)


def noisy(frames, sigma, seed=3):
    """Frames of a smooth picture with a square that moves one pixel a frame across its lower right."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:40, 0:48]
    base = 100 + 40 * np.sin(x / 9) * np.cos(y / 7)
    made = []
    for frame in range(frames):
        picture = base + random.normal(0, sigma, base.shape)
        picture[24:34, 14 + frame : 24 + frame] = 220
        made.append(grey(picture))
    return made


def still_of(pictures, mask=None):
    found = StillPixels()
    for picture in pictures:
        found.add(picture, mask)
    return found.still


@pytest.mark.parametrize("sigma", [0, 2, 5])
def test_what_moves_is_found_and_noise_stands_still(sigma):
    still = still_of(noisy(12, sigma))
    moved = np.zeros_like(still)
    moved[24:34, 14:35] = True
    assert not still[moved].any()
    away = np.ones_like(still)
    away[20:38, 10:39] = False  # the window is 5 wide
    assert still[away].all()


def test_a_slow_change_of_a_few_levels_does_not_stand_still():
    pictures = noisy(12, 1)
    for frame, picture in enumerate(pictures):
        picture[2:14, 2:14] += np.uint8(frame // 2)
    still = still_of(pictures)
    assert not still[5:11, 5:11].any()
    assert still[2:18, 24:46].all()


def test_a_pixel_that_is_not_seen_counts_as_it_was_last_seen():
    pictures = noisy(6, 0)
    finder = StillPixels()
    mask = np.ones((40, 48), np.float32)
    mask[:, :24] = 0
    for frame, picture in enumerate(pictures):
        spoilt = picture.copy()
        if frame in (2, 3):
            spoilt[:, :24] = 0
        finder.add(spoilt, mask if frame in (2, 3) else None)
    assert finder.still[2:20, 2:20].all()


def test_flicker_in_still_pixels_is_the_deviation_that_was_added():
    flat = np.full((40, 48), 90.0)
    photographs = [grey(flat)] * 8
    flicker = Flicker(still_of(photographs))
    for frame, photograph in enumerate(photographs):
        flicker.add(grey(flat + (3 if frame % 2 else -3)), photograph, ALL)
    figures = flicker.figures
    assert figures["still"] == pytest.approx(3)
    assert figures["still_share"] == 1
    assert figures["still_pixels"] == ALL.size
    assert figures["moving_ssim"] is None  # nothing moves


def test_a_constant_error_does_not_flicker():
    photographs = noisy(6, 0)
    flicker = Flicker(still_of(photographs))
    for photograph in photographs:
        flicker.add(photograph // np.uint8(2), photograph, ALL)
    assert flicker.figures["still"] == pytest.approx(0, abs=1e-3)


def test_pixels_that_are_not_covered_in_each_frame_do_not_count():
    flat = np.full((40, 48), 90.0)
    photographs = [grey(flat)] * 4
    flicker = Flicker(still_of(photographs))
    half = ALL.copy()
    half[:20] = False
    for frame, photograph in enumerate(photographs):
        picture = flat.copy()
        picture[:20] += 40 * frame
        flicker.add(grey(picture), photograph, half if frame == 2 else ALL)
    assert flicker.figures["still"] == pytest.approx(0, abs=1e-3)
    assert flicker.figures["still_pixels"] == half.sum()


def test_differences_that_agree_have_ssim_1_and_frozen_motion_has_less():
    photographs = noisy(8, 0)
    still = still_of(photographs)
    same, offset, frozen = Flicker(still), Flicker(still), Flicker(still)
    for photograph in photographs:
        same.add(photograph, photograph, ALL)
        offset.add(photograph - np.uint8(20), photograph, ALL)
        frozen.add(photographs[0], photograph, ALL)
    assert same.figures["moving_ssim"] == 1
    assert offset.figures["moving_ssim"] == 1  # the differences are the same
    assert frozen.figures["moving_ssim"] < 0.9
    assert frozen.figures["still"] == pytest.approx(0, abs=1e-3)


def test_cameras_are_pooled_by_their_pixels():
    one = {"still": 1.0, "still_pixels": 300, "still_share": 0.3, "moving_ssim": 0.8}
    two = {"still": 3.0, "still_pixels": 100, "still_share": 0.1, "moving_ssim": None}
    none = {"still": None, "still_pixels": 0, "still_share": 0.0, "moving_ssim": 0.6}
    pooled = pool_flicker([one, two, none])
    assert pooled["still"] == pytest.approx(np.sqrt((300 * 1 + 100 * 9) / 400))
    assert pooled["still_share"] == pytest.approx(0.4 / 3)
    assert pooled["moving_ssim"] == pytest.approx(0.7)
    assert pool_flicker([none])["still"] is None


def test_the_largest_step_is_at_a_border():
    psnr = {0: 30.0, 1: 36.0, 2: 35.0, 3: 34.5, 4: 35.5, 6: 20.0}
    assert border_step(psnr, [0, 2, 4]) == {"step": 1.0, "frame": 2}
    assert border_step(psnr, [0, 6]) is None  # frame 5 was not measured
    assert border_step(psnr, [0]) is None


def test_luma_is_that_of_the_measures():
    picture = np.zeros((1, 3, 3), np.uint8)
    picture[0, [0, 1, 2], [0, 1, 2]] = 100
    assert luma_of(picture)[0] == pytest.approx([21.26, 71.52, 7.22])
