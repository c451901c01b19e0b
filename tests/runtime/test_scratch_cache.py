"""Values in scratch files that stay open while there is room."""

from __future__ import annotations

import contextlib
import shutil

import numpy as np
import pytest

from eigenfield.core.errors import OutputError
from eigenfield.runtime.files import scratch_array
from eigenfield.runtime.scratch_cache import FREE_SHARE, open_scratch_cache


class Opened:
    """Counts how often values of 800 bytes are made, and how many are open."""

    def __init__(self):
        self.made = self.open = 0

    @contextlib.contextmanager
    def __call__(self):
        self.made, self.open = self.made + 1, self.open + 1
        with scratch_array((100,), np.float64) as value:
            value[:] = self.made
            yield (value,)
        self.open -= 1


def get(cache, key, make):
    with cache.open(key, make) as (value,):
        return float(value[0])


def test_a_value_is_made_once_while_there_is_room():
    make = Opened()
    with open_scratch_cache(1700) as cache:
        assert [get(cache, key, make) for key in "aabbab"] == [1, 1, 2, 2, 1, 2]
        assert [get(cache, "c", make), get(cache, "c", make), get(cache, "a", make)] == [3, 4, 1]
        assert (make.made, make.open) == (4, 2)
    assert make.open == 0


def test_an_error_of_a_user_leaves_the_value_and_closes_it_at_the_end():
    make = Opened()
    with open_scratch_cache(1000) as cache:
        with pytest.raises(ZeroDivisionError), cache.open("a", make):
            raise ZeroDivisionError
        assert get(cache, "a", make) == 1
    assert make.open == 0


def test_a_full_disk_leaves_little_room(monkeypatch, tmp_path):
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: shutil._ntuple_diskusage(10**6, 10**6 - 4000, 4000))
    with open_scratch_cache(10**6, tmp_path) as cache:
        assert cache.left == FREE_SHARE * 4000
    monkeypatch.undo()
    with pytest.raises(OutputError), open_scratch_cache(1, tmp_path / "missing"):
        pass
