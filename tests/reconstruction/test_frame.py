"""Photographs as depth estimation gets them."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from eigenfield.capture import open_any
from eigenfield.capture.photographs.colour import encode_srgb
from eigenfield.imaging.colour import linear_of_srgb
from eigenfield.reconstruction.frame import read_pictures
from support.captures import write_array


@pytest.fixture
def photos(tmp_path):
    write_array(tmp_path / "photos", side=3, pixels=64)
    return tmp_path / "photos"


def darkened(photos, stops, step=2):
    for path in sorted(photos.iterdir())[::step]:
        with Image.open(path) as picture:
            light = linear_of_srgb(np.asarray(picture) / 255) * 0.5**stops
        Image.fromarray(np.rint(encode_srgb(light.astype(np.float32)) * 255).astype(np.uint8)).save(path)
    return read_pictures(open_any(photos))


def test_photographs_far_too_dark_get_the_brightness_of_the_others(photos):
    sound = read_pictures(open_any(photos))
    levelled = darkened(photos, stops=4)
    assert np.array_equal(levelled[1::2], sound[1::2])
    assert np.abs(levelled[::2].astype(int) - sound[::2]).mean() < 8


@pytest.mark.parametrize(("stops", "step"), [(1, 2), (4, 9)])
def test_small_differences_of_exposure_and_exceptions_stay(photos, stops, step):
    pictures = darkened(photos, stops, step)
    for path, picture in zip(sorted(photos.iterdir()), pictures, strict=True):
        with Image.open(path) as file:
            assert np.array_equal(picture, np.asarray(file))
