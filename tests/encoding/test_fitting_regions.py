"""Regions with components of their own: found where the error is, none where it is even; and what they save."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from eigenfield.encoding.fitted.start import REGION_BLOCK_TEXELS, best_rectangle, find_regions


def test_a_square_of_large_error_is_found():
    energy, seen = np.ones((80, 120), np.float32), np.ones((80, 120), np.float32)
    energy[24:48, 40:64] = 30
    assert find_regions(energy, seen) == [(24, 48, 40, 64)]


def test_two_squares_the_worse_one_first():
    energy, seen = np.ones((88, 124), np.float32), np.ones((88, 124), np.float32)
    energy[0:16, 8:32] = 30
    energy[56:88, 104:124] = 60  # up to both ends, of which the lower one cuts no block
    assert find_regions(energy, seen) == [(56, 88, 104, 124), (0, 16, 8, 32)]


def test_even_error_has_no_region():
    energy = np.random.default_rng(0).uniform(0.5, 1.5, (96, 96)).astype(np.float32)
    assert find_regions(energy, np.ones_like(energy)) == []
    assert find_regions(np.zeros_like(energy), np.ones_like(energy)) == []


def test_texels_that_answer_for_more_pixels_may_have_more_error():
    seen = np.ones((64, 64), np.float32)
    seen[16:32, 16:32] = 30
    assert find_regions(seen * 2, seen) == []


def test_half_of_the_picture_is_no_region():
    energy, seen = np.ones((64, 64), np.float32), np.ones((64, 64), np.float32)
    energy[:, :32] = 1000
    assert find_regions(energy, seen) == []


@given(arrays(np.float64, st.tuples(st.integers(1, 6), st.integers(1, 6)), elements=st.floats(-9, 9)))
def test_no_rectangle_has_a_larger_sum(value):
    height, width = value.shape
    sums = [
        value[top:bottom, left:right].sum()
        for top in range(height)
        for bottom in range(top + 1, height + 1)
        for left in range(width)
        for right in range(left + 1, width + 1)
    ]
    best, (top, bottom, left, right) = best_rectangle(value)
    assert best == pytest.approx(max(sums), abs=1e-9)
    assert value[top:bottom, left:right].sum() == pytest.approx(best, abs=1e-9)


def test_blocks_are_of_the_stated_side():
    energy, seen = (
        np.ones((4 * REGION_BLOCK_TEXELS, 4 * REGION_BLOCK_TEXELS), np.float32),
        np.ones((4 * REGION_BLOCK_TEXELS, 4 * REGION_BLOCK_TEXELS), np.float32),
    )
    energy[REGION_BLOCK_TEXELS + 1, REGION_BLOCK_TEXELS + 1] = 500
    assert find_regions(energy, seen) == [
        (REGION_BLOCK_TEXELS, 2 * REGION_BLOCK_TEXELS, REGION_BLOCK_TEXELS, 2 * REGION_BLOCK_TEXELS)
    ]
