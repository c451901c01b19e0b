"""What frames after the first of a group are fitted to: nothing that changes is left out."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.core.proxy import Proxy
from eigenfield.encoding import EncodeOptions, encode_footage
from eigenfield.encoding.clip.active import active_texels, open_active_plane
from eigenfield.encoding.clip.plan import ClipPlan
from eigenfield.encoding.fitted.fit import PlaneSettings
from eigenfield.encoding.fitted.kernels import adjoint
from eigenfield.encoding.fitted.observations import open_camera_footprints
from eigenfield.rendering import draw_texture
from support.captures import backdrop, shaded_texture
from support.moving_clips import FootageInMemory
from support.observations import CalibratedInMemory, InMemory
from support.scenes import row_grid

CAMERAS, MESH = row_grid(6, 64, 56), backdrop()
SETTINGS = PlaneSettings(np.ones((1, 3), np.float32) / 3, (96, 96), (32, 32), 3)
NO_MASK = np.zeros((0, 0), np.uint8)


def square(camera: int) -> np.ndarray:
    """One pixel region of the third camera moves."""
    moves = np.zeros((CAMERAS[camera].height, CAMERAS[camera].width), np.bool_)
    if camera == 2:
        moves[20:28, 24:34] = True
    return moves


def test_pixels_that_are_left_out_see_no_texel_that_changes():
    with (
        open_camera_footprints(CAMERAS, Proxy(MESH), (128, 128)) as whole,
        open_active_plane(whole, active_texels(whole, SETTINGS, square), square, None) as active,
    ):
        kept = [active.footprints.of(camera)[0] > 0 for camera in range(len(CAMERAS))]
        every = [whole.of(camera)[0] > 0 for camera in range(len(CAMERAS))]
        for changes in (active.mean, active.coarse):
            assert 0 < changes.sum() < changes.size / 4
            for camera, (few, all_) in enumerate(zip(kept, every, strict=True)):
                assert few[square(camera) & all_].all() and few.any()  # the other cameras see those texels too
                seen = np.zeros((1, *changes.shape), np.float32)
                adjoint(*whole.of(camera), whole.surface.size, (all_ & ~few)[None].astype(np.float32), NO_MASK, seen)
                assert np.abs(seen[0][changes]).max() < 1e-4
        assert sum(few.sum() for few in kept) < 0.5 * sum(all_.sum() for all_ in every)


def test_points_of_a_pixel_that_is_kept_are_its_own():
    with (
        open_camera_footprints(CAMERAS, Proxy(MESH), (128, 128)) as whole,
        open_active_plane(whole, active_texels(whole, SETTINGS, square), square, None) as active,
    ):
        counts, points, _ = whole.of(2)
        few, own, _ = active.footprints.of(2)
        kept = np.repeat((few > 0).reshape(-1), counts.reshape(-1))
        np.testing.assert_array_equal(own, points[kept])


@pytest.fixture(scope="module")
def waving():
    """Four frames in which a small square wanders before a backdrop that stands still."""
    drawn = [draw_texture(MESH, shaded_texture(i, 6), camera, samples=2).image for i, camera in enumerate(CAMERAS)]
    frames = []
    for number in range(4):
        pictures = [np.array(one, np.float32) for one in drawn]
        for one in pictures:
            one[22:30, 20 + 4 * number : 28 + 4 * number] = 0.9
        frames.append(CalibratedInMemory(InMemory(pictures), CAMERAS))
    return FootageInMemory(frames, [])


@pytest.mark.slow
def test_a_group_is_as_good_as_one_that_is_fitted_as_a_whole(waving, monkeypatch):
    options = EncodeOptions(quality=90)
    quick = encode_footage(waving, MESH, options, group="4")
    open_frame = ClipPlan.open_frame
    monkeypatch.setattr(ClipPlan, "open_frame", lambda plan, number, photos, active: open_frame(plan, number, photos))
    whole = encode_footage(waving, MESH, options, group="4")
    before, after = (np.mean(one.settings["clip"]["psnr"]) for one in (whole, quick))
    sizes = [sum(len(unit) for frame in one.groups.coded(0).units for unit in frame) for one in (whole, quick)]
    assert after > before - 0.1 and sizes[1] < 1.05 * sizes[0]
