"""Observations: cameras at times, and those of some cameras."""

from __future__ import annotations

import numpy as np

from eigenfield.core.observations import Photograph, select_cameras
from support.observations import InMemory


def grey(level: float) -> np.ndarray:
    return np.full((2, 3, 3), level, np.float32)


def test_those_of_some_cameras_come_time_after_time_in_the_order_of_the_cameras():
    cameras, times = [2, 0, 1, 1, 0, 2], [1, 0, 0, 1, 1, 0]  # in no order
    whole = InMemory(
        [grey(10 * time + camera) for camera, time in zip(cameras, times, strict=True)], (), cameras, times
    )
    some = select_cameras(whole, [2, 0])
    assert [some.camera_of(i) for i in range(len(some))] == [0, 1, 0, 1]
    assert [some.time_of(i) for i in range(len(some))] == [0, 0, 1, 1]
    assert [some.photograph(i).pixels[0, 0, 0] for i in range(len(some))] == [2, 0, 12, 10]
    again = select_cameras(some, [1])
    assert [again.photograph(i).pixels[0, 0, 0] for i in range(len(again))] == [0, 10]
    assert len(select_cameras(whole, [])) == 0


def test_a_mask_that_leaves_nothing_out_is_none():
    assert Photograph.of(grey(0), np.ones((2, 3), np.float32)).mask is None
    half = np.array([[1, 0.5, 1], [1, 1, 1]], np.float32)
    assert Photograph.of(grey(0), half).mask is half
