"""Scores put into a file that is there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from eigenfield import gltf as scene_format
from eigenfield.coding import limits
from eigenfield.core.errors import FormatError, OutputError
from eigenfield.gltf import save
from support import glb_surgery
from support.scenes import tiny_scene


def test_scores_are_stored_beside_untouched_pictures(tmp_path):
    path = tmp_path / "scene.glb"
    save(tiny_scene(3, 3), path)
    unknown = glb_surgery.changed(
        path.read_bytes(), lambda g, e, b: (e.update(later=[1.5, {"ä": None}]), g.update(extras=7))
    )
    path.write_bytes(unknown)
    binary = glb_surgery.split(unknown)[1]
    for scores in ({"uv": {"psnr": 31.25}, "bild": "ä"}, {}, {"long": [0.1] * 1000}):
        scene_format.store_scores(path, scores)
        gltf, after = glb_surgery.split(path.read_bytes())
        assert after == binary
        assert gltf["extensions"][limits.EXTENSION]["later"] == [1.5, {"ä": None}] and gltf["extras"] == 7
        assert scene_format.load(path).scores == scores
    assert [f.code for f in scene_format.validate(path)] == ["unknown-key"]
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("value", [np.float32(1), float("nan"), {1, 2}, "\ud800"])
def test_what_is_no_json_is_refused(tmp_path, value):
    for name in ("scores", "settings"):
        with pytest.raises(OutputError, match=f"{name} are no JSON") as caught:
            save(replace(tiny_scene(3, 1), **{name: {"x": value}}), tmp_path / "scene.glb")
        assert caught.value.code == "scene-values" and list(tmp_path.iterdir()) == []


def test_scores_go_through_a_link(tmp_path):
    path, link = tmp_path / "scene.glb", tmp_path / "link.glb"
    save(tiny_scene(3, 1), path)
    link.symlink_to(path)
    scene_format.store_scores(link, {"a": 1})
    assert link.is_symlink() and scene_format.load(path).scores == {"a": 1}


def test_scores_into_something_else_are_refused(tmp_path):
    path = tmp_path / "plain.glb"
    trimesh.creation.box().export(path)
    before = path.read_bytes()
    with pytest.raises(FormatError) as caught:
        scene_format.store_scores(path, {})
    assert caught.value.code == "not-a-scene"
    assert path.read_bytes() == before
