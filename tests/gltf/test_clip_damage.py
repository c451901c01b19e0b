"""What is wrong in the JSON or the groups of a clip has a code of its own, which `load_clip` and `validate` share."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from eigenfield.coding import limits
from eigenfield.coding.codecs import encoder
from eigenfield.core.payloads import Payload
from eigenfield.gltf import encode_scene
from eigenfield.gltf.deflate import deflate, inflate
from eigenfield.gltf.group import HEAD, group_bytes
from support import glb_surgery
from support.clips import groups_of, numbered_clip, read_all, with_groups
from support.glb_surgery import changed, ours, outcome

MEAN, BASIS = ("planes", 0, "mean"), ("planes", 0, "bases", 0)
TIMELINE = ("timeline",)


@pytest.fixture(scope="module")
def clip():
    return numbered_clip((3, 2))


@pytest.fixture(scope="module")
def data(clip):
    return encode_scene(clip)


def alike(gltf, extension, binary):
    first, second = extension["timeline"]["groups"]
    second["offset"] = first["offset"]


def other_mesh(gltf, extension, binary):
    view = gltf["bufferViews"][extension["mesh"]["bufferView"]]
    binary[view["byteOffset"]] = 9


def no_mesh(gltf, extension, binary):
    del extension["mesh"]


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (ours(*TIMELINE, "rate", value=[1001, 1]), "timeline-rate"),
        (ours(*TIMELINE, "rate", value=[1, 1001]), "timeline-rate"),
        (ours(*TIMELINE, "frames", value=6), "timeline-frames"),
        (ours(*TIMELINE, "groups", 0, "frames", value=2), "timeline-frames"),
        (ours(*TIMELINE, "groups", 1, "offset", value=4), "group-range"),
        (ours(*TIMELINE, "groups", 1, "length", value=10**6), "group-range"),
        (alike, "group-range"),
        (ours(*TIMELINE, "groups", 0, "sha256", value="0" * 64), "group-damaged"),
        (ours(*TIMELINE, "groups", 0, "length", value=400), "group-damaged"),
        (ours(*TIMELINE, "films", 0, "codec", value="film-2"), "codec-unknown"),
        (ours(*TIMELINE, "films", 0, "size", value=[256, 128]), "film-size"),
        (ours(*TIMELINE, "films", 0, "size", value=[8192, 4096]), "film-size"),
        (ours(*TIMELINE, "films", value=[{"codec": "film-1", "size": [512, 128]}]), "json-value"),
        (ours(*MEAN, "at", value=[[128, 0]]), "film-place"),
        (ours(*MEAN, "at", value=[[8, 0]]), "film-place"),
        (ours(*MEAN, "at", value=[[0, 0], [64, 0]]), "film-place"),
        (ours(*BASIS, "at", value=[[0, 0], [128, 0], [240, 0]]), "film-place"),
        (ours(*BASIS, "at", value=[[0, 0], [128, 0], [256, 0]]), "weights-count"),
        (ours(*BASIS, "size", value=[16385, 16]), "json-value"),
        (ours("mesh", "codec", value="mesh-9"), "codec-unknown"),
        (other_mesh, "coded-version"),
        (no_mesh, "json-missing"),
        (ours("toRGB", value=[1, 0, 0]), "plane-matrix"),
        (ours("needs", value=["film-2"]), "needs"),
    ],
)  # fmt: skip
def test_wrong_json_has_its_code(tmp_path, data, change, code):
    assert outcome(tmp_path / "a.glb", changed(data, change), read_all) == code


def test_a_clip_has_no_colours_of_cameras(tmp_path, data):
    def harmonised(gltf, extension, binary):
        gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": 96})
        view = len(gltf["bufferViews"]) - 1
        gltf["accessors"].append({"bufferView": view, "componentType": 5126, "count": 24, "type": "SCALAR"})
        gltf["buffers"][0]["byteLength"] = len(binary) + 96
        binary.extend(np.tile(np.repeat([1, 0], 3), 4).astype("<f4").tobytes())
        extension["cameras"]["colour"] = len(gltf["accessors"]) - 1

    assert outcome(tmp_path / "a.glb", changed(data, harmonised), read_all) == "camera-colour"


def with_head(data, change):
    """The file whose first group has another head."""
    groups = groups_of(data)
    first = HEAD.size + HEAD.unpack_from(groups[0])[0]
    head = json.loads(inflate(groups[0][HEAD.size : first], 2**20, "here"))
    change(head)
    text = deflate(json.dumps(head).encode())
    return with_groups(data, [HEAD.pack(len(text)) + text + groups[0][first:], *groups[1:]])


@pytest.mark.parametrize(
    "change",
    [
        lambda head: head["weights"][0].append(head["weights"][0][0]),
        lambda head: head["weights"][0].__setitem__(0, head["weights"][0][0] + 1),
        lambda head: head["weights"].pop(),
        lambda head: head["means"][0].update(scale=[1, 2]),
        lambda head: head["bases"][0][0].update(zero=[1, 2]),
        lambda head: head["frames"].pop(),
        lambda head: head["frames"][1].append(0),
        lambda head: head.clear(),
    ],
)
def test_a_head_that_does_not_fit_is_a_damaged_group(tmp_path, data, change):
    assert outcome(tmp_path / "a.glb", with_head(data, change), read_all) == "group-damaged"


def test_streams_that_are_others_than_announced(tmp_path, clip, data):
    """Each signed by whoever wrote it: the digest is right."""
    first, last = clip.groups.coded(0), groups_of(data)[1]
    few, _ = encoder("weights-1")(np.ones((3, 4), np.float32), 0.01)
    swapped = tuple(tuple(reversed(units)) for units in first.units)
    others = {
        "weights-count": replace(first, weights=((Payload("weights-1", few),), ())),
        "film-size": replace(first, units=swapped),
        "film-frames": replace(first, units=(first.units[0], first.units[0], first.units[2])),
    }
    for code, group in others.items():
        assert outcome(tmp_path / "a.glb", with_groups(data, [group_bytes(group), last]), read_all) == code


@pytest.mark.parametrize(
    ("limit", "value", "code"),
    [
        ("MAX_GROUPS", 1, "json-value"),
        ("MAX_FRAMES", 4, "json-value"),
        ("MAX_GROUP_FRAMES", 2, "json-value"),
        ("MAX_GROUP", 400, "json-value"),
        ("MAX_GROUP_JSON", 100, "group-damaged"),
        ("MAX_RATE", 9, "timeline-rate"),
        ("MAX_FILMS", 1, "json-value"),
        ("MAX_FILM_SIDE", 256, "json-value"),
        ("MAX_FILM_PIXELS", 30_000, "film-size"),
        ("MAX_COMPONENTS", 3, "json-value"),
        ("MAX_WEIGHTS", 15, "coded-size"),
    ],
)
def test_limits_of_clips_hold(tmp_path, data, monkeypatch, limit, value, code):
    monkeypatch.setattr(limits, limit, value)
    assert outcome(tmp_path / "a.glb", data, read_all) == code


def test_unknown_keys_of_a_clip_are_ignored(tmp_path, data):
    later = changed(data, ours("later", value=1))
    assert outcome(tmp_path / "a.glb", later, read_all) is None
    assert glb_surgery.behind(later) == glb_surgery.behind(data)
