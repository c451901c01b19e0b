"""Clips whose mesh moves: each frame has vertices of its own, from any place on, and damage is refused."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest

from eigenfield.coding.codecs import encoder
from eigenfield.coding.mesh.coder import decode_placed
from eigenfield.core.payloads import Payload
from eigenfield.gltf import load, load_clip, parts, save, validate
from eigenfield.gltf.group import group_bytes
from support import glb_surgery
from support.clips import finer_mesh, groups_of, moving_clip, numbered_clip, read_all, with_groups
from support.glb_surgery import outcome

LENGTHS = 3, 4


def rising(number, places):
    """Half of the vertices are nearer by three steps a frame."""
    moved = places.copy()
    moved[::2, 2] += 3 * number
    return moved


@pytest.fixture(scope="module")
def still():
    return numbered_clip(LENGTHS)


@pytest.fixture(scope="module")
def path(still, tmp_path_factory):
    path = tmp_path_factory.mktemp("motion") / "clip.glb"
    save(moving_clip(still, rising), path)
    return path


@pytest.fixture(scope="module")
def placed(still):
    return decode_placed(still.groups.payloads.only("mesh").data)


def test_each_frame_has_its_own_vertices_in_any_order(path, placed):
    clip = load_clip(path)
    for number in (5, 0, 6, 2, 3, 3, 1, 4):
        mesh = clip.scene(clip.timeline.times[number]).proxy.mesh
        expected = placed.lattice.points(rising(number, placed.places)).astype(np.float32)
        np.testing.assert_array_equal(mesh.vertices, expected)
        np.testing.assert_array_equal(mesh.faces, placed.mesh.faces)
        np.testing.assert_array_equal(mesh.uv, placed.mesh.uv)
    np.testing.assert_array_equal(clip.groups.group(1).proxy.mesh.vertices, load(path, 0.3).proxy.mesh.vertices)
    again = pickle.loads(pickle.dumps(clip))
    np.testing.assert_array_equal(again.scene(0.5).proxy.mesh.vertices, clip.scene(0.5).proxy.mesh.vertices)


def test_a_file_with_motion_names_it_and_other_files_do_not(path, still, tmp_path):
    assert validate(path) == []
    needs = glb_surgery.split(path.read_bytes())[0]["extensions"][glb_surgery.EXTENSION]
    assert "motion-1" in needs["needs"] and needs["version"] == "1.11"
    save(still, tmp_path / "still.glb")
    extension = glb_surgery.split((tmp_path / "still.glb").read_bytes())[0]["extensions"][glb_surgery.EXTENSION]
    assert "motion-1" not in extension["needs"]


def test_a_frame_is_a_scene_of_its_own(path, tmp_path):
    scene = load(path, 0.6)
    save(scene, tmp_path / "frame.glb", codec="png")
    again = load(tmp_path / "frame.glb")
    assert len(again.proxy.mesh.faces) == len(scene.proxy.mesh.faces)
    nearest = np.abs(again.proxy.mesh.vertices[:, None] - scene.proxy.mesh.vertices[None]).max(axis=2).min(axis=1)
    assert nearest.max() < 0.02


def test_its_bytes_are_counted_with_the_mesh(path, still, tmp_path, run):
    save(still, tmp_path / "still.glb")
    facts = json.loads(run("info", path, "--json").out)
    motion = sum(len(load_clip(path).groups.coded(index).motion.data) for index in range(2))
    assert facts["clip"]["motion_bytes"] == motion
    assert facts["bytes"]["mesh"] - parts(tmp_path / "still.glb")["mesh"] >= motion
    assert f"{motion:,} bytes: the mesh moves" in run("info", path).out
    assert "the mesh moves" not in run("info", tmp_path / "still.glb").out


def test_a_copy_keeps_its_groups_byte_for_byte(path, tmp_path):
    save(load_clip(path), tmp_path / "again.glb")
    assert groups_of((tmp_path / "again.glb").read_bytes()) == groups_of(path.read_bytes())


def other_motion(path, change):
    """The file whose first group has another motion."""
    coded = load_clip(path).groups.coded(0)
    motion = change(coded.motion.data)
    made = group_bytes(replace(coded, motion=Payload("motion-1", motion)))
    data = path.read_bytes()
    return with_groups(data, [made, *groups_of(data)[1:]])


@pytest.fixture(scope="module")
def own(still, tmp_path_factory):
    """The second group has a mesh of its own."""
    path = tmp_path_factory.mktemp("own") / "clip.glb"
    save(moving_clip(still, rising, {1: finer_mesh(still)}), path)
    return path


def test_a_group_has_its_own_mesh_and_the_others_that_of_the_file(own, still, placed, tmp_path):
    clip, finer = load_clip(own), decode_placed(finer_mesh(still).data)
    for number in (5, 0, 6, 2, 3):
        mesh, expected = clip.scene(clip.timeline.times[number]).proxy.mesh, placed if number < LENGTHS[0] else finer
        points = expected.lattice.points(rising(number, expected.places)).astype(np.float32)
        np.testing.assert_array_equal(mesh.vertices, points)
        np.testing.assert_array_equal(mesh.faces, expected.mesh.faces)
        np.testing.assert_array_equal(mesh.uv, expected.mesh.uv)
    assert validate(own) == []
    save(clip, tmp_path / "again.glb")
    assert (tmp_path / "again.glb").read_bytes() == own.read_bytes()
    again = pickle.loads(pickle.dumps(clip))
    np.testing.assert_array_equal(again.scene(0.5).proxy.mesh.faces, finer.mesh.faces)
    save(clip.scene(0.5), tmp_path / "frame.glb")
    np.testing.assert_array_equal(load(tmp_path / "frame.glb").proxy.mesh.faces, finer.mesh.faces)


@pytest.mark.parametrize("keep", [0, 20, 160])
def test_a_damaged_mesh_of_a_group_is_refused_by_its_code(own, tmp_path, keep):
    data = own.read_bytes()
    coded = load_clip(own).groups.coded(1)
    made = group_bytes(replace(coded, mesh=Payload("mesh-2", coded.mesh.data[:keep] or b"x")))
    code = outcome(tmp_path / "a.glb", with_groups(data, [groups_of(data)[0], made]), read_all)
    assert code.startswith("coded-")


def test_damaged_motion_is_refused_by_its_code(path, placed, tmp_path):
    two = encoder("motion-1")(placed.places, placed.mesh.faces, np.stack([placed.places] * 2))
    far = encoder("motion-1")(placed.places, placed.mesh.faces, np.stack([placed.places * [1, 1, 0]] * 3))
    for change, code in (
        (lambda data: bytes([7]) + data[1:], "coded-version"),
        (lambda data: data[:5], "coded-truncated"),
        (lambda data: data[:1] + b"\xff\xff\xff\x00" + data[5:], "coded-damaged"),
        (lambda data: two, "group-damaged"),
    ):
        assert outcome(tmp_path / "a.glb", other_motion(path, change), read_all) == code
    (tmp_path / "far.glb").write_bytes(other_motion(path, lambda data: far))
    read_all(tmp_path / "far.glb")  # inverse depth 0 of a camera's lattice is half a step before infinity


def test_a_group_without_motion_has_the_vertices_of_the_mesh(path, placed, tmp_path):
    groups = groups_of(path.read_bytes())
    coded = replace(load_clip(path).groups.coded(1), motion=None)
    (tmp_path / "a.glb").write_bytes(with_groups(path.read_bytes(), [groups[0], group_bytes(coded)]))
    clip = load_clip(tmp_path / "a.glb")
    np.testing.assert_array_equal(clip.scene(0.5).proxy.mesh.vertices, placed.mesh.vertices)
    assert (clip.scene(0.2).proxy.mesh.vertices != placed.mesh.vertices).any()
