"""Constants of colour spaces against the standards' own figures."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.imaging.colour import LUMA_BT709, linear_of_srgb


def test_luma_is_that_of_the_primaries():
    """Y of white is 1; BT.709's weights are the Y row of its primaries and D65, rounded to four digits."""
    xy = np.array([[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]])
    xyz = np.column_stack([xy, 1 - xy.sum(axis=1)]) / xy[:, 1:]
    assert sum(LUMA_BT709) == pytest.approx(1)
    np.testing.assert_allclose(np.linalg.solve(xyz[:3].T, xyz[3]), LUMA_BT709, atol=5e-5)


def test_srgb_is_linear_near_black_and_a_power_above():
    known = {0.0: 0.0, 0.04: 0.04 / 12.92, 0.5: 0.21404114, 1.0: 1.0}
    np.testing.assert_allclose(linear_of_srgb(np.array(list(known))), list(known.values()), atol=1e-8)
