"""Photographs as depth estimation gets them."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from eigenfield.capture import open_any, open_capture
from eigenfield.capture.photographs.colour import encode_srgb
from eigenfield.imaging.colour import linear_of_srgb
from eigenfield.reconstruction.frame import (
    common_frame,
    frame_places,
    full_size_cameras,
    has_masks,
    read_depth_pictures,
    read_masks,
    read_pictures,
    resized_cameras,
    shown_pixels,
)
from eigenfield.reconstruction.layered import capture_fault
from eigenfield.stereo.views import codes_of, inside_pictures
from support.captures import frame_of, write_array, write_capture
from support.scenes import row_grid


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


@pytest.mark.parametrize("k1", [0.0, 0.05])
def test_alpha_is_a_mask_and_the_border_of_a_lens_is_none(k1, tmp_path):
    cameras = row_grid(4, 64, 48)
    frames = [{**frame_of(camera, f"{index}.png"), "k1": k1} for index, camera in enumerate(cameras)]
    (tmp_path / "transforms.json").write_text(json.dumps({"frames": frames}), encoding="utf-8")

    def opened(hidden, masks=None):
        """With hidden columns at the left of the last photograph alone."""
        for index in range(4):
            pixels = np.full((48, 64, 4), 255, np.uint8)
            pixels[:, : hidden if index == 3 else 0, 3] = 0
            Image.fromarray(pixels).save(tmp_path / f"{index}.png")
        return open_capture(tmp_path, masks=masks)

    shown = opened(hidden=0)
    assert (shown.photograph(0).mask is None) == (k1 == 0)
    assert read_masks(shown) is None and capture_fault(shown) is None
    cut = opened(hidden=20)
    assert capture_fault(cut) == "photographs with masks have no layers" and not has_masks(cut, most=3)
    masks = read_masks(cut)
    assert (masks[:3] == 255).all() and (masks[3, :, :16] == 0).all() and (masks[3, 5:-5, 24:-5] == 255).all()
    folder = tmp_path / "masks"
    folder.mkdir()
    for index in range(4):
        Image.new("L", (64, 48), 255).save(folder / f"{index}.png")
    assert read_masks(opened(hidden=0, masks=folder)) is None


def test_photographs_that_cannot_hide_anything_are_not_decoded(photos):
    path = min(photos.iterdir())
    path.write_bytes(path.read_bytes()[:200])
    assert not has_masks(open_any(photos))


@pytest.fixture
def mixed(tmp_path):
    """Cameras that lie and stand in turn."""
    cameras = [
        camera if index % 2 else replace(camera, K=camera.K[[1, 0, 2]][:, [1, 0, 2]], width=40, height=48)
        for index, camera in enumerate(row_grid(4))
    ]
    return open_any(write_capture(tmp_path / "mixed", tuple(cameras)))


@pytest.mark.parametrize("pixels", [1e9, 4 * 24**2])
def test_photographs_lie_in_the_middle_of_their_frame_with_their_cameras(mixed, monkeypatch, pixels):
    monkeypatch.setattr("eigenfield.reconstruction.frame.FRAME_MAX_TOTAL_PIXELS", pixels)
    small = common_frame(mixed)[1]
    assert common_frame(mixed)[0] == (48, 48) and small[0] in (48, 24)
    pictures, places = read_depth_pictures(mixed), frame_places(mixed)
    for index, (place, camera) in enumerate(zip(places, resized_cameras(mixed), strict=True)):
        assert [part.stop - part.start for part in place] == [
            side * small[0] // 48 for side in mixed.sizes[index][::-1]
        ]
        around = (48 - np.array(mixed.sizes[index])) / 2
        assert camera.K[:2, 2] == pytest.approx((mixed.cameras[index].K[:2, 2] + around) * small[0] / 48)
        if small[0] == 48:
            shown = np.rint(mixed.photograph(index).pixels * 255)
            assert np.array_equal(codes_of(pictures)[index][place], shown)
    inside = np.zeros((4, *small), np.bool_)
    for one, place in zip(inside, places, strict=True):
        one[place] = True
    assert np.array_equal(inside_pictures(pictures), inside) and np.array_equal(shown_pixels(mixed), inside)
    for camera, again in zip(mixed.cameras, full_size_cameras(mixed, resized_cameras(mixed)), strict=True):
        assert np.allclose(camera.K, again.K) and (camera.width, camera.height) == (again.width, again.height)
