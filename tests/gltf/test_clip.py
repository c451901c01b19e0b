"""The file of a clip: every frame is its own, groups are read alone and kept byte for byte, and damage is refused."""

from __future__ import annotations

import json
import pickle
import struct
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from eigenfield.core.clip import Clip
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.core.films import CodedGroup
from eigenfield.core.payloads import mesh_key
from eigenfield.gltf import load, load_clip, parts, save
from eigenfield.gltf.clips import CodedGroups
from eigenfield.gltf.container import parse_glb
from eigenfield.gltf.group import group_bytes, read_group
from support.clips import TEXTURES_COUNT, numbered_clip, shown_number, shown_texture
from support.scenes import tiny_scene

LENGTHS = 5, 7, 1


@pytest.fixture(scope="module")
def made():
    return numbered_clip(LENGTHS, rate=Fraction(30000, 1001), first=2.0)


@pytest.fixture(scope="module")
def path(made, tmp_path_factory):
    path = tmp_path_factory.mktemp("clip") / "clip.glb"
    save(made, path)
    return path


def number_of(scene):
    plane = scene.appearance.planes[0]
    number = shown_number(plane.mean[..., 0])
    assert shown_texture(plane.bases[0].textures[..., 0]) == number % TEXTURES_COUNT
    return number


def test_every_frame_is_its_own_in_any_order(path):
    clip = load_clip(path)
    times, rng = clip.timeline.times, np.random.default_rng(1)
    order = [*range(13), *rng.integers(0, 13, 20).tolist()]
    assert [number_of(clip.scene(times[n])) for n in order] == order
    assert times[1] == 2.0 + 1001 / 30000 and list(clip.groups.lengths) == list(LENGTHS)


def test_a_frame_is_a_scene_that_is_saved_and_read(path, tmp_path):
    time = load_clip(path).timeline.times[7]
    scene = load(path, time)
    assert number_of(scene) == 7 and scene.settings == {"clip": {"group": 0.5}}
    save(scene, tmp_path / "frame.glb", codec="png")
    again = load(tmp_path / "frame.glb", 99.0)  # a file of one instant has it at any time
    assert shown_number(again.appearance.planes[0].mean[..., 0]) == 7
    assert np.array_equal(again.mesh.vertices, scene.mesh.vertices)
    assert np.array_equal(again.appearance.planes[0].bases[0].weights, scene.appearance.planes[0].bases[0].weights)


def test_groups_keep_their_bytes(made, path, tmp_path):
    copy = tmp_path / "copy.glb"
    save(path, copy)
    assert copy.read_bytes() == path.read_bytes()
    save(load_clip(copy), copy, overwrite=True)  # onto itself
    assert copy.read_bytes() == path.read_bytes()
    chunk = parse_glb(path.read_bytes()).chunks[b"EFTL"]
    assert bytes(chunk.data).startswith(bytes(made.groups.stored[0].data.data))


def test_a_group_reads_as_it_was(made):
    data = bytes(made.groups.stored[1].data.data)
    coded = read_group(data, made.groups.layout, "here")
    assert isinstance(coded, CodedGroup) and len(coded.units) == 7 and group_bytes(coded) == data


def test_the_mesh_is_stored_once(path):
    clip = load_clip(path)
    first, last = (clip.scene(time) for time in clip.timeline.times[[0, -1]])
    (stream,) = first.payloads[mesh_key(first.mesh)]
    assert last.mesh is first.mesh and path.read_bytes().count(stream.data) == 1
    save(last, path.with_name("last.glb"))  # with the same stream
    assert parts(path)["mesh"] == parts(path.with_name("last.glb"))["mesh"] > len(stream.data)


def test_a_clip_travels_to_another_process(path):
    clip = pickle.loads(pickle.dumps(load_clip(path)))
    assert number_of(clip.scene(clip.timeline.times[6])) == 6


