"""Slanted patches: known depth where pictures differ in exposure, where paint is plain, and beside an occluder."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.runtime.parallel import set_threads
from eigenfield.stereo.patches import OtherMaps, match_patches, upsample_planes
from eigenfield.stereo.views import mark_outside
from support.planes import cropped, everywhere, paint, photograph

SIDE = 96
PLACES = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1)]


def matrices(places=PLACES):
    """Views beside each other, x_view = x - (d - 8) column: labels from 0 to 16, the reference first."""
    result = np.zeros((len(places), 3, 4))
    result[:, 0, 0] = result[:, 1, 1] = result[:, 2, 3] = 1
    result[:, :2, 2] = -np.array(places)
    result[:, :2, 3] = 8 * np.array(places)
    return result


def labels(planes):
    return upsample_planes(planes, (SIDE, SIDE))


@pytest.fixture(scope="module")
def slanted():
    y, x = np.mgrid[0:SIDE, 0:SIDE]
    pictures = photograph([(6.0, 0.05, -0.03, paint(1), everywhere)], matrices(), SIDE)
    return pictures, 6 + 0.05 * x - 0.03 * y


def test_a_slanted_plane_is_found_with_its_slopes(slanted):
    pictures, truth = slanted
    planes, cost = match_patches(pictures, matrices(), (SIDE, SIDE), 16.0)
    off = np.abs(labels(planes) - truth)[8:-8, 8:-8]
    assert np.median(off) < 0.15 and (off < 0.5).mean() > 0.95
    assert np.abs(np.median(planes[..., 1:], axis=(0, 1)) - [0.1, -0.06]).max() < 0.04
    assert np.median(cost) < 0.2


def test_exposure_has_no_effect(slanted):
    pictures, truth = slanted
    gains = np.array([1, 0.5, 0.7, 0.6, 0.8, 0.5])[:, None, None, None]
    others = np.rint(pictures * gains + 10).astype(np.uint8)
    off = np.abs(labels(match_patches(others, matrices(), (SIDE, SIDE), 16.0)[0]) - truth)[8:-8, 8:-8]
    assert np.median(off) < 0.15 and (off < 0.5).mean() > 0.95


def test_smaller_views_have_no_say_beyond_their_end(slanted):
    pictures, truth = slanted
    places = [(slice(0, SIDE), slice(0, SIDE - 36 * (view % 2))) for view in range(len(PLACES))]
    marked = mark_outside(cropped(pictures, places), places)
    off = np.abs(labels(match_patches(marked, matrices(), (SIDE, SIDE), 16.0)[0]) - truth)[8:-8, 8:-8]
    assert np.median(off) < 0.15 and (off < 0.5).mean() > 0.99


def test_plain_paint_continues_the_plane_around_it():
    texture = paint(4)
    texture[38:58, 38:58] = 128
    x = np.arange(SIDE)
    pictures = photograph([(6.0, 0.05, 0.0, texture, everywhere)], matrices(), SIDE)
    d = labels(match_patches(pictures, matrices(), (SIDE, SIDE), 16.0)[0])
    assert np.abs(d - (6 + 0.05 * x))[38:58, 38:58].mean() < 0.5


def test_views_that_do_not_see_a_point_have_no_say():
    def pillar(x, y):
        return abs(x - 48) < 12

    y, x = np.mgrid[0:SIDE, 0:SIDE]
    truth = np.where(pillar(x, y), 14.0, 5.0)
    pictures = photograph([(14.0, 0, 0, paint(2), pillar), (5.0, 0, 0, paint(3), everywhere)], matrices(), SIDE)
    d = labels(match_patches(pictures, matrices(), (SIDE, SIDE), 16.0)[0])
    beside = (abs(x - 48) > 15) & (abs(x - 48) < 22) & (abs(y - 48) < 30)
    assert (np.abs(d - truth)[beside] < 0.5).mean() > 0.85


def test_other_maps_decide_where_the_photographs_do_not():
    """Everything is plain: only the maps of the others tell, which show label 10."""
    half = SIDE // 2
    pictures = np.full((len(PLACES), SIDE, SIDE, 3), 128, np.uint8)
    depths = np.full((len(PLACES) - 1, half, half), 1.0, np.float32)
    others = OtherMaps(depths, 0.0, 0.1, 0.05, np.full((1, half, half), 10, np.float32))
    start = np.zeros((half, half, 3), np.float32)
    start[..., 0] = 3.0
    planes, _ = match_patches(pictures, matrices(), (SIDE, SIDE), 16.0, planes=start, others=others)
    assert np.abs(planes[4:-4, 4:-4, 0] - 10).max() < 0.3


def test_where_other_maps_show_nothing_no_label_is_tried(slanted):
    pictures, _ = slanted
    half = SIDE // 2
    depths = np.zeros((len(PLACES) - 1, half, half), np.float32)
    found = [
        match_patches(pictures, matrices(), (SIDE, SIDE), 16.0, others=OtherMaps(depths, 0.0, 0.1, 0.05, labels))
        for labels in (np.full((2, half, half), np.nan, np.float32), np.zeros((0, half, half), np.float32))
    ]
    assert all(np.array_equal(some, none) for some, none in zip(*found, strict=True))


def test_one_thread_and_three_give_the_same(slanted):
    try:
        set_threads(1)
        one = match_patches(slanted[0], matrices(), (SIDE, SIDE), 16.0)
        set_threads(3)
        three = match_patches(slanted[0], matrices(), (SIDE, SIDE), 16.0)
    finally:
        set_threads(None)
    assert all(a.tobytes() == b.tobytes() for a, b in zip(one, three, strict=True))


@pytest.mark.parametrize("shape", [(7, 9), (8, 8)])
def test_points_between_lie_on_the_planes(shape):
    y, x = np.mgrid[: (shape[0] + 1) // 2, : (shape[1] + 1) // 2].astype(np.float32)
    planes = np.stack([1 + 0.4 * x - 0.2 * y, np.full_like(x, 0.4), np.full_like(x, -0.2)], axis=-1)
    j, i = np.mgrid[: shape[0], : shape[1]]
    expected = 1 + 0.4 * ((i + 0.5) / 2 - 0.5) - 0.2 * ((j + 0.5) / 2 - 0.5)
    assert np.abs(upsample_planes(planes, shape) - expected).max() < 1e-5
