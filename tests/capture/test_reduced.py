"""Captures whose photographs are made smaller on reading."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from eigenfield.capture import LightField, View, open_any
from eigenfield.capture.layout import GridLayout
from eigenfield.capture.photographs.lens import Lens
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError

CAMERA = Camera(np.array([[90.0, 0, 33.5], [0, 90.0, 22.5], [0, 0, 1]]), np.eye(3), np.zeros(3), 67, 46)


def light_field(folder, pixels, mask=None, lens=None):
    Image.fromarray(pixels).save(folder / "a.png")
    if mask is not None:
        Image.fromarray(mask).save(folder / "mask.png")
    view = View("a.png", folder / "a.png", CAMERA, lens, None if mask is None else folder / "mask.png")
    return LightField(folder, (view,), (), "transforms")


def means(values, factor):
    height, width = (side // factor for side in values.shape[:2])
    squares = values[: height * factor, : width * factor].reshape(height, factor, width, factor, -1)
    return squares.mean(axis=(1, 3)).reshape(height, width, *values.shape[2:])


@pytest.mark.parametrize("factor", [2, 3, 5])
def test_a_pixel_is_the_mean_of_a_square_and_lies_where_it_lay(tmp_path, factor):
    rng = np.random.default_rng(factor)
    pixels = rng.integers(0, 256, (46, 67, 3), np.uint8)
    mask = (rng.random((46, 67)) < 0.7).astype(np.uint8) * 255
    small = light_field(tmp_path, pixels, mask).reduced(factor)
    photograph, camera = small.photograph(0), small.cameras[0]
    assert (camera.width, camera.height) == (67 // factor, 46 // factor) == small.sizes[0]
    np.testing.assert_allclose(photograph.pixels, means(pixels / 255, factor), atol=1e-5)
    np.testing.assert_allclose(photograph.mask, means(mask / 255, factor), atol=1e-5)
    point = np.array([0.2, -0.1, 1.5])
    np.testing.assert_allclose((camera.K @ point)[:2] / 1.5 * factor, (CAMERA.K @ point)[:2] / 1.5)


def test_twice_is_once_by_the_product(tmp_path):
    pixels = np.random.default_rng(0).integers(0, 256, (46, 67, 3), np.uint8)
    whole = light_field(tmp_path, pixels)
    twice, once = whole.reduced(2).reduced(3), whole.reduced(6)
    np.testing.assert_array_equal(twice.photograph(0).pixels, once.photograph(0).pixels)
    np.testing.assert_allclose(twice.cameras[0].K, once.cameras[0].K)


def test_the_lens_is_removed_at_the_smaller_size(tmp_path):
    row, column = np.mgrid[:46, :67]
    pixels = np.stack([2 * column, 3 * row, column + row], axis=-1).astype(np.uint8)
    whole = light_field(tmp_path, pixels, lens=Lens("brown", (0.05, 0.0, 0.0, 0.0, 0.0)))
    small = whole.reduced(2)
    inner = np.s_[5:-5, 5:-5]
    found, wanted = small.photograph(0).pixels, means(whole.photograph(0).pixels, 2)
    assert np.abs(found - wanted)[inner].max() < 1.5 / 255


def test_photographs_without_cameras_have_a_shorter_focal_length(tmp_path):
    for name, grey in (("a.png", 30), ("b.png", 60), ("c.png", 90)):
        Image.fromarray(np.full((40, 61, 3), grey, np.uint8)).save(tmp_path / name)
    photos = open_any(tmp_path)
    shots = tuple(replace(shot, focal=50.0) for shot in photos.shots)
    grid = GridLayout(np.zeros(3, np.int64), np.arange(3), np.zeros((3, 2)), focal=50.0)
    small = replace(photos, shots=shots, layout=grid).reduced(4)
    assert small.sizes == [(15, 10)] * 3 and small.shots[0].focal == small.layout.focal == 12.5
    assert small.photograph(1).pixels.shape == (10, 15, 3)
    light = small.with_cameras([replace(CAMERA, width=15, height=10)] * 3)
    assert light.photograph(0).pixels.shape == (10, 15, 3)


def test_a_file_that_has_changed_is_named_with_the_size_it_had(tmp_path):
    pixels = np.zeros((46, 67, 3), np.uint8)
    small = light_field(tmp_path, pixels).reduced(2)
    Image.fromarray(pixels[:30]).save(tmp_path / "a.png")
    with pytest.raises(CaptureError, match=r"a\.png.* 67x30 now, but was 66x46") as caught:
        small.photograph(0)
    assert caught.value.code == "image-size"
