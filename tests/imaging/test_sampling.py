"""Points that lie far apart, and halved pictures."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.imaging.sampling import distances_to, farthest_points, halve_picture


def test_farthest_points_of_a_line():
    points = np.arange(9.0)[:, None]
    np.testing.assert_array_equal(farthest_points(distances_to(points), 4, 5), [4, 0, 8, 2, 6])
    np.testing.assert_array_equal(farthest_points(distances_to(points), 0, 3), [0, 8, 4])
    assert sorted(farthest_points(distances_to(points), 3, 99)) == list(range(9))


def test_points_that_coincide_are_chosen_once_and_others_can_be_left_out():
    points = np.array([[0.0, 0], [0, 0], [3, 4], [3, 4], [0, 1]])
    np.testing.assert_array_equal(farthest_points(distances_to(points), 1, 5), [1, 2, 4])
    distance = distances_to(points)
    allowed = np.array([True, True, False, False, True])
    np.testing.assert_array_equal(farthest_points(lambda i: np.where(allowed, distance(i), -1), 0, 5), [0, 4])


@pytest.mark.parametrize("channels", [(), (3,)])
def test_halved_is_the_mean_of_four(channels):
    picture = np.arange(4 * 6 * max(1, *channels, 1), dtype=np.float32).reshape(4, 6, *channels)
    made = halve_picture(picture)
    assert made.shape == (2, 3, *channels) and made.dtype == np.float32
    np.testing.assert_array_equal(made[1, 2], picture[2:, 4:].mean(axis=(0, 1)))
