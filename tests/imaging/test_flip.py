"""FLIP against its authors' program, CIELAB of scikit-image, and answers that can be worked out by hand."""

from __future__ import annotations

import flip_evaluator
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from skimage.color import rgb2lab

from eigenfield.imaging import flip as module
from eigenfield.imaging.flip import flip, flip_map

CLOSE = 1e-4  # of the authors' map, which is float32 too; a fifth of that is seen


def authors_map(drawn, photograph):
    """The map of the authors' program, (H, W)."""
    pictures = [picture.astype(np.float32) / 255 for picture in (photograph, drawn)]
    errors, _, _ = flip_evaluator.evaluate(*pictures, "LDR", applyMagma=False, parameters={"ppd": 67.0})
    return errors[..., 0]


def pair(height, width, seed=0, spread=20.0):
    """A picture with edges, lines and ramps of colour, and the same with noise and one line more, both uint8."""
    random = np.random.default_rng(seed)
    y, x = np.mgrid[0:height, 0:width]
    picture = np.stack([127 + 120 * np.sin(x / 9.0), 255.0 * ((x // 8 + y // 5) % 2), 4.0 * y % 256], axis=-1)
    other = picture + random.normal(0, spread, picture.shape)
    other[height // 2] = random.integers(0, 256, 3)
    return tuple(np.clip(p, 0, 255).astype(np.uint8) for p in (picture, other))


def of_flat_pictures(a, b):
    """FLIP of two flat colours, 0..255, by the paper: no feature, no filter, CIELAB from scikit-image."""

    def hunt(colour):
        lightness, *rest = rgb2lab(np.asarray(colour, float).reshape(1, 1, 3) / 255)[0, 0]
        return np.array([lightness, *(0.01 * lightness * np.array(rest))])

    def distance(one, other):
        step = hunt(one) - hunt(other)
        return (abs(step[0]) + np.hypot(*step[1:])) ** 0.7

    greatest, found = distance((0, 255, 0), (0, 0, 255)), distance(a, b)
    bend = 0.4 * greatest
    return found * 0.95 / bend if found < bend else 0.95 + 0.05 * (found - bend) / (greatest - bend)


def test_identical_pictures_do_not_differ():
    picture, _ = pair(50, 40)
    assert not flip_map(picture, picture).any()
    assert flip(picture, picture) == 0


@pytest.mark.parametrize(
    ("a", "b"),
    [
        ((0, 0, 0), (255, 255, 255)),
        ((0, 255, 0), (0, 0, 255)),
        ((100, 100, 100), (101, 101, 101)),
        ((100, 100, 100), (110, 110, 110)),
        ((0, 0, 0), (1, 1, 1)),
        ((200, 30, 90), (180, 60, 20)),
    ],
)
def test_flat_pictures_have_a_known_difference(a, b):
    one, other = (np.full((30, 40, 3), colour, np.uint8) for colour in (a, b))
    known = of_flat_pictures(a, b)
    np.testing.assert_allclose(flip_map(one, other), known, atol=2e-4)  # their illuminants differ in the fourth digit
    assert flip(one, other) == pytest.approx(known, abs=2e-4)


def test_the_greatest_difference_is_one():
    green, blue = (np.full((20, 20, 3), colour, np.uint8) for colour in ((0, 255, 0), (0, 0, 255)))
    assert flip(green, blue) == pytest.approx(1, abs=1e-6)
    black = np.zeros((20, 20, 3), np.uint8)
    assert 0.96 < flip(black, black + np.uint8(255)) < 0.97


@settings(max_examples=30)
@given(height=st.integers(1, 60), width=st.integers(1, 60), seed=st.integers(0, 99), spread=st.floats(0, 120))
def test_the_map_is_that_of_the_authors(height, width, seed, spread):
    photograph, drawn = pair(height, width, seed, spread)
    made = flip_map(drawn, photograph)
    assert made.dtype == np.float32 and made.shape == (height, width)
    assert made.min() >= 0 and made.max() <= 1
    np.testing.assert_allclose(made, authors_map(drawn, photograph), atol=CLOSE)


def test_noise_of_all_codes_and_dark_pictures():
    random = np.random.default_rng(7)
    for high in (256, 12):
        a, b = random.integers(0, high, (2, 70, 90, 3), dtype=np.uint8)
        np.testing.assert_allclose(flip_map(a, b), authors_map(a, b), atol=CLOSE)


def test_bands_of_rows_leave_no_seam():
    photograph, drawn = pair(2 * module.FLIP_BAND_ROWS + 37, 33)
    np.testing.assert_allclose(flip_map(drawn, photograph), authors_map(drawn, photograph), atol=CLOSE)


def test_it_does_not_matter_which_picture_comes_first():
    a, b = pair(60, 70, 3)
    np.testing.assert_allclose(flip_map(a, b), flip_map(b, a), atol=1e-6)


def test_more_noise_is_a_greater_difference():
    found = []
    for spread in (0, 2, 8, 32):
        photograph, drawn = pair(64, 64, 1, spread)
        found.append(flip(drawn, photograph))
    assert found == sorted(found) and found[-1] > 2 * found[0]


def test_a_new_line_is_seen_where_it_is():
    flat = np.full((41, 41, 3), 120, np.uint8)
    line = flat.copy()
    line[20] = 180
    at = flip_map(line, flat)
    assert at[20].mean() > 0.3 and at[20].mean() > 10 * at[35].mean()
    assert at[0].max() == 0  # further than any filter reaches


@settings(max_examples=20)
@given(seed=st.integers(0, 99), height=st.integers(4, 90), width=st.integers(4, 60), share=st.floats(0.005, 1))
def test_masked_flip_is_its_definition(seed, height, width, share):
    photograph, drawn = pair(height, width, seed)
    random = np.random.default_rng(seed)
    covered = random.random((height, width)) < share
    covered[: random.integers(0, height // 2)], covered[:, random.integers(width // 2, width) :] = False, False
    if not covered.any():
        assert flip(drawn, photograph, covered) is None
        return
    replaced = np.where(covered[..., None], drawn, photograph)
    known = authors_map(replaced, photograph)[covered].mean(dtype=float)
    assert flip(drawn, photograph, covered) == pytest.approx(known, abs=CLOSE)
    other = np.where(covered[..., None], drawn, 255 - drawn)  # what is not covered does not count
    assert flip(other, photograph, covered) == flip(drawn, photograph, covered)


def test_all_covered_is_the_whole_frame():
    photograph, drawn = pair(50, 40)
    assert flip(drawn, photograph, np.ones((50, 40), bool)) == pytest.approx(flip(drawn, photograph), abs=1e-7)


def test_values_are_rounded_and_clipped_first():
    photograph, drawn = pair(30, 30)
    floats = drawn / np.float32(255) + np.float32(0.4 / 255)
    assert flip(floats, photograph) == flip(drawn, photograph)
    assert flip(np.full((9, 9, 3), 1.5, np.float32), np.full((9, 9, 3), 255, np.uint8)) == 0
