"""Steps of a depth map: what belongs to one and what slants, and smeared ones made sharp."""

from __future__ import annotations

import numpy as np

from eigenfield.stereo.discontinuities import find_discontinuities
from eigenfield.stereo.extend import remove_speckles


def slant(height=60, width=80, slope=0.4):
    y, x = np.mgrid[:height, :width]
    return (slope * x - 0.2 * y).astype(np.float32)


def step_at(*values):
    """A row of a step at column 40 that rises through `values`."""
    row = np.zeros(80, np.float32)
    row[40 : 40 + len(values)] = values
    row[40 + len(values) :] = values[-1]
    return row


def test_a_step_of_a_pixel_on_a_slant_is_found_and_nothing_else():
    right, down = find_discontinuities(slant() + step_at(1.0), 1.0, 2.5)
    assert right[:, 39].all() and right.sum() == 60
    assert not down.any()
    turned_right, turned_down = find_discontinuities(np.ascontiguousarray((slant() + step_at(1.0)).T), 1.0, 2.5)
    assert not turned_right.any()
    np.testing.assert_array_equal(turned_down, right.T)


def test_slants_kinks_and_bends_are_no_steps():
    y, x = np.mgrid[:60, :80].astype(np.float32)
    for d in (slant(slope=2.0), np.maximum(0, x - 40), np.float32(0.01) * (x - 40) ** 2, np.maximum(x, y)):
        right, down = find_discontinuities(d.astype(np.float32), 1.0, 2.5)
        assert not right[8:-8, 8:-8].any() and not down[8:-8, 8:-8].any()  # next to the border a kink may pass for one


def test_a_slant_steeper_than_a_cut_is_a_step():
    right, _ = find_discontinuities(slant(slope=3.0), 1.0, 2.5)
    assert right.all()


def test_noise_makes_no_steps_but_steps_stand_out_of_it():
    noise = np.random.default_rng(4).normal(0, 0.25, (60, 80)).astype(np.float32)
    right, down = find_discontinuities(slant() + noise, 1.0, 4.0)
    assert (right.mean() + down.mean()) / 2 < 0.03  # 4 medians are 2.7 sigma, which 0.7 % of a Gaussian exceed
    found, _ = find_discontinuities(slant() + noise + step_at(4.0), 1.0, 4.5)
    assert found[:, 39].mean() > 0.9 > 0.05 > np.delete(found, 39, axis=1).mean()


def test_a_pixel_is_the_measure():
    d = slant() + step_at(1.0)
    one, other = find_discontinuities(d, 1.0, 2.5), find_discontinuities(np.float32(8) * d, 8.0, 20.0)
    np.testing.assert_array_equal(one[0], other[0])
    assert not find_discontinuities(d, 2.0, 5.0)[0].any()  # half a pixel there


def test_a_smeared_step_becomes_a_sharp_one_and_slants_stay():
    smeared = np.tile(step_at(1.0, 2.2, 3.1, 4.0), (60, 1))
    sharp = remove_speckles(smeared, find_discontinuities(smeared, 1.0, 2.5), 100)
    assert set(np.unique(sharp)) == {0.0, 4.0}
    assert ((np.diff(sharp, axis=1) > 0).sum(axis=1) == 1).all()
    np.testing.assert_array_equal(remove_speckles(slant(), find_discontinuities(slant(), 1.0, 2.5), 100), slant())


def test_specks_take_the_depth_around_them_and_larger_pieces_stay():
    d = np.zeros((60, 80), np.float32)
    d[10:14, 10:14] = 5
    d[30:50, 30:60] = 5
    kept = remove_speckles(d, find_discontinuities(d, 1.0, 2.5), 100)
    assert (kept[5:20, 5:20] == 0).all() and (kept[30:50, 30:60] == 5).all()
    np.testing.assert_array_equal(remove_speckles(d, find_discontinuities(d, 1.0, 2.5), 10), d)
    np.testing.assert_array_equal(
        remove_speckles(d, find_discontinuities(d, 1.0, 2.5), 10_000), d
    )  # nothing would stay