def test_a_scene_where_a_clip_is_expected_and_the_other_way(path, tmp_path):
    with pytest.raises(FormatError, match="is a clip, and a scene of one instant is expected") as caught:
        load(path)
    assert caught.value.code == "timeline" and "time=1.5" in caught.value.remedy and caught.value.path == str(path)
    save(tiny_scene(), tmp_path / "still.glb")
    with pytest.raises(FormatError) as caught:
        load_clip(tmp_path / "still.glb")
    assert caught.value.code == "no-clip"
    with pytest.raises(OptionError, match=r"no frame at 9 s; give 2 to 2\.4") as wrong:
        load(path, 9.0)
    assert wrong.value.path == str(path)


def test_a_clip_takes_no_codec_and_wants_coded_groups(made, tmp_path):
    with pytest.raises(OptionError) as caught:
        save(made, tmp_path / "a.glb", quality=50)
    assert caught.value.code == "quality"
    group = made.groups.group(0)

    class Decoded:
        lengths = (5,)

        def group(self, index):
            return group

    clip = Clip(made.rig, replace(made.timeline, frames=5), Decoded())
    with pytest.raises(OptionError) as caught:
        save(clip, tmp_path / "a.glb")
    assert caught.value.code == "clip-groups" and not (tmp_path / "a.glb").exists()


def cut(path, tmp_path, size):
    target = tmp_path / "cut.glb"
    target.write_bytes(path.read_bytes()[:size])
    return target


def test_a_file_that_ends_within_a_group_has_those_before(path, tmp_path, caplog):
    chunk = parse_glb(path.read_bytes()).chunks[b"EFTL"]
    short = cut(path, tmp_path, chunk.first + 1500)
    clip = load_clip(short)
    assert "later frames are missing" in caplog.text
    assert number_of(clip.scene(clip.timeline.times[4])) == 4
    with pytest.raises(FormatError) as caught:
        clip.scene(clip.timeline.times[12])
    assert caught.value.code == "truncated" and caught.value.path == str(short)
    with pytest.raises(FormatError) as caught:
        load_clip(cut(path, tmp_path, chunk.first - 20))
    assert caught.value.code == "truncated"


def test_a_damaged_group_costs_its_own_frames_alone(path, tmp_path):
    data = bytearray(path.read_bytes())
    clip = load_clip(path)
    first = clip.groups.stored[1].data.first
    data[first + 400] ^= 1
    target = tmp_path / "damaged.glb"
    target.write_bytes(data)
    clip = load_clip(target)
    assert number_of(clip.scene(clip.timeline.times[3])) == 3
    with pytest.raises(FormatError, match="not those that were written") as caught:
        clip.scene(clip.timeline.times[6])
    assert caught.value.code == "group-damaged" and caught.value.where.endswith("timeline/groups/1")
    assert number_of(clip.scene(clip.timeline.times[12])) == 12


def test_a_group_cut_anywhere_is_damaged(made):
    data = bytes(made.groups.stored[0].data.data)
    for size in (0, 3, 4, 40, len(data) - 1):
        with pytest.raises(FormatError) as caught:
            read_group(data[:size], made.groups.layout, "here")
        assert caught.value.code == "group-damaged" and caught.value.where == "here"
    with pytest.raises(FormatError, match="streams end"):
        read_group(data + b"0", made.groups.layout, "here")


def test_a_group_of_other_frames_than_announced(made):
    stored = [replace(made.groups.stored[0], frames=6)]
    groups = CodedGroups(made.groups.layout, stored, made.rig, made.groups.mesh, None, made.groups.payloads)
    with pytest.raises(FormatError, match="5 frames, 6 are announced"):
        groups.coded(0)


def test_a_file_without_its_groups(path, tmp_path):
    data = path.read_bytes()
    first = parse_glb(data).chunks[b"EFTL"].first - 8
    head = bytearray(data[:first])
    head[8:12] = struct.pack("<I", first)
    target = tmp_path / "headless.glb"
    target.write_bytes(head)
    with pytest.raises(FormatError) as caught:
        load_clip(target)
    assert caught.value.code == "group-missing"


def test_other_readers_find_the_first_frame(path):
    glb = parse_glb(path.read_bytes())
    assert glb.json["meshes"] and glb.json["images"] and "KHR_materials_unlit" in glb.json["extensionsUsed"]
    assert "extensionsRequired" not in glb.json and json.dumps(glb.json).count("EFTL") == 0
