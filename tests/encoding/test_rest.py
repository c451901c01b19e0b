"""What stands still in photographs over time is averaged, and nothing else is."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.core.observations import Photograph
from eigenfield.encoding.clip.rest import camera_at_rest
from support.changing import PICTURE, changed_frames

FRAMES = 16


def filmed(change, noise=2.0):
    """Frames with noise of so many grey levels, after `change(number, pixels)`."""
    return [Photograph(pixels, None) for pixels in changed_frames(change, FRAMES, noise)]


def nothing(number, pixels):
    pass


def square(number, pixels):
    pixels[20:30, 10 + 2 * number : 20 + 2 * number] = 0.9


def drift(number, pixels):
    pixels[:, 40:] += 0.012 * number / FRAMES  # 3 grey levels


def flicker(number, pixels):
    pixels *= 1 + 0.05 * (-1) ** number


def test_noise_of_what_stands_still_is_averaged_away():
    frames = filmed(nothing)
    found = camera_at_rest(frames, FRAMES)
    assert (found.share == 255).mean() > 0.98
    left = np.std(found.shown(frames[3]).pixels - PICTURE) * 255
    assert left < 1.3 * np.hypot(2 / np.sqrt(FRAMES), 0.29)


def test_what_moves_keeps_its_own_pixels():
    frames = filmed(square)
    found = camera_at_rest(frames, FRAMES)
    assert not found.share[18:32, 8:52].any() and (found.share[40:] == 255).all()
    np.testing.assert_array_equal(found.shown(frames[5]).pixels[20:30, 20:30], frames[5].pixels[20:30, 20:30])


@pytest.mark.parametrize("change", [drift, flicker])
def test_a_slow_drift_and_a_lamp_that_flickers_are_no_noise(change):
    found = camera_at_rest(filmed(change), FRAMES)
    assert found.share[:, 50:].mean() < 0.1 * 255


def test_frames_that_are_masked_out_do_not_count():
    frames = filmed(nothing, 0.5)
    frames[2] = Photograph(np.zeros_like(PICTURE, np.float32), np.zeros(PICTURE.shape[:2], np.float32))
    found = camera_at_rest(frames, FRAMES)
    np.testing.assert_allclose(found.average / 255, PICTURE, atol=1.5 / 255)


def test_a_speck_that_is_masked_out_has_no_average():
    mask = np.ones(PICTURE.shape[:2], np.float32)
    mask[30, 40] = 0
    found = camera_at_rest([Photograph(one.pixels, mask) for one in filmed(nothing)], FRAMES)
    assert found.share[30, 40] == 0 and found.average[30, 40].max() == 0 and (found.share[:20] == 255).all()
