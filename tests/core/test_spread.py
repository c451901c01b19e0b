"""Some of many, evenly spread."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.core.spread import spread_indices


@pytest.mark.parametrize(("count", "most"), [(0, 5), (1, 5), (4, 5), (5, 5), (6, 5), (100, 7), (3, 1)])
def test_the_first_the_last_and_some_between_at_even_distances(count, most):
    chosen = spread_indices(count, most)
    assert len(chosen) == min(count, most) and len(set(chosen)) == len(chosen)
    assert chosen[:1] == [0][:count] and (most == 1 or chosen[-1:] == [count - 1][:count])
    assert np.ptp(np.diff(chosen)) <= 1 if len(chosen) > 1 else True
