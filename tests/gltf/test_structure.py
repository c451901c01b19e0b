"""The structure of a written file: golden JSON, the order of buffers, bytes by part."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest

from eigenfield import gltf as scene_format
from eigenfield.coding import limits
from eigenfield.gltf import save
from support import glb_surgery
from support.clips import numbered_clip
from support.glb_surgery import CODECS
from support.scenes import tiny_scene

GOLDEN = Path(__file__).parents[1] / "data"


def golden_scene(path: Path) -> None:
    scene = replace(tiny_scene(3, 2, cameras=6, size=16, held_out=(4,)), generator="eigenfield golden")
    save(scene, path, codec="webp")


def golden_clip(path: Path) -> None:
    save(numbered_clip((3, 2)), path)


def golden_json(path: Path) -> dict:
    """The JSON of a file without what depends on how well a codec compresses."""
    gltf, _ = glb_surgery.split(path.read_bytes())
    gltf["asset"]["generator"] = gltf["buffers"] = "left out"
    for view in gltf["bufferViews"]:
        view["byteOffset"] = view["byteLength"] = "left out"
    timeline = gltf["extensions"][limits.EXTENSION].get("timeline")
    if timeline is not None:
        for group in timeline["groups"]:
            group["offset"] = group["length"] = group["sha256"] = "left out"
        for accessor in gltf["accessors"]:
            accessor["count"] = "left out"  # of the mesh for other viewers, which has as many points as bytes allow

    def rounded(value):
        if isinstance(value, float):
            return round(value, 5) + 0.0
        if isinstance(value, dict):
            return {key: rounded(entry) for key, entry in value.items()}
        return [rounded(entry) for entry in value] if isinstance(value, list) else value

    return rounded(gltf)


@pytest.mark.parametrize(("name", "write"), [("scene.gltf.json", golden_scene), ("clip.gltf.json", golden_clip)])
def test_the_structure_is_the_golden_one(tmp_path, name, write):
    """After a change that is meant: EIGENFIELD_GOLDEN=write pytest tests/gltf/test_structure.py -k golden."""
    write(tmp_path / "golden.glb")
    found = golden_json(tmp_path / "golden.glb")
    if os.environ.get("EIGENFIELD_GOLDEN") == "write":
        (GOLDEN / name).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    assert found == json.loads((GOLDEN / name).read_text(encoding="utf-8"))


def test_buffers_are_ordered_for_a_file_that_is_still_arriving(tmp_path):
    save(tiny_scene(3, 3), tmp_path / "scene.glb")
    gltf, _ = glb_surgery.split((tmp_path / "scene.glb").read_bytes())
    extension = gltf["extensions"][limits.EXTENSION]
    plane = extension["planes"][0]

    def accessor(index):
        return gltf["accessors"][index]["bufferView"]

    primitive = gltf["meshes"][0]["primitives"][0]
    order = [accessor(primitive["attributes"]["POSITION"]), accessor(primitive["indices"]), plane["mean"]["bufferView"],
             accessor(plane["bases"][0]["weights"]), accessor(extension["cameras"]["poses"]),
             accessor(extension["viewPlane"]["triangles"]),
             *(texture["bufferView"] for texture in plane["bases"][0]["textures"])]  # fmt: skip
    offsets = [gltf["bufferViews"][index]["byteOffset"] for index in order]
    assert offsets == sorted(offsets)
    assert all(view["byteOffset"] % 4 == 0 for view in gltf["bufferViews"])


@pytest.mark.parametrize("codec", CODECS)
def test_parts_sum_to_the_file(tmp_path, codec):
    path = tmp_path / "scene.glb"
    save(tiny_scene(3, 3), path, codec=codec)
    parts = scene_format.parts(path)
    assert parts["total"] == path.stat().st_size
    assert parts["total"] == sum(parts[name] for name in ("mean", "textures", "weights", "mesh", "other"))
    assert parts.pop("residual") == parts.pop("opacity") == 0
    assert parts["weights"] == 4 * 5 * 3
    assert parts["mesh"] == 36 * 20 + 50 * 3 * 2
    assert min(parts.values()) > 0
