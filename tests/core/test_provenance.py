"""What settings record, and that anything may stand in them."""

from __future__ import annotations

import math
from dataclasses import fields

import numpy as np
import pytest

from eigenfield.core.provenance import Provenance

GARBAGE = [None, True, -1, 0, 1e999, math.nan, "text", [], [1, 2], [[]], {}, {"bytes": []}, {"exposure": "x"}]


def test_what_is_recorded_is_read():
    found = Provenance.of(
        {
            "origin": [1, -2.5, 3e6],
            "metresPerUnit": 0.25,
            "tone": {"curve": "sRGB", "exposure": 2},
            "lenses": [None, ["brown", [0.5, 0, 0, 0, 1]]],
            "asStored": [0, 3],
            "resampling": "bicubic",
            "align": "dis",
            "maxAngle": 80,
            "fitted": {},
            "photographs": {"count": 2, "bytes": 1000},
            "fallback": "none",
        }
    )
    assert found.origin.tolist() == [1, -2.5, 3e6] and found.metres_per_unit == 0.25 and found.exposure == 2.0
    assert found.lenses == (None, ("brown", (0.5, 0.0, 0.0, 0.0, 1.0))) and found.as_stored == {0, 3}
    assert (found.resampling, found.align, found.max_angle) == ("bicubic", "dis", 80)
    assert found.is_fitted and found.photographs_bytes == 1000 and found.fallback == "none"


def test_nothing_is_recorded_by_no_settings():
    found = Provenance.of({})
    assert not found.origin.any() and found.lenses == () and found.as_stored == frozenset() and not found.is_fitted
    names = {one.name for one in fields(Provenance)} - {"origin", "lenses", "as_stored", "is_fitted"}
    assert all(getattr(found, name) is None for name in names)


@pytest.mark.parametrize("value", GARBAGE)
def test_anything_may_stand_in_settings(value):
    names = ("origin", "metresPerUnit", "tone", "lenses", "asStored", "photographs", "fallback")
    found = Provenance.of(dict.fromkeys(names, value))
    assert found.origin.shape == (3,) and np.isfinite(found.origin).all()
    assert found.exposure is None and found.photographs_bytes is None
    assert found.metres_per_unit is None or 0 < found.metres_per_unit < math.inf
    assert found.lenses in ((), None) and all(isinstance(index, int) for index in found.as_stored)
    assert found.fallback is None or isinstance(found.fallback, str)
