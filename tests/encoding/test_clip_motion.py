"""Clips on a mesh for each frame: what moves is drawn where it is, and what stands still does not notice."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np
import pytest

from eigenfield.core.errors import EigenfieldError, FormatError, OptionError, ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.encoding import EncodeOptions, Target, encode_footage
from eigenfield.encoding.clip import plan, target
from eigenfield.gltf import load_clip, parts, save, validate
from eigenfield.gltf.clips import StoredGroup
from eigenfield.gltf.group import group_bytes
from eigenfield.gltf.source import HeldBytes
from eigenfield.imaging.metrics import psnr, to_codes
from eigenfield.proxy import write_ply
from eigenfield.rendering import Renderer, camera_weights, view_weights
from eigenfield.runtime.executor import open_executor
from support.moving_plate import CAMERAS, filmed, staged

pytestmark = pytest.mark.slow

OPTIONS = EncodeOptions(quality=85, hold_out="every:4")
HELD_OUT = 2, 6
FRAMES = 6


@pytest.fixture(scope="module")
def plate():
    return filmed(FRAMES, speed=1.4)


@pytest.fixture(scope="module")
def moving(plate, tmp_path_factory):
    meshes, footage = plate
    work = tmp_path_factory.mktemp("work")
    return encode_footage(footage, meshes, OPTIONS, group="6", work=work)


def test_a_clip_is_the_same_where_there_is_no_room_for_what_passes_need_again(plate, moving, monkeypatch):
    meshes, footage = plate
    monkeypatch.setattr(plan, "CACHE_MAX_BYTES", 0)
    again = encode_footage(footage, meshes, OPTIONS, group="6")
    assert group_bytes(again.groups.coded(0)) == group_bytes(moving.groups.coded(0))


def drawn(clip, number, camera):
    """The picture of a camera at a frame, with weights of its own or, of a held-out one, of the view."""
    scene = clip.scene(float(clip.timeline.times[number]))
    weights = (
        view_weights(scene, scene.rig.cameras[camera].centre)
        if scene.rig.held_out[camera]
        else camera_weights(scene, camera)
    )
    return Renderer(scene).draw(scene.rig.cameras[camera], weights)


def measured(clip, footage, number, cameras):
    """dB at a frame, the mean over some cameras."""
    found = []
    for camera in cameras:
        picture = drawn(clip, number, camera)
        pixels = to_codes(footage.frames[number].photograph(camera).pixels)
        found.append(psnr(picture.image, pixels, picture.covered))
    return float(np.mean(found))


def test_moving_geometry_shows_far_more_than_still_geometry(plate, moving):
    meshes, footage = plate
    still = encode_footage(footage, meshes[0], OPTIONS, group="6")
    others = [camera for camera in range(len(CAMERAS)) if camera not in HELD_OUT]
    for cameras, gain in ((others, 4.0), (HELD_OUT, 3.0)):
        found = [np.mean([measured(one, footage, number, cameras) for number in range(2, FRAMES)])
                 for one in (moving, still)]  # fmt: skip
        assert found[0] > found[1] + gain, cameras


def test_what_stands_still_is_drawn_alike_in_all_frames(plate, moving):
    _, footage = plate
    for camera in (0, 4, 8):
        photographs = np.stack([one.photograph(camera).pixels for one in footage.frames])
        still = np.ptp(photographs, axis=0).max(axis=2) < 1e-6
        still = cv2.erode(still.astype(np.uint8), np.ones((17, 17), np.uint8)).astype(bool)  # shadows of other cameras
        pictures = np.stack([to_codes(drawn(moving, number, camera).image) for number in range(FRAMES)])
        assert still.mean() > 0.05
        changes = np.ptp(pictures.astype(int), axis=0).max(axis=2)[still]
        assert np.quantile(changes, 0.9) <= 3


def test_each_frame_has_its_own_mesh_and_motion_takes_few_bytes(plate, moving, tmp_path):
    meshes, _ = plate
    save(moving, tmp_path / "clip.glb")
    assert validate(tmp_path / "clip.glb") == []
    loaded = load_clip(tmp_path / "clip.glb")
    for number, time in enumerate(loaded.timeline.times):
        found, given = loaded.scene(float(time)).proxy.mesh, meshes[number]
        away = np.linalg.norm(found.vertices[:, None] - given.vertices[None], axis=2).min(axis=1)
        assert away.max() < 0.03 and len(found.faces) == len(given.faces)  # half a pixel is 0.02 to 0.03 there
        np.testing.assert_array_equal(found.uv, loaded.scene(0.0).proxy.mesh.uv)
    motion, sizes = len(loaded.groups.coded(0).motion.data), parts(tmp_path / "clip.glb")
    assert motion < (sizes["mean"] + sizes["textures"]) / 5
    assert sizes["mesh"] >= motion


def test_meshes_that_stand_still_are_no_motion(plate):
    meshes, footage = plate
    same = replace(footage, frames=[footage.frames[0]] * 4)
    clip = encode_footage(same, [meshes[0]] * 4, OPTIONS, group="4")
    assert clip.groups.coded(0).motion is None
    assert np.array_equal(clip.scene(0.0).proxy.mesh.vertices, clip.scene(0.5).proxy.mesh.vertices)


@pytest.mark.slow
def test_workers_make_the_same_groups_and_each_begins_anew(plate, tmp_path):
    meshes, footage = plate
    alone = encode_footage(footage, meshes, OPTIONS, group="3")
    with open_executor(2) as workers:
        spread = encode_footage(footage, meshes, OPTIONS, group="3", work=tmp_path, workers=workers)
    for one, other in zip(alone.groups.stored, spread.groups.stored, strict=True):
        assert one.data.read(0, one.data.size) == other.data.read(0, other.data.size)
    vertices = [alone.scene(float(time)).proxy.mesh.vertices for time in alone.timeline.times]
    again = [alone.scene(float(alone.timeline.times[number])).proxy.mesh.vertices for number in (4, 3, 5)]
    for number, found in zip((4, 3, 5), again, strict=True):
        np.testing.assert_array_equal(found, vertices[number])
    assert all((one != other).any() for one, other in pairwise(vertices))


def test_files_of_a_numbered_sequence_are_the_same_as_meshes_in_memory(plate, moving, tmp_path):
    meshes, footage = plate
    for number, mesh in enumerate(meshes):
        write_ply(mesh, tmp_path / f"mesh_{number + 7:04d}.ply")
    clip = encode_footage(footage, tmp_path / "mesh_%04d.ply", OPTIONS, group="6")
    one, other = clip.groups.stored[0].data, moving.groups.stored[0].data
    assert one.read(0, one.size) == other.read(0, other.size)


def sequence_in(folder, meshes):
    folder.mkdir()
    for number, mesh in enumerate(meshes):
        write_ply(mesh, folder / f"mesh_{number:04d}.ply")
    return folder / "mesh_%04d.ply"


def other_triangles(mesh):
    """The same surface with other triangles and other texture coordinates: the halves of its atlas change places."""
    uv = mesh.uv.copy()
    uv[:, 0] = np.where(uv[:, 0] < 0.5, uv[:, 0] + 0.5, uv[:, 0] - 0.5)
    return Mesh(mesh.vertices, np.roll(mesh.faces[::-1], 1, axis=1), uv)


@pytest.fixture(scope="module")
def retopologised(plate):
    """From frame 3 on, another mesh."""
    meshes, footage = plate
    given = [*meshes[:3], *map(other_triangles, meshes[3:])]
    return given, encode_footage(footage, given, OPTIONS, group="6")


def test_other_triangles_begin_a_group_and_are_drawn_as_well(plate, moving, retopologised, tmp_path):
    _, footage = plate
    meshes, clip = retopologised
    assert clip.groups.lengths == [3, 3]
    assert [clip.groups.coded(number).mesh is not None for number in range(2)] == [False, True]
    save(clip, tmp_path / "clip.glb")
    assert validate(tmp_path / "clip.glb") == []
    loaded = load_clip(tmp_path / "clip.glb")
    for number in (4, 1, 3, 5):
        found, given = loaded.scene(float(loaded.timeline.times[number])).proxy.mesh, meshes[number]
        away = np.linalg.norm(found.vertices[:, None] - given.vertices[None], axis=2).min(axis=1)
        assert away.max() < 0.03 and len(found.faces) == len(given.faces)
        centres, given = found.uv[found.faces].mean(axis=1), given.uv[given.faces].mean(axis=1)
        assert np.linalg.norm(centres[:, None] - given[None], axis=2).min(axis=1).max() < 0.01
        for cameras in ((0, 4), HELD_OUT):
            assert measured(loaded, footage, number, cameras) > measured(moving, footage, number, cameras) - 1.0
    assert parts(tmp_path / "clip.glb")["mesh"] > len(clip.groups.coded(1).mesh.data)


def test_a_target_counts_the_meshes_of_later_groups(plate, monkeypatch):
    meshes, footage = plate
    two, tried = replace(footage, frames=footage.frames[:2]), []
    monkeypatch.setattr(target, "search_quality", lambda _, code, first: tried.append(code(first)) or tried[-1])
    options = EncodeOptions(target=Target(size=20_000))
    clip = encode_footage(two, [meshes[0], other_triangles(meshes[1])], options, group="1")
    beside = clip.groups.payloads.bytes + target.HEAD_BYTES
    assert abs(tried[-1].size - beside - sum(one.data.size for one in clip.groups.stored)) < 50
    assert len(clip.groups.coded(1).mesh.data) > 400


def test_a_damaged_mesh_of_a_group_costs_this_group_alone(retopologised):
    _, clip = retopologised
    coded = clip.groups.coded(1)
    data = bytearray(coded.mesh.data)
    data[len(data) // 2] ^= 255
    broken = group_bytes(replace(coded, mesh=replace(coded.mesh, data=bytes(data[: len(data) // 2]))))
    groups = replace(clip.groups, stored=[clip.groups.stored[0], StoredGroup(HeldBytes(broken), 3)])
    damaged = replace(clip, groups=groups)
    damaged.scene(0.0)
    with pytest.raises(FormatError) as caught:
        damaged.scene(float(clip.timeline.times[4]))
    assert caught.value.code.startswith("coded-") and "groups/1" in str(caught.value)


def test_workers_make_groups_on_meshes_of_their_own(plate, retopologised, tmp_path):
    _, footage = plate
    meshes, clip = retopologised
    with open_executor(None) as workers:
        spread = encode_footage(footage, meshes, OPTIONS, group="6", work=tmp_path, workers=workers)
    for one, other in zip(clip.groups.stored, spread.groups.stored, strict=True):
        assert one.data.read(0, one.data.size) == other.data.read(0, other.data.size)


@pytest.mark.parametrize(
    ("change", "code", "words"),
    [
        (lambda folder: (folder / "mesh_0002.ply").unlink(), "proxy-gap", "mesh 2 of those from 0 to 3 is not there"),
        (lambda folder: (folder / "mesh_0003.ply").unlink(), "proxy-count", "3 meshes, the clip has 4 frames"),
        (lambda folder: write_ply(staged(4), folder / "mesh_0004.ply"), "proxy-count", "5 meshes, the clip has 4"),
        (lambda folder: (folder / "mesh_0001.ply").write_bytes(b"ply nonsense"), "proxy-unreadable", "mesh_0001.ply"),
        (lambda folder: [one.unlink() for one in folder.iterdir()], "proxy-missing", "no mesh has such a name"),
    ],
)  # fmt: skip
def test_sequences_that_are_none_are_one_clear_line(plate, tmp_path, change, code, words):
    meshes, footage = plate
    pattern = sequence_in(tmp_path / "meshes", meshes[:4])
    change(tmp_path / "meshes")
    with pytest.raises(ProxyError) as caught:
        encode_footage(replace(footage, frames=footage.frames[:4]), pattern, OPTIONS)
    assert caught.value.code == code and words in str(caught.value) and len(str(caught.value).splitlines()) == 1
    assert "one mesh for each frame" in str(caught.value) or code == "proxy-unreadable"


def test_meshes_that_cannot_be_are_named_by_their_frame(plate):
    meshes, footage = plate
    two = replace(footage, frames=footage.frames[:2])
    broken, behind = meshes[1].vertices.copy(), meshes[1].vertices.copy()
    broken[5, 0], behind[5, 2] = np.nan, -5
    for vertices, code in ((broken, "proxy-not-finite"), (behind, "proxy-motion")):
        with pytest.raises(ProxyError) as caught:
            encode_footage(two, [meshes[0], replace(meshes[1], vertices=vertices)], OPTIONS)
        assert caught.value.code == code and "frame 1" in str(caught.value)


def test_more_motion_than_a_file_may_have_is_refused_before_any_work(plate, monkeypatch):
    meshes, footage = plate
    monkeypatch.setattr("eigenfield.coding.limits.MAX_MOTION", 64 * FRAMES - 1)
    with pytest.raises(ProxyError) as caught:
        encode_footage(footage, meshes, OPTIONS, group="6")
    assert caught.value.code == "proxy-motion" and "64 vertices move in a group of 6 frames" in str(caught.value)
    assert "group" in caught.value.remedy


@pytest.mark.parametrize("wrong", [5, [1, 2], "meshes"])
def test_what_is_no_mesh_is_named(plate, wrong):
    meshes, footage = plate
    with pytest.raises(EigenfieldError) as caught:
        encode_footage(footage, [*meshes[:-1], None] if wrong == "meshes" else wrong)
    assert caught.value.code == "proxy" and "give a mesh" in str(caught.value)


@pytest.mark.parametrize("given", [{"triangles": 100}, {"fit": "none"}])
def test_options_of_still_meshes_are_refused(plate, given):
    meshes, footage = plate
    with pytest.raises(OptionError) as caught:
        encode_footage(footage, meshes, **given)
    assert caught.value.code == "clip-option" and next(iter(given)) in str(caught.value)


def test_a_run_that_was_stopped_goes_on_with_the_same_meshes_alone(plate, tmp_path):
    meshes, footage = plate
    two, work = replace(footage, frames=footage.frames[:2], asked=[]), tmp_path / "work"
    first = encode_footage(two, meshes[:2], OPTIONS, work=work)
    two.asked.clear()
    again = encode_footage(two, meshes[:2], OPTIONS, work=work)
    assert again.groups.coded(0).units == first.groups.coded(0).units and set(two.asked) == {0, 1}
    asked = len(two.asked)
    other = encode_footage(two, [meshes[0], staged(1, 1.2)], OPTIONS, work=work)
    assert len(two.asked) > 2 * asked and other.groups.coded(0).motion.data != first.groups.coded(0).motion.data


def test_a_mesh_without_texture_coordinates_gets_charts_once(plate):
    meshes, footage = plate
    bare = [Mesh(one.vertices, one.faces) for one in meshes[:3]]
    clip = encode_footage(replace(footage, frames=footage.frames[:3]), bare, OPTIONS)
    for number in range(3):
        found = clip.scene(float(clip.timeline.times[number])).proxy.mesh
        away = np.linalg.norm(found.vertices[:, None] - bare[number].vertices[None], axis=2).min(axis=1)
        assert away.max() < 0.03
