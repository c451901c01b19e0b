"""Clips on a static sheet and a moving one: depth and opacity change with time, and what stands still stays."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from eigenfield.core.errors import OptionError, ProxyError
from eigenfield.core.proxy import MovingProxy
from eigenfield.encoding import EncodeOptions, encode_footage
from eigenfield.encoding.clip.motion import moving_mesh
from eigenfield.encoding.prepare import plan_encoding
from eigenfield.gltf import load_clip, parts, save, validate
from eigenfield.imaging.metrics import psnr, to_codes
from eigenfield.rendering import Renderer, camera_weights, view_weights
from eigenfield.runtime.executor import open_executor
from support.moving_sheet import CAMERAS, MIDDLE, chart_of_disc, filmed, sheets, true_opacity, wall

pytestmark = pytest.mark.slow

FRAMES = 8
OPTIONS = EncodeOptions(quality=85, hold_out="every:4")
HELD_OUT = tuple(range(2, len(CAMERAS), 4))


@pytest.fixture(scope="module")
def footage():
    return filmed(FRAMES)


@pytest.fixture(scope="module")
def flying(footage, tmp_path_factory):
    return encode_footage(footage, sheets(FRAMES), OPTIONS, group="8", work=tmp_path_factory.mktemp("work"))


def scene_at(clip, number):
    return clip.scene(float(clip.timeline.times[number]))


def drawn(scene, camera):
    """The picture of a camera, with weights of its own or, of a held-out one, of the view."""
    weights = (
        view_weights(scene, scene.rig.cameras[camera].centre)
        if scene.rig.held_out[camera]
        else camera_weights(scene, camera)
    )
    return Renderer(scene).draw(scene.rig.cameras[camera], weights)


def measured(clip, footage, cameras, numbers=range(FRAMES)):
    """dB, the mean over frames and some cameras."""
    found = []
    for number in numbers:
        scene = scene_at(clip, number)
        for camera in cameras:
            pixels = to_codes(footage.frames[number].photograph(camera).pixels)
            found.append(psnr(drawn(scene, camera).image, pixels))
    return float(np.mean(found))


def test_a_moving_sheet_shows_far_more_than_the_still_surface(footage, flying):
    few = replace(footage, frames=footage.frames[::2])
    still = encode_footage(few, wall(), OPTIONS, group="8")
    others = [camera for camera in range(len(CAMERAS)) if camera not in HELD_OUT]
    for cameras, gain in ((others, 6.0), (HELD_OUT, 6.0)):
        found = measured(flying, footage, cameras, range(0, FRAMES, 2))
        assert found > measured(still, few, cameras, range(FRAMES // 2)) + gain, cameras


def grown(frame):
    """The disc and a soft rim that is not there."""
    return cv2.GaussianBlur(cv2.dilate(true_opacity(frame), np.ones((3, 3))), (0, 0), 0.7)


def opacity_error(clip, number):
    return np.abs(chart_of_disc(scene_at(clip, number).proxy.sheets.opacity) - true_opacity(number)).mean()


def test_the_opacity_of_each_frame_stays_right_and_comes_nearer_to_the_truth(footage, flying):
    short = replace(footage, frames=footage.frames[:4])
    found = encode_footage(short, sheets(4, grown), OPTIONS, group="4")
    for number in (0, 3):
        given = np.abs(grown(number) - true_opacity(number)).mean()
        assert opacity_error(flying, number) < 0.004 and opacity_error(found, number) < 0.95 * given


def test_what_stands_still_is_drawn_alike_in_all_frames_and_is_opaque(footage, flying):
    for camera in (0, MIDDLE, 14):
        photographs = np.stack([one.photograph(camera).pixels for one in footage.frames])
        still = np.ptp(photographs, axis=0).max(axis=2) < 1e-6
        still = cv2.erode(still.astype(np.uint8), np.ones((17, 17), np.uint8)).astype(bool)
        pictures = [drawn(scene_at(flying, number), camera) for number in range(FRAMES)]
        assert still.mean() > 0.1
        changes = np.ptp(np.stack([to_codes(one.image) for one in pictures]).astype(int), axis=0).max(axis=2)[still]
        assert np.quantile(changes, 0.9) <= 3
        assert min(one.coverage[still].min() for one in pictures) > 0.995


def test_sheets_of_a_clip_are_saved_and_loaded(flying, tmp_path):
    save(flying, tmp_path / "clip.glb")
    assert validate(tmp_path / "clip.glb") == []
    loaded = load_clip(tmp_path / "clip.glb")
    given = sheets(FRAMES)
    for number in (0, 6):
        found = scene_at(loaded, number).proxy
        assert found.sheets.faces[1] == given.proxy.sheets.faces[1]
        assert np.array_equal(found.sheets.opacity, scene_at(flying, number).proxy.sheets.opacity)
        depth = found.mesh.vertices[found.mesh.faces[found.sheets.faces[0] :]][..., 2]
        np.testing.assert_allclose(depth, given.positions[number, -1, 2], atol=0.01)
    sizes = parts(tmp_path / "clip.glb")
    films = sizes["mean"] + sizes["textures"] + sizes["opacity"]
    assert sizes["opacity"] < films / 6 and len(loaded.groups.coded(0).motion.data) < films / 10


@pytest.mark.slow
def test_workers_make_the_same_groups_of_sheets(footage, tmp_path):
    short = replace(footage, frames=footage.frames[:4])
    alone = encode_footage(short, sheets(4), OPTIONS, group="2")
    with open_executor(2) as workers:
        spread = encode_footage(short, sheets(4), OPTIONS, group="2", work=tmp_path, workers=workers)
    for one, other in zip(alone.groups.stored, spread.groups.stored, strict=True):
        assert one.data.read(0, one.data.size) == other.data.read(0, other.data.size)


def test_sheets_on_which_nothing_moves_cost_a_frame_next_to_nothing():
    given = sheets(1)
    repeated = MovingProxy(given.proxy, np.repeat(given.positions, 5, axis=0), np.repeat(given.opacity, 5, axis=0))
    clip = encode_footage(filmed(5, frozen=0), repeated, OPTIONS, group="5")
    group = clip.groups.coded(0)
    sizes = [sum(map(len, units)) for units in group.units]
    assert group.motion is None and sum(sizes[1:]) < sizes[0] / 8  # a unit has a head
    first, last = (scene_at(clip, number).proxy.sheets.opacity for number in (0, 4))
    assert np.abs(first - last).max() < 0.02


def test_the_static_sheet_keeps_the_triangles_that_are_worth_their_bytes_and_the_moving_one_all(footage):
    given, two = sheets(2, spacing=3), replace(footage, frames=footage.frames[:2])
    clip = encode_footage(two, given, OPTIONS, group="2")
    (few, moving), (many, all_) = scene_at(clip, 0).proxy.sheets.faces, given.proxy.sheets.faces
    assert few < many / 4 and moving == all_
    for number in (0, 1):
        mesh = scene_at(clip, number).proxy.mesh
        depth = mesh.vertices[..., 2]
        still = np.unique(mesh.faces[:few])
        np.testing.assert_allclose(depth[still], wall().vertices[0, 2], atol=0.1)  # a tenth is 0.2 pixels
        np.testing.assert_allclose(np.delete(depth, still), given.positions[number, -1, 2], atol=0.01)


def test_a_moving_surface_without_sheets_is_a_mesh_for_each_frame(footage):
    two, mesh = replace(footage, frames=footage.frames[:2]), wall()
    moved = np.stack([mesh.vertices, mesh.vertices * np.float32(1.001)])
    given = MovingProxy(replace(sheets(1).proxy, mesh=mesh, sheets=None), moved)
    made = [encode_footage(two, one, OPTIONS, group="2") for one in (given, [replace(mesh, vertices=v) for v in moved])]
    assert made[0].groups.coded(0).units == made[1].groups.coded(0).units


def test_pixels_that_see_the_sheet_move_are_known(footage):
    given = sheets(FRAMES)
    plan = plan_encoding(footage.frames[0], given.proxy, EncodeOptions(), exact=True)
    moving = moving_mesh(plan, given.positions, opacity=given.opacity)
    found = moving.moving_pixels(CAMERAS[MIDDLE], range(2, 5))
    covered = np.max([true_opacity(number) for number in range(2, 5)], axis=0)
    assert found[covered > 0.3].all() and not found[cv2.dilate(covered, np.ones((3, 3))) == 0].any()
    still = replace(moving, frames=np.repeat(moving.frames[:1], FRAMES, axis=0))
    assert not replace(still, opacity=np.repeat(given.opacity[:1], FRAMES, 0)).moving_pixels(CAMERAS[4], range(4)).any()


def test_a_surface_for_other_footage_and_options_without_a_meaning_are_refused(footage):
    with pytest.raises(ProxyError, match="8 frames, the clip has 2") as error:
        encode_footage(replace(footage, frames=footage.frames[:2]), sheets(FRAMES), OPTIONS)
    assert error.value.code == "proxy-count"
    for given in ({"triangles": 100}, {"fit": "none"}):
        with pytest.raises(OptionError) as refused:
            encode_footage(footage, sheets(FRAMES), **given)
        assert refused.value.code == "clip-option"
